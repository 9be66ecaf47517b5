// The one exception type of the program. Thrown for what a user or a machine can get wrong (files, settings, drivers);
// our own mistakes are asserts or std::logic_error. Only main catches it, and its kind is the exit code.
#pragma once
#include <stdexcept>
#include <string>

namespace noonmark {

// What has to change for it to work.
enum class ErrorKind {
  usage = 2,       // the command line or the experiment: wrong, or it asks for more than fits (a point into memory,
                   // results into that folder)
  scene = 3,       // a file: a bad scene, or one that memory cannot hold; damaged results; a full disk
  device = 4,      // the machine: no usable OpenGL, ray tracer or picture library, or no memory or threads for them
  defect = 5,      // ours: an invariant of the measurement did not hold
  incomplete = 6,  // nothing: the sweep did not finish, and the same command goes on
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
