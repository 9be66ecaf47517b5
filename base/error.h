// base/: what knows no scene: errors, text, files, memory, threads, progress, digests, images as plain arrays.
// May include no other folder of the project. Everything else may use it; begin with this file and base/text.h.
//
// The one exception type of the program. It is thrown for mistakes of a user and failures of a machine (files,
// settings, drivers). Our own mistakes are asserts or std::logic_error. Only main ends the program with it, and then
// its kind is the exit code. Other functions catch it to add what they know or to change its kind, and throw again
// (at_point in app/definition/experiment.h, open_store in app/sweep/sweep.cpp), or to report it and continue (verb_doctor in
// app/verbs/verb_doctor.cpp).
#pragma once
#include <stdexcept>
#include <string>

namespace noonmark {

// The kind says what the user has to change.
enum class ErrorKind {
  usage = 2,   // the command line or the experiment: it is wrong, or asks for a point that does not fit into memory,
               // or for a results' folder that cannot be used
  file = 3,    // a file: a bad scene, or one that does not fit into memory; damaged results; a full disk
  device = 4,  // the machine: no usable OpenGL, ray tracer or picture library, or no memory or threads for them
  defect = 5,  // Noonmark itself: an invariant of the measurement did not hold
  incomplete = 6,  // nothing: the sweep was interrupted; the same command continues it
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
