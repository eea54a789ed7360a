#include "engine_bridge/gl/fog_pass.h"

#include <algorithm>

#include "engine_bridge/gl/fences.h"

namespace pellucid::gl {
namespace {

constexpr GLuint kDensityUnit = 12, kEmissionUnit = 14, kValuesBlock = 2, kLightsBlock = 1;  // shaders/gl/fog.frag

// Mirrors FogValues of shaders/gl/fog.frag.
struct FogBlock {
  shading::Medium medium;
  glm::mat4 volumeFromView{1.0f};
  glm::vec4 pixelRay{0.0f};    // offset, scale
  glm::ivec4 gridTexels{1};    // size; w: lights
  glm::ivec4 volumeTexels{1};  // size of one light; w: 1 where there is one
  glm::ivec4 choices{0};       // order of the march; 1 orthographic; 1 for net coverage
  glm::vec4 spread{0.0f};      // k0, k1 metres; F_px
};
static_assert(sizeof(shading::Medium) == 13 * 16 && sizeof(FogBlock) == 22 * 16);

}  // namespace

void FogPass::upload(const Fog& fog) {
  const float one = 1.0f;
  const glm::vec4 open(1.0f);
  if (!density_ || densityOf_ != fog.grid) {
    densityOf_ = fog.grid;
    density_ = fog.grid ? upload3d(fog.grid->density.size, GL_R32F, GL_RED, fog.grid->density.texels.data())
                        : upload3d(glm::ivec3(1), GL_R32F, GL_RED, &one);
    emission_ = fog.gridEmits()
                    ? upload3d(fog.grid->emission.size, GL_RGBA32F, GL_RGBA, fog.grid->emission.texels.data())
                    : upload3d(glm::ivec3(1), GL_RGBA32F, GL_RGBA, &open);
  }
  if (!open_) open_ = upload3d(glm::ivec3(1), GL_RGBA32F, GL_RGBA, &open);
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
  block.choices = {fog.order, frame.rays.orthographic ? 1 : 0, fog.diffusion.netCoverage, 0};
  block.spread = {fog.diffusion.k0, fog.diffusion.k1, fog.diffusion.focalPixels, 0.0f};
  glNamedBufferData(values_.name(), sizeof(block), &block, GL_STREAM_DRAW);
  const shading::PunctualLight none{};
  const std::size_t lights = std::max<std::size_t>(fog.lights.size(), 1);
  glNamedBufferData(lights_.name(), static_cast<GLsizeiptr>(lights * sizeof(none)),
                    fog.lights.empty() ? &none : fog.lights.data(), GL_STREAM_DRAW);
  glUseProgram(programs().get("gl/fullscreen.vert", "gl/fog.frag", frame.defines).name.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kValuesBlock, values_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLightsBlock, lights_.name());
  glBindTextureUnit(kDensityUnit, density_.name());
  glBindSampler(kDensityUnit, 0);
  glBindTextureUnit(kEmissionUnit, emission_.name());
  glBindSampler(kEmissionUnit, 0);
  if (fog.visibility)
    visibility_.bind(fog.visibility);
  else
    glBindTextureUnit(kLightVolumeUnit, open_.name());
  glBindVertexArray(noVertices_.name());
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  fences().mark();
  checkGl("marching fog");
}

}  // namespace pellucid::gl
