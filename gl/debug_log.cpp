#include "gl/debug_log.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"

namespace noonmark::gl {
namespace {

void GLAPIENTRY callback(GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* message,
                         const void* log) {
  const_cast<DebugLog*>(static_cast<const DebugLog*>(log))->receive(type, severity, message);
}

const char* name_of(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "an unknown error";
  }
}

}  // namespace

void DebugLog::install(DebugMode mode) {
  mode_ = mode;
  if (mode == DebugMode::off) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that check() at the end of a call finds all messages of that call
  glDebugMessageCallback(callback, this);
}

void DebugLog::receive(unsigned type, unsigned severity, const char* message) {
  if (type == GL_DEBUG_TYPE_PERFORMANCE) return;  // of where a driver keeps a buffer: nothing that a user could change
  const bool error = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR;
  if (mode_ == DebugMode::fatal && error) {
    if (first_error_.empty()) first_error_ = message;
  } else if (error) {
    fmt::print(stderr, "OpenGL: error: {}\n", message);
  } else if (severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM) {
    fmt::print(stderr, "OpenGL: warning: {}\n", message);
  }
}

void DebugLog::check(const char* where) {
  const GLenum error = glGetError();
  const std::string message = first_error_;
  forget();
  if (!message.empty())
    throw Error(ErrorKind::defect, fmt::format("OpenGL reports an error in {}: {}", where, message));
  if (error != GL_NO_ERROR)
    throw Error(ErrorKind::device, fmt::format("OpenGL reports {} in {}; {}", name_of(error), where,
                                               error == GL_OUT_OF_MEMORY ? "lower map.resolution or the picture's size"
                                                                         : "noonmark doctor shows the driver"));
}

void DebugLog::forget() {
  // A lost context may report errors without end. There are fewer than 16 distinct error flags.
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
  }
  first_error_.clear();
}

}  // namespace noonmark::gl
