// What is wrong with a command line, in one line with the nearest names for a misspelt verb or option.
//
//   try { app.parse(argc, argv); }
//   catch (const CLI::ParseError& error) { throw Error(ErrorKind::usage, command_line_error(app, error)); }
#pragma once
#include <span>
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace noonmark {

// app: that has parsed the command line and thrown the error.
std::string command_line_error(const CLI::App& app, const CLI::ParseError& error);

// Throws Error(usage) with the nearest verbs unless the name is a verb's.
void require_verb(const std::string& name);

// The same of the first word of a command line, which may be an option of the program too. CLI11 would first report a
// missing verb.
void refuse_unknown(const std::string& first);

// Throws Error(usage) for a word such as "--out=". CLI11 would take the next word for the value.
void refuse_empty_values(std::span<const std::string> words);

}  // namespace noonmark
