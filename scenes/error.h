// The one exception type of the program. Thrown for what a user or a machine can get wrong (files, settings, drivers);
// our own mistakes are asserts or std::logic_error. Only main catches it, and its kind is the exit code.
#pragma once
#include <stdexcept>
#include <string>

namespace noonmark {

enum class ErrorKind {
  usage = 2,       // wrong command line or experiment file
  scene = 3,       // bad scene or file
  device = 4,      // no usable OpenGL, ray tracer or picture library
  defect = 5,      // a defect of ours: an invariant of the measurement did not hold
  incomplete = 6,  // the sweep did not finish
};

class Error : public std::runtime_error {
 public:
  // message: what is wrong, where, and what to do next, in one line.
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }
  int exit_code() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

}  // namespace noonmark
