// Move-only owners of GL names. Made and destroyed with their context current.
#pragma once
#include <epoxy/gl.h>

#include <string_view>
#include <utility>

namespace pellucid::gl {

template <class Kind>
class Handle {
 public:
  Handle() = default;
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  static Handle make() {
    Handle handle;
    handle.name_ = Kind::create();
    return handle;
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }
  void reset() {
    if (name_) Kind::destroy(name_);
    name_ = 0;
  }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct BufferTextureKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct SamplerKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
};
struct FramebufferKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct VertexArrayKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct ProgramKind {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

using Buffer = Handle<BufferKind>;
using Texture = Handle<TextureKind>;
using BufferTexture = Handle<BufferTextureKind>;
using Sampler = Handle<SamplerKind>;
using Framebuffer = Handle<FramebufferKind>;
using VertexArray = Handle<VertexArrayKind>;
using ProgramName = Handle<ProgramKind>;

// Throws ResourceError when GL has run out of memory while `doing` (a phrase: "uploading geometry"), std::logic_error
// for every other GL error, with the driver's own words when PELLUCID_GL_DEBUG is set.
void checkGl(std::string_view doing);

}  // namespace pellucid::gl
