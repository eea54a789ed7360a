#include "engine_bridge/gl/shadow_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine_bridge/scene/blocks.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

constexpr GLuint kTableBlock = 0, kTexelUnit = 12;  // shaders/gl/shadow_maps.glsl

template <class T>
void append(std::vector<glm::ivec4>& table, const T& block) {
  static_assert(sizeof(T) % sizeof(glm::ivec4) == 0);
  const std::size_t at = table.size();
  table.resize(at + sizeof(T) / sizeof(glm::ivec4));
  std::memcpy(&table[at], &block, sizeof(T));
}

}  // namespace

ShadowTextures::ShadowTextures(const ShadowMaps& maps, const std::vector<Light>& lights)
    : table_(Buffer::make()), storage_(Buffer::make()), texels_(BufferTexture::make()) {
  std::vector<glm::ivec4> table(1, glm::ivec4(0));
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!shines(lights[i])) continue;
    append(table, maps.lights.at(i));
    ++table[0].x;
  }
  for (const shading::ShadowFace& face : maps.faces) append(table, face);
  glNamedBufferData(table_.name(), static_cast<GLsizeiptr>(table.size() * sizeof(table[0])), table.data(),
                    GL_STATIC_DRAW);
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (maps.texels.size() > static_cast<std::size_t>(most))
    throw ResourceError(
        fmt::format("GL: shadow maps of {} texels: the device holds at most {}; a smaller --shadow-size "
                    "makes fewer",
                    maps.texels.size(), most));
  const glm::vec4 none(0.0f);
  const std::size_t bytes = std::max<std::size_t>(maps.texels.size(), 1) * sizeof(glm::vec4);
  glNamedBufferData(storage_.name(), static_cast<GLsizeiptr>(bytes), maps.texels.empty() ? &none : maps.texels.data(),
                    GL_STATIC_DRAW);
  glTextureBuffer(texels_.name(), GL_RGBA32F, storage_.name());
  checkGl("uploading shadow maps");
}

void ShadowTextures::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kTableBlock, table_.name());
  glBindTextureUnit(kTexelUnit, texels_.name());
  glBindSampler(kTexelUnit, 0);
}

}  // namespace pellucid::gl
