// Turns an exception into one line for the user and an exit code.
//
//   try { measure(); } catch (...) { return tell(current_failure()); }
#pragma once
#include <string>

namespace noonmark {

struct Failure {
  int exit_code;
  std::string message;  // one line, printable
};

// The failure that corresponds to the exception being handled.
Failure current_failure();

// Prints it on standard error and returns the exit code.
int tell(const Failure& failure);

}  // namespace noonmark
