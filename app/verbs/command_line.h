// The command line of the program: the parser, made from the table of verbs, and what a wrong one meant.
//
//   CommandLine line;
//   return line.run(argc, argv, command);   // throws Error(usage) if the command line is wrong
#pragma once
#include <map>
#include <memory>
#include <string>

#include "app/sweep/retract.h"
#include "app/verbs/verbs.h"

namespace noonmark {

class CommandLine {
 public:
  CommandLine();
  ~CommandLine();

  // Parses the words, runs their verb, and returns its exit code. Prints help or version if they are asked for. argc: at
  // least 2. command: the whole command line, for the record.
  int run(int argc, char** argv, const std::string& command);

  // The words that have a meaning, for meant_folders().
  Vocabulary vocabulary() const;

 private:
  std::unique_ptr<CLI::App> app_;
  std::map<std::string, RunVerb> runs_;  // by the name of the verb
};

}  // namespace noonmark
