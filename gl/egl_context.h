// An OpenGL 4.5 core context without window or display, and the errors of its driver.
//
// EGL's device enumeration finds the GPU, with the driver of any vendor. Without a GPU, Mesa's surfaceless platform
// gives llvmpipe. LIBGL_ALWAYS_SOFTWARE=1, which is Mesa's own switch, excludes GPUs.
#pragma once
#include <string>
#include <vector>

#include "gl/renderer.h"

namespace noonmark::gl {

// The driver's messages and errors, from KHR_debug and glGetError. The callback only stores a message, because an
// exception must not pass through the driver's stack frames.
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

class EglContext {
 public:
  // Throws Error(device); the message names what to install.
  explicit EglContext(DebugMode debug);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Costs little if the context is current already. Throws Error(defect) if it is current on another thread.
  void make_current() const;

  const std::string& platform() const { return platform_; }

  // Throws for the errors of the calls so far, by each way in which the driver reports them; see DebugLog. `where`
  // names the caller in the message.
  void check(const char* where) { log_.check(where); }
  // Drops these errors, for a caller that has already thrown a better message.
  void forget_errors() { log_.forget(); }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string platform_;
  DebugLog log_;
};

}  // namespace noonmark::gl
