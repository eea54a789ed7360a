#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {
namespace {

struct Kind {
  GLenum target, binding;
  const char* text;
};
constexpr Kind kKinds[] = {
    {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE, "a GL_TEXTURE_2D_MULTISAMPLE, to be resolved first"},
    {GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY, "a GL_TEXTURE_2D_MULTISAMPLE_ARRAY"},
    {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY, "a GL_TEXTURE_2D_ARRAY, of which a layer may be viewed"},
    {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP, "a GL_TEXTURE_CUBE_MAP"},
    {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, "a GL_TEXTURE_CUBE_MAP_ARRAY"},
    {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE, "a GL_TEXTURE_RECTANGLE"},
    {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D, "a GL_TEXTURE_3D"},
    {GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D, "a GL_TEXTURE_1D"},
    {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY, "a GL_TEXTURE_1D_ARRAY"},
    {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER, "a GL_TEXTURE_BUFFER"}};

// Where GL does not say what a texture is: whether it can be bound as one. Leaves the binding and no error.
bool isBindable(const GlFunctions& gl, GLuint name, const Kind& kind) {
  GLint bound = 0, now = 0;
  gl.GetIntegerv(kind.binding, &bound);
  gl.BindTexture(kind.target, name);
  gl.GetIntegerv(kind.binding, &now);
  const bool fits = static_cast<GLuint>(now) == name;
  if (!fits) gl.GetError();
  gl.BindTexture(kind.target, static_cast<GLuint>(bound));
  return fits;
}

}  // namespace

const char* kindOf(const GlFunctions& gl, GLuint name) {
  if (name == 0) return "no texture";
  if (!gl.IsTexture(name)) return "no texture of this context";
  GLint target = 0;
  if (gl.GetTextureParameteriv) gl.GetTextureParameteriv(name, GL_TEXTURE_TARGET, &target);
  for (const Kind& kind : kKinds) {
    const bool known = kind.target != GL_TEXTURE_CUBE_MAP_ARRAY || gl.version >= 40;
    if (target ? static_cast<GLenum>(target) == kind.target : known && isBindable(gl, name, kind)) return kind.text;
  }
  return "a texture without an image";
}

bool factsOf(const GlFunctions& gl, GLuint name, TextureFacts& facts) {
  if (name == 0 || !gl.IsTexture(name)) return false;
  if (gl.GetTextureParameteriv) {
    GLint kind = 0;
    gl.GetTextureParameteriv(name, GL_TEXTURE_TARGET, &kind);
    if (kind != GL_TEXTURE_2D) return false;
  }
  GLint bound = 0, now = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  gl.BindTexture(GL_TEXTURE_2D, name);
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &now);
  const bool fits = static_cast<GLuint>(now) == name;
  if (!fits) gl.GetError();  // of the binding: a texture of another kind
  if (fits) {
    gl.GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &facts.width);
    gl.GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &facts.height);
    gl.GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &facts.format);
  }
  gl.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
  return fits;
}

GLenum depthAttachment(GLint format) {
  switch (format) {
    case GL_DEPTH_COMPONENT:
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
    case GL_DEPTH_COMPONENT32F:
      return GL_DEPTH_ATTACHMENT;
    case GL_DEPTH_STENCIL:
    case GL_DEPTH24_STENCIL8:
    case GL_DEPTH32F_STENCIL8:
      return GL_DEPTH_STENCIL_ATTACHMENT;
    default:
      return 0;
  }
}

bool isLinearDepth(GLint format) {
  switch (format) {
    case GL_R16F:
    case GL_R32F:
    case GL_RG16F:
    case GL_RG32F:
    case GL_RGBA16F:
    case GL_RGBA32F:
      return true;
    default:
      return false;
  }
}

bool isOcclusion(GLint format) {
  switch (format) {
    case GL_RED:
    case GL_R8:
    case GL_R16:
    case GL_RG8:
    case GL_RG16:
      return true;
    default:
      return isLinearDepth(format) || isColour(format);
  }
}

bool isColour(GLint format) {
  switch (format) {
    case GL_RGBA:
    case GL_RGB:
    case GL_RGBA8:
    case GL_RGB8:
    case GL_SRGB8:
    case GL_SRGB8_ALPHA8:
    case GL_RGB10_A2:
    case GL_RGBA16:
    case GL_R11F_G11F_B10F:
    case GL_RGB16F:
    case GL_RGBA16F:
    case GL_RGB32F:
    case GL_RGBA32F:
      return true;
    default:
      return false;
  }
}

}  // namespace pellucid::c
