// What an exception means to a user: one line and an exit code.
//
//   try { ... } catch (...) { return tell(current_failure()); }
#pragma once
#include <string>

namespace noonmark {

struct Failure {
  int exit_code;
  std::string message;  // one line, printable
};

// Of the exception that is being handled.
Failure current_failure();

// On standard error; returns the exit code.
int tell(const Failure& failure);

}  // namespace noonmark
