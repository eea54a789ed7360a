#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

thread_local std::string lastMessage;  // what KHR_debug said since the last check

void GLAPIENTRY onMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* text, const void*) {
  if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH) lastMessage = text;
}

bool debugWanted() {
  return std::getenv("PELLUCID_GL_DEBUG") != nullptr;
}

bool contains(const char* extensions, const char* name) {
  if (!extensions) return false;
  const std::string padded = std::string(" ") + extensions + " ";
  return padded.find(std::string(" ") + name + " ") != std::string::npos;
}

// libepoxy ends the process on a call that nobody provides, so every entry point is asked for first.
const char* clientExtensions() {
  return eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
}

std::vector<EGLDeviceEXT> eglDevices() {
  const char* extensions = clientExtensions();
  if (!contains(extensions, "EGL_EXT_device_base") && !contains(extensions, "EGL_EXT_device_enumeration")) return {};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!eglQueryDevicesEXT(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

struct Opened {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string failure;  // empty when open and current
};

Opened openOn(EGLDisplay display, const std::string& what) {
  Opened opened;
  opened.display = display;
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
    opened.failure = what + ": no display";
    return opened;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!contains(extensions, "EGL_KHR_surfaceless_context") || !contains(extensions, "EGL_KHR_no_config_context") ||
      !contains(extensions, "EGL_KHR_create_context")) {
    opened.failure = what + ": no surfaceless contexts";
    return opened;
  }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                               4,
                               EGL_CONTEXT_MINOR_VERSION_KHR,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                               EGL_CONTEXT_FLAGS_KHR,
                               debugWanted() ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                               EGL_NONE};
  if (eglBindAPI(EGL_OPENGL_API))
    opened.context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (opened.context == EGL_NO_CONTEXT) {
    opened.failure = what + ": no OpenGL 4.5 core";
    return opened;
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, opened.context)) {
    eglDestroyContext(display, opened.context);
    opened.context = EGL_NO_CONTEXT;
    opened.failure = what + ": the context cannot be made current";
  }
  return opened;
}

EGLDisplay displayOf(EGLenum platform, void* native) {
  return eglGetPlatformDisplayEXT(platform, native, nullptr);
}

Opened openAny(int device) {
  const char* extensions = clientExtensions();
  const bool platforms = contains(extensions, "EGL_EXT_platform_base");
  const bool onDevices = platforms && contains(extensions, "EGL_EXT_platform_device");
  std::string tried;
  auto keepTrying = [&tried](const Opened& opened) {
    tried += (tried.empty() ? "" : "; ") + opened.failure;
    return !opened.failure.empty();
  };
  if (device < 0 && platforms && contains(extensions, "EGL_MESA_platform_surfaceless")) {
    Opened opened = openOn(displayOf(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY), "EGL surfaceless platform");
    if (!keepTrying(opened)) return opened;
  }
  const std::vector<EGLDeviceEXT> devices = onDevices ? eglDevices() : std::vector<EGLDeviceEXT>{};
  if (device >= static_cast<int>(devices.size()))
    throw ResourceError(fmt::format("GL: no device {}: found {} EGL devices", device, devices.size()));
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (device >= 0 && i != static_cast<std::size_t>(device)) continue;
    Opened opened = openOn(displayOf(EGL_PLATFORM_DEVICE_EXT, devices[i]), fmt::format("EGL device {}", i));
    if (!keepTrying(opened)) return opened;
  }
  if (tried.empty()) tried = "EGL offers neither the surfaceless platform nor devices";
  throw ResourceError("GL: no OpenGL 4.5 core context: tried " + tried);
}

}  // namespace

namespace {

std::mutex contextsMutex;
// What belongs to a context as a whole.
struct OfContext {
  gl::Fences fences;
  gl::ProgramCache programs;
};
std::unordered_map<EGLContext, OfContext*> knownContexts;  // under contextsMutex

OfContext& ofCurrentContext() {
  const std::lock_guard lock(contextsMutex);
  const auto found = knownContexts.find(eglGetCurrentContext());
  if (found == knownContexts.end()) throw std::logic_error("no context of GlContext is current");
  return *found->second;
}

}  // namespace

struct GlContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::optional<OfContext> own;
};

GlContext::GlContext(int device) : impl_(std::make_unique<Impl>()) {
  const Opened opened = openAny(device);
  impl_->display = opened.display;
  impl_->context = opened.context;
  impl_->own.emplace();
  {
    const std::lock_guard lock(contextsMutex);
    knownContexts[impl_->context] = &*impl_->own;
  }
  if (debugWanted()) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(onMessage, nullptr);
  }
}

// The display belongs to the process: another context may use it.
GlContext::~GlContext() {
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext current = eglGetCurrentContext();
  if (current != impl_->context) eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context);
  {
    const std::lock_guard lock(contextsMutex);
    knownContexts.erase(impl_->context);
  }
  impl_->own.reset();
  const bool others = current != impl_->context && current != EGL_NO_CONTEXT;
  eglMakeCurrent(others ? display : impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, others ? current : EGL_NO_CONTEXT);
  eglDestroyContext(impl_->display, impl_->context);
}

std::string GlContext::description() const {
  auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
  return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

std::vector<std::string> listDevices() {
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  std::vector<std::string> lines;
  const std::size_t count = eglDevices().size();
  for (std::size_t i = 0; i < count; ++i) {
    std::string found;
    try {
      found = GlContext(static_cast<int>(i)).description();
    } catch (const ResourceError& error) {
      found = std::string("unusable: ") + error.what();
    }
    lines.push_back(fmt::format("{}: {}", i, found));
  }
  if (context != EGL_NO_CONTEXT) eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
  return lines;
}

namespace gl {

Fences& fences() {
  return ofCurrentContext().fences;
}

ProgramCache& programs() {
  return ofCurrentContext().programs;
}

void checkGl(std::string_view doing) {
  bool outOfMemory = false;
  GLenum first = GL_NO_ERROR;
  // A lost context reports for ever.
  for (int i = 0; i < 16; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (error == GL_OUT_OF_MEMORY) outOfMemory = true;
    if (first == GL_NO_ERROR) first = error;
  }
  const std::string message = std::exchange(lastMessage, {});
  if (outOfMemory) throw ResourceError(fmt::format("GL: out of memory while {}", doing));
  if (first != GL_NO_ERROR || !message.empty())
    throw std::logic_error(fmt::format("GL error {:#x} while {}: {}", first, doing, message));
}

}  // namespace gl
}  // namespace pellucid
