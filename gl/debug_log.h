// The driver's messages and errors, from KHR_debug and glGetError. The callback only stores a message, because an
// exception must not pass through the driver's stack frames.
#pragma once
#include <string>

#include "gl/renderer.h"

namespace noonmark::gl {

class DebugLog {
 public:
  // Installs the callback in the current context. The context keeps the address of this object.
  void install(DebugMode mode);

  // Throws Error(defect) with the first stored message (DebugMode::fatal), or Error(device) with glGetError's name.
  void check(const char* where);

  void forget();

  void receive(unsigned type, unsigned severity, const char* message);

  DebugLog() = default;
  DebugLog(const DebugLog&) = delete;
  DebugLog& operator=(const DebugLog&) = delete;

 private:
  DebugMode mode_ = DebugMode::off;
  std::string first_error_;
};

}  // namespace noonmark::gl
