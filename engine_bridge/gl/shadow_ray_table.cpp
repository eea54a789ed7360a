#include "engine_bridge/gl/shadow_ray_table.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <chrono>
#include <limits>

#include "gbuffer/errors.h"
#include "shaders/shading.h"

namespace pellucid::gl {
namespace {

constexpr GLuint kUnit = 12;  // shaders/gl/shadow_rays.glsl

}  // namespace

void ShadowRayTable::begin(int width, int height, int lights) {
  width_ = width;
  lights_ = lights;
  counts_ = {};
  texels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::uvec4(0u));
}

void ShadowRayTable::add(const FragmentLists& lists, const Window& band, const SurfaceVisibility& visible,
                         const std::function<glm::dvec3(int x, int y, float z)>& place) {
  const auto start = std::chrono::steady_clock::now();
  const auto stride = static_cast<std::size_t>(1 + lights_);
  const std::size_t first = texels_.size();
  texels_.resize(first + lists.fragments.size() * stride);
  if (texels_.size() > std::numeric_limits<std::uint32_t>::max() / 2)
    throw ResourceError(
        "--shadows: more fragments than a device's table can number; --shadows stochastic without fog needs none");
  tbb::parallel_for(band.y0, band.y1, [&](int y) {
    for (int x = band.x0; x < band.x1; ++x) {
      const auto pixel = static_cast<std::size_t>((y - band.y0) * band.width() + x - band.x0);
      const std::uint64_t begin = lists.offsets[pixel], end = lists.offsets[pixel + 1];
      float solid = std::numeric_limits<float>::infinity();
      for (std::uint64_t i = begin; i < end; ++i)
        if (shading::isSolid(lists.fragments[i].coverage, lists.fragments[i].transmission))
          solid = std::min(solid, lists.fragments[i].z);
      const std::size_t own = first + begin * stride;
      texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] = {
          static_cast<std::uint32_t>(own), static_cast<std::uint32_t>(end - begin), 0u, 0u};
      for (std::uint64_t i = begin; i < end; ++i) {
        const Fragment& fragment = lists.fragments[i];
        glm::uvec4* row = &texels_[first + i * stride];
        row[0] = {fragment.identity, std::bit_cast<std::uint32_t>(fragment.z), 0u, 0u};
        const glm::dvec3 point = place(x, y, fragment.z);
        for (int light = 0; light < lights_; ++light) {
          glm::vec3 passed(1.0f);
          if (fragment.z <= solid) passed = visible(static_cast<std::size_t>(light), point, fragment.identity);
          row[1 + light] = {std::bit_cast<glm::uvec3>(passed), 0u};
        }
      }
    }
  });
  counts_.rays += lists.fragments.size() * static_cast<std::size_t>(lights_);
  counts_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ShadowRayTable::Counts ShadowRayTable::finish() {
  if (!storage_) {
    storage_ = Buffer::make();
    texture_ = BufferTexture::make();
  }
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (texels_.size() > static_cast<std::size_t>(most))
    throw ResourceError(
        fmt::format("GL: --shadows: light at the fragments takes {} texels, and the device holds at most {}; "
                    "--shadows stochastic without fog needs none",
                    texels_.size(), most));
  glNamedBufferData(storage_.name(), static_cast<GLsizeiptr>(texels_.size() * sizeof(glm::uvec4)), texels_.data(),
                    GL_STREAM_DRAW);
  glTextureBuffer(texture_.name(), GL_RGBA32UI, storage_.name());
  glBindTextureUnit(kUnit, texture_.name());
  glBindSampler(kUnit, 0);
  checkGl("uploading light at fragments");
  return counts_;
}

}  // namespace pellucid::gl
