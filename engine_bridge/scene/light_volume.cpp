#include "engine_bridge/scene/light_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
float gridDepth(const Fog& fog, const shading::PunctualLight& light, const glm::dvec3& point, double step) {
  if (!fog.grid) return 0.0f;
  const bool endless = light.direction.w == 0.0f;
  const glm::dvec3 path =
      endless ? -glm::dvec3(glm::vec3(light.direction)) : glm::dvec3(glm::vec3(light.position)) - point;
  const double metres = glm::length(path);
  if (!(metres > 0.0)) return 0.0f;
  const glm::dvec3 toLight = path / metres;
  const glm::vec2 inside = shading::boxSpan(fog.medium.boxFromView, glm::vec3(point), glm::vec3(toLight));
  double end = static_cast<double>(inside.y);
  if (!endless) end = std::min(end, metres);
  const double start = std::max(static_cast<double>(inside.x), 0.0);
  if (!(end > start)) return 0.0f;
  const int steps = static_cast<int>(std::clamp(std::ceil((end - start) / step), 1.0, 4096.0));
  const double length = (end - start) / steps;
  const glm::dmat4 boxFromView(fog.medium.boxFromView);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 at = point + (start + (i + 0.5) * length) * toLight;
    const glm::dvec3 texel = glm::dvec3(boxFromView * glm::dvec4(at, 1.0)) * glm::dvec3(fog.grid->density.size);
    sum += static_cast<double>(static_cast<float>(fog.grid->density.between<double>(texel)));
  }
  return static_cast<float>(sum * length * static_cast<double>(fog.medium.extinction.x));
}

std::shared_ptr<const LightVolume> sampleLights(const Fog& fog, const Box& box, int longest,
                                                const PointVisibility& visible) {
  const glm::dvec3 extent = glm::max(box.high - box.low, glm::dvec3(1e-6));
  const double edge = std::max({extent.x, extent.y, extent.z}) / longest;
  auto volume = std::make_shared<LightVolume>();
  volume->size = glm::clamp(glm::ivec3(glm::ceil(extent / edge - 1e-6)), glm::ivec3(1), glm::ivec3(longest));
  const auto lights = static_cast<int>(fog.lights.size());
  volume->visibility =
      Volume<glm::vec4>({volume->size.x, volume->size.y, volume->size.z * std::max(lights, 1)}, glm::vec4(1.0f));
  const glm::dvec3 texel = extent / glm::dvec3(volume->size);
  glm::dmat4 texelFromWorld(1.0);
  for (int c = 0; c < 3; ++c) {
    texelFromWorld[c][c] = 1.0 / texel[c];
    texelFromWorld[3][c] = -box.low[c] / texel[c];
  }
  volume->texelFromView = glm::mat4(texelFromWorld * glm::inverse(fog.camera.viewFromWorld));
  tbb::parallel_for(0, volume->size.z * lights, [&](int slice) {
    const int light = slice / volume->size.z, z = slice % volume->size.z;
    const auto number = static_cast<std::size_t>(light);
    for (int y = 0; y < volume->size.y; ++y)
      for (int x = 0; x < volume->size.x; ++x) {
        const glm::dvec3 world = box.low + texel * (glm::dvec3(x, y, z) + 0.5);
        const glm::dvec3 point(fog.camera.viewFromWorld * glm::dvec4(world, 1.0));
        glm::vec3 passed = visible ? visible(number, point) : glm::vec3(1.0f);
        if (passed != glm::vec3(0.0f)) passed *= std::exp(-gridDepth(fog, fog.lights[number], point, edge));
        volume->visibility.at({x, y, slice}) = glm::vec4(passed, 1.0f);
      }
  });
  return volume;
}

}  // namespace pellucid
