#include "composite/pipeline/deep_shadows.h"

#include <tbb/parallel_for.h>

#include "engine_bridge/scene/blocks.h"
#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

// What all lights together let through at one point, per channel.
glm::vec3 multiplierAt(const glm::dvec3& point, const std::vector<std::size_t>& lights,
                       const std::vector<PunctualLight>& blocks, const DeepVisibility& visible) {
  glm::vec3 arriving(0.0f), passed(0.0f), multiplier(1.0f);
  bool any = false;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const glm::vec3 v = visible(lights[k], point);
    any = any || v != glm::vec3(1.0f);
    const glm::vec3 sent = shading::arrivingAt(blocks[k], glm::vec3(point)).irradiance;
    arriving += sent;
    passed += sent * v;
  }
  if (any)
    for (int c = 0; c < 3; ++c) multiplier[c] = arriving[c] > 0.0f ? passed[c] / arriving[c] : 1.0f;
  return multiplier;
}

}  // namespace

DeepShadows dimDeepPicture(const Shot& shot, const std::vector<std::size_t>& lights, const DeepVisibility& visible) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  std::vector<PunctualLight> blocks;
  for (const std::size_t i : lights) blocks.push_back(lightBlock(shot.scene.lights[i], shot.camera));
  DeepShadows result{*shot.deepOpaque, {}, {}};
  DeepOpaque& picture = result.picture;
  const int width = picture.data.width(), height = picture.data.height();
  result.multiplier = Image<glm::vec3>(width, height, glm::vec3(1.0f));
  result.touched = Image<std::uint8_t>(width, height, 0);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      glm::dvec3 light(0.0), shares(0.0), dimmed(0.0);
      bool changed = false;
      for (std::uint64_t k = picture.offsets[pixel]; k < picture.offsets[pixel + 1]; ++k) {
        OpaqueSample& sample = picture.samples[k];
        const glm::dvec3 point = viewPoint(gbuffer, shot.camera, glm::dvec2(x, y), static_cast<double>(sample.z));
        const glm::vec3 multiplier = multiplierAt(point, lights, blocks, visible);
        changed = changed || multiplier != glm::vec3(1.0f);
        sample.light *= multiplier;
        light += glm::dvec3(sample.light);
        shares += glm::dvec3(sample.share);
        dimmed += glm::dvec3(sample.share * multiplier);
      }
      if (!changed) continue;
      result.touched.at(x, y) = 1;
      picture.flat.at(x, y) = glm::vec4(glm::vec3(light), picture.flat.at(x, y).a);
      for (int c = 0; c < 3; ++c)
        if (shares[c] > 0.0) result.multiplier.at(x, y)[c] = static_cast<float>(dimmed[c] / shares[c]);
    }
  });
  return result;
}

}  // namespace pellucid
