// An OpenGL 4.5 core context without window or display, and what its driver says.
//
// The hardware is found by EGL's device enumeration (a GPU with any vendor's driver); without one, Mesa's surfaceless
// platform gives llvmpipe. LIBGL_ALWAYS_SOFTWARE=1, Mesa's own switch, keeps GPUs out.
#pragma once
#include <string>
#include <vector>

#include "gl/debug_log.h"
#include "gl/renderer.h"

namespace noonmark::gl {

class EglContext {
 public:
  // Throws Error(device) that says what to install.
  explicit EglContext(DebugMode debug);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Cheap when it is current already. Throws Error(defect) when it is current on another thread.
  void make_current() const;

  const std::string& platform() const { return platform_; }

  // Errors of the calls so far, by whatever way the driver reports them; see DebugLog. `where`: the caller, for people.
  void check(const char* where) { log_.check(where); }
  // Drops them: for a caller that has already thrown a better message.
  void forget_errors() { log_.forget(); }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string platform_;
  DebugLog log_;
};

}  // namespace noonmark::gl
