#include "engine_bridge/gl/current_context.h"

#include <epoxy/egl.h>

#include <stdexcept>

namespace pellucid {

CurrentContext::CurrentContext() : display_(eglGetCurrentDisplay()), context_(eglGetCurrentContext()) {}

void CurrentContext::restore() const {
  if (eglGetCurrentContext() == context_) return;
  if (context_) eglBindAPI(EGL_OPENGL_API);  // which threads forget
  const EGLDisplay display = context_ ? display_ : eglGetCurrentDisplay();
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    throw std::logic_error("a GL context is current on another thread");
}

}  // namespace pellucid
