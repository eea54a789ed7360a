#include "engine_bridge/gl/volume_texture.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/errors.h"

namespace pellucid::gl {

Texture3d upload3d(glm::ivec3 size, GLenum stored, GLenum format, const void* texels) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
  if (std::max({size.x, size.y, size.z}) > most)
    throw ResourceError(fmt::format("GL: a volume of {}x{}x{} texels: the device holds at most {} along an edge",
                                    size.x, size.y, size.z, most));
  Texture3d texture = Texture3d::make();
  glTextureStorage3D(texture.name(), 1, stored, size.x, size.y, size.z);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTextureSubImage3D(texture.name(), 0, 0, 0, 0, size.x, size.y, size.z, format, GL_FLOAT, texels);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  checkGl("uploading a volume of fog");
  return texture;
}

void VolumeTexture::bind(const std::shared_ptr<const LightVolume>& volume) {
  if (!texture_ || of_ != volume) {
    texture_ = upload3d(volume->visibility.size, GL_RGBA32F, GL_RGBA, volume->visibility.texels.data());
    of_ = volume;
  }
  glBindTextureUnit(kLightVolumeUnit, texture_.name());
  glBindSampler(kLightVolumeUnit, 0);
}

}  // namespace pellucid::gl
