#include "engine_bridge/gl/fog_pass.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

constexpr GLuint kDensityUnit = 12, kVisibilityUnit = 13, kValuesBlock = 2, kLightsBlock = 1;  // shaders/gl/fog.frag

// Mirrors FogValues of shaders/gl/fog.frag.
struct FogBlock {
  shading::Medium medium;
  glm::mat4 volumeFromView{1.0f};
  glm::vec4 pixelRay{0.0f};     // offset, scale
  glm::ivec4 gridTexels{1};     // size; w: lights
  glm::ivec4 volumeTexels{1};   // size of one light; w: 1 where there is one
  glm::ivec4 choices{0};        // order of the march; 1 orthographic
};
static_assert(sizeof(shading::Medium) == 12 * 16 && sizeof(FogBlock) == 20 * 16);

Texture3d upload3d(glm::ivec3 size, GLenum stored, GLenum format, const void* texels) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
  if (std::max({size.x, size.y, size.z}) > most)
    throw ResourceError(fmt::format("GL: a volume of {}x{}x{} texels: the device holds at most {} along an edge", size.x,
                                    size.y, size.z, most));
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

}  // namespace

void FogPass::upload(const Fog& fog) {
  const float one = 1.0f;
  const glm::vec4 open(1.0f);
  if (!density_ || densityOf_ != fog.grid) {
    densityOf_ = fog.grid;
    density_ = fog.grid ? upload3d(fog.grid->density.size, GL_R32F, GL_RED, fog.grid->density.texels.data())
                        : upload3d(glm::ivec3(1), GL_R32F, GL_RED, &one);
  }
  if (!visibility_ || visibilityOf_ != fog.visibility) {
    visibilityOf_ = fog.visibility;
    visibility_ = fog.visibility ? upload3d(fog.visibility->visibility.size, GL_RGBA32F, GL_RGBA,
                                            fog.visibility->visibility.texels.data())
                                 : upload3d(glm::ivec3(1), GL_RGBA32F, GL_RGBA, &open);
  }
}

void FogPass::draw(const Fog& fog, const FogFrame& frame) {
  if (!values_) {
    values_ = Buffer::make();
    lights_ = Buffer::make();
    noVertices_ = VertexArray::make();
  }
  upload(fog);
  FogBlock block;
  block.medium = fog.medium;
  block.pixelRay = {frame.rays.offset, frame.rays.scale};
  block.gridTexels = {fog.grid ? fog.grid->density.size : glm::ivec3(1), static_cast<int>(fog.lights.size())};
  if (fog.visibility) {
    block.volumeFromView = fog.visibility->texelFromView;
    block.volumeTexels = {fog.visibility->size, 1};
  } else {
    block.volumeTexels = {1, 1, 1, 0};
  }
  block.choices = {fog.order, frame.rays.orthographic ? 1 : 0, 0, 0};
  glNamedBufferData(values_.name(), sizeof(block), &block, GL_STREAM_DRAW);
  const shading::PunctualLight none{};
  const std::size_t lights = std::max<std::size_t>(fog.lights.size(), 1);
  glNamedBufferData(lights_.name(), static_cast<GLsizeiptr>(lights * sizeof(none)),
                    fog.lights.empty() ? &none : fog.lights.data(), GL_STREAM_DRAW);
  glUseProgram(programs_.get("gl/fullscreen.vert", "gl/fog.frag", frame.defines).name.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kValuesBlock, values_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLightsBlock, lights_.name());
  glBindTextureUnit(kDensityUnit, density_.name());
  glBindTextureUnit(kVisibilityUnit, visibility_.name());
  glBindSampler(kDensityUnit, 0);
  glBindSampler(kVisibilityUnit, 0);
  glBindVertexArray(noVertices_.name());
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  checkGl("marching fog");
}

}  // namespace pellucid::gl
