// Boxes of texels on the device: densities, and what of the lights reaches a place.
#pragma once
#include <memory>

#include "engine_bridge/gl/gl_objects.h"
#include "gbuffer/medium.h"

namespace pellucid::gl {

constexpr GLuint kLightVolumeUnit = 13;  // shaders/gl/light_volume.glsl

struct Texture3dKind {
  static GLuint create() {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
using Texture3d = Handle<Texture3dKind>;

// Texels are read one by one. Throws ResourceError when the device has no room.
Texture3d upload3d(glm::ivec3 size, GLenum stored, GLenum format, const void* texels);

// A light volume's texture, uploaded when it is another.
class VolumeTexture {
 public:
  void bind(const std::shared_ptr<const LightVolume>& volume);

 private:
  Texture3d texture_;
  std::shared_ptr<const LightVolume> of_;
};

}  // namespace pellucid::gl
