// app/verbs/: the command line: a file for each verb, which adds its options, calls the other rooms and prints. May
// include everything; nothing includes it.
//
// A verb is one file, app/verbs/verb_*.cpp, and one row in app/verbs/verb_table.cpp. The parser, the help, the man page
// and the completion are made from the rows.
#pragma once
#include <functional>
#include <span>
#include <string>

namespace CLI {
class App;
}

namespace noonmark {

// Runs a verb with the values that the command line gave its options. command: the whole command line, for the record.
// Returns the exit code. Errors are thrown.
using RunVerb = std::function<int(const std::string& command)>;

struct Verb {
  const char* name;
  const char* help;     // one line of the help, without a full stop
  const char* example;  // a command that begins with "noonmark NAME"
  // Adds what the verb takes: options and arguments, each with its help, its default, its checks and the word of its
  // kind (app/verbs/option_values.h).
  RunVerb (*add)(CLI::App& verb);
  const char* heading = "";  // of the help, under which it stands; verb_table() gives it
};

// In the order of the help.
std::span<const Verb> verb_table();

}  // namespace noonmark
