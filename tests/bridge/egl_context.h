// Contexts of one's own making, where GlContext is not enough: shared ones, and those of the compatibility profile.
#pragma once
#include <epoxy/egl.h>
#include <gtest/gtest.h>

namespace pellucid::test {

// Current from its making to its end; then what was current before is again.
class EglContext {
 public:
  //   share  whose objects it has too, or none
  explicit EglContext(bool core, EGLContext share = EGL_NO_CONTEXT)
      : display_(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)),
        before_(eglGetCurrentContext()) {
    static constexpr EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    if (before_ != EGL_NO_CONTEXT) display_ = eglGetCurrentDisplay();
    EXPECT_TRUE(eglInitialize(display_, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API));
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, share, core ? attributes : nullptr);
    EXPECT_NE(context_, EGL_NO_CONTEXT);
    use();
  }
  ~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, before_);
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void use() const { EXPECT_TRUE(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)); }
  EGLContext name() const { return context_; }

 private:
  EGLDisplay display_;
  EGLContext before_, context_ = EGL_NO_CONTEXT;
};

}  // namespace pellucid::test
