#include "gl/egl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "scenes/error.h"

namespace noonmark::gl {
namespace {

constexpr const char* what_to_install = "on Debian, apt install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri";

// libepoxy ends the process when it cannot open what it needs, so look first, for what it looks for (1.5.10): EGL, and
// OpenGL from the first of two. They stay open: epoxy holds pointers into them.
void require_libraries() {
  const auto opens = [](const char* name) { return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr; };
  const auto fail = [] {
    throw Error(ErrorKind::device, fmt::format("OpenGL cannot be loaded: {}; {}", dlerror(), what_to_install));
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

// Best first: GPUs in the order in which EGL enumerates them, then Mesa's surfaceless platform.
std::vector<Candidate> candidates() {
  const char* client_extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<Candidate> found;
  // Without it there is no eglGetPlatformDisplayEXT, and libepoxy ends the process when it is called.
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

// EGL_NO_CONTEXT and a reason when this candidate cannot give an OpenGL 4.5 core context.
EGLContext make_context(const Candidate& candidate, bool debug, EGLDisplay& display, std::string& reason) {
  // Not eglGetPlatformDisplay: libepoxy aborts on it, because before there is a display it cannot know of EGL 1.5.
  display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
    reason = fmt::format("eglInitialize fails (EGL error 0x{:x})", eglGetError());
    return EGL_NO_CONTEXT;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_create_context", "EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"})
    if (!has_word(extensions, needed)) {
      reason = fmt::format("it lacks {}", needed);
      return EGL_NO_CONTEXT;
    }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                               4,
                               EGL_CONTEXT_MINOR_VERSION_KHR,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                               EGL_CONTEXT_FLAGS_KHR,
                               debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                               EGL_NONE};
  eglBindAPI(EGL_OPENGL_API);
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) reason = fmt::format("it has no OpenGL 4.5 core (EGL error 0x{:x})", eglGetError());
  return context;
}

}  // namespace

EglContext::EglContext(DebugMode debug) {
  require_libraries();
  std::string refusals;
  for (const Candidate& candidate : candidates()) {
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string reason;
    EGLContext context = make_context(candidate, debug != DebugMode::off, display, reason);
    if (context != EGL_NO_CONTEXT && !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      reason = fmt::format("its context cannot be made current (EGL error 0x{:x})", eglGetError());
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
    refusals += fmt::format("{}{}: {}", refusals.empty() ? "" : ", ", candidate.name, reason);
  }
  throw Error(
      ErrorKind::device,
      fmt::format("no OpenGL 4.5 without a display: {}; {}",
                  refusals.empty() ? "EGL offers no device and no surfaceless platform" : refusals, what_to_install));
}

EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // No eglTerminate: EGL hands every context of a device the same display, and terminating it would end the others'.
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

}  // namespace noonmark::gl
