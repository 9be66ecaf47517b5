#include "gl/egl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/system_error.h"

namespace noonmark::gl {
namespace {

constexpr const char* what_to_install = "on Debian, apt install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri";

// libepoxy ends the process if it cannot open a library that it needs. So this function first tries to open the same
// libraries as libepoxy 1.5.10: EGL, and the first of two names for OpenGL. They are not closed, because libepoxy keeps
// pointers into them.
void require_libraries() {
  const auto opens = [](const char* name) { return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr; };
  const auto fail = [] {
    const std::string why = dlerror();  // its only word of the reason is the system's text
    const int error_number = why.ends_with(std::strerror(EMFILE)) ? EMFILE : 0;
    throw Error(ErrorKind::device,
                fmt::format("OpenGL cannot be loaded: {}; {}", why, advice_on_failure(error_number, what_to_install)));
  };
  if (!opens("libEGL.so.1")) fail();
  if (!opens("libOpenGL.so.0") && !opens("libGL.so.1")) fail();
}

struct Candidate {
  EGLenum platform;
  void* native;  // an EGLDeviceEXT, or EGL_DEFAULT_DISPLAY
  std::string name;
};

bool has_word(const char* words, std::string_view word) {
  std::string_view rest = words ? words : "";
  for (size_t at = rest.find(word); at != rest.npos; at = rest.find(word, at + 1))
    if ((at == 0 || rest[at - 1] == ' ') && (at + word.size() == rest.size() || rest[at + word.size()] == ' '))
      return true;
  return false;
}

bool software_wanted() {
  const char* value = std::getenv("LIBGL_ALWAYS_SOFTWARE");
  return value && *value && std::string_view(value) != "0" && std::string_view(value) != "false";
}

// The best first: GPUs in the order of EGL's enumeration, then Mesa's surfaceless platform.
std::vector<Candidate> candidates() {
  const char* client_extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<Candidate> found;
  // Without this extension there is no eglGetPlatformDisplayEXT. libepoxy ends the process if it is called then.
  if (!has_word(client_extensions, "EGL_EXT_platform_base")) return found;
  if (has_word(client_extensions, "EGL_EXT_device_enumeration") &&
      has_word(client_extensions, "EGL_EXT_platform_device") && !software_wanted()) {
    EGLDeviceEXT devices[32];
    EGLint count = 0;
    if (eglQueryDevicesEXT(32, devices, &count))
      for (EGLint i = 0; i < count; ++i)
        if (!has_word(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software"))
          found.push_back({EGL_PLATFORM_DEVICE_EXT, devices[i], fmt::format("device {}", i)});
  }
  if (has_word(client_extensions, "EGL_MESA_platform_surfaceless"))
    found.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "surfaceless"});
  return found;
}

// A context of the core profile, of at least this version.
EGLContext core_context(EGLDisplay display, EGLint major, EGLint minor, bool debug) {
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                               major,
                               EGL_CONTEXT_MINOR_VERSION_KHR,
                               minor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                               EGL_CONTEXT_FLAGS_KHR,
                               debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                               EGL_NONE};
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
}

// The best that a driver without 4.5 offers, such as "OpenGL 3.3 (Core Profile) Mesa 22.3.6 (softpipe)". It is empty if
// the driver gives no context.
std::string offered(EGLDisplay display) {
  // 3.1 is the lowest version that can be requested. The driver returns the highest version that is compatible with it.
  EGLContext context = core_context(display, 3, 1, false);
  if (context == EGL_NO_CONTEXT) context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
  if (context == EGL_NO_CONTEXT) return "";
  std::string text;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    const auto words = [](GLenum name) {
      const auto* said = reinterpret_cast<const char*>(glGetString(name));
      return std::string(said ? said : "?");
    };
    text = fmt::format("OpenGL {} ({})", words(GL_VERSION), words(GL_RENDERER));
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display, context);
  return text;
}

// The variables of Mesa and GLVND that choose a driver or change its description, with their values:
// "GALLIUM_DRIVER=softpipe, ..."
std::string choosing_variables() {
  std::string set;
  for (const char* name :
       {"GALLIUM_DRIVER", "MESA_GL_VERSION_OVERRIDE", "MESA_LOADER_DRIVER_OVERRIDE", "MESA_EXTENSION_OVERRIDE",
        "LIBGL_ALWAYS_SOFTWARE", "LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS"})
    if (const char* value = std::getenv(name)) set += fmt::format("{}{}={}", set.empty() ? "" : ", ", name, value);
  return set;
}

struct Refusal {
  std::string reason;
  bool too_old = false;  // there is a driver, and only its version is too low
};

// Returns EGL_NO_CONTEXT and a reason if this candidate cannot give an OpenGL 4.5 core context.
EGLContext make_context(const Candidate& candidate, bool debug, EGLDisplay& display, Refusal& refusal) {
  // eglGetPlatformDisplay cannot be used: libepoxy aborts on it, because it cannot know the version EGL 1.5 before
  // there is a display.
  display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
    refusal.reason = fmt::format("eglInitialize fails (EGL error 0x{:x})", eglGetError());
    return EGL_NO_CONTEXT;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_create_context", "EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"})
    if (!has_word(extensions, needed)) {
      refusal.reason = fmt::format("it lacks {}", needed);
      return EGL_NO_CONTEXT;
    }
  eglBindAPI(EGL_OPENGL_API);
  EGLContext context = core_context(display, 4, 5, debug);
  if (context == EGL_NO_CONTEXT) {
    refusal.reason = fmt::format("it has no OpenGL 4.5 core (EGL error 0x{:x})", eglGetError());
    if (const std::string most = offered(display); !most.empty())
      refusal = {fmt::format("its driver offers {} only", most), true};
  }
  return context;
}

}  // namespace

EglContext::EglContext(DebugMode debug) {
  require_libraries();
  std::string refusals;
  bool too_old = false;
  for (const Candidate& candidate : candidates()) {
    EGLDisplay display = EGL_NO_DISPLAY;
    Refusal refusal;
    EGLContext context = make_context(candidate, debug != DebugMode::off, display, refusal);
    if (context != EGL_NO_CONTEXT && !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      refusal.reason = fmt::format("its context cannot be made current (EGL error 0x{:x})", eglGetError());
      eglDestroyContext(display, context);
      context = EGL_NO_CONTEXT;
    }
    if (context != EGL_NO_CONTEXT) {
      display_ = display;
      context_ = context;
      platform_ = candidate.name;
      log_.install(debug);
      return;
    }
    refusals += fmt::format("{}{}: {}", refusals.empty() ? "" : ", ", candidate.name, refusal.reason);
    too_old |= refusal.too_old;
  }
  std::string advice = what_to_install;
  if (too_old) {
    const std::string set = choosing_variables();
    advice = set.empty() ? "install a newer driver" : fmt::format("what is set can be the reason: {}", set);
  }
  throw Error(ErrorKind::device,
              fmt::format("no OpenGL 4.5 without a display: {}; {}",
                          refusals.empty() ? "EGL offers no device and no surfaceless platform" : refusals, advice));
}

EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // eglTerminate is not called, because EGL gives the same display to all contexts of a device. It would end the other
  // contexts too.
}

void EglContext::make_current() const {
  if (eglGetCurrentContext() == context_) return;
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    throw Error(
        ErrorKind::defect,
        fmt::format("the OpenGL context cannot be made current here (EGL error 0x{:x}); a Renderer belongs to the "
                    "thread that made it",
                    eglGetError()));
}

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
