#include "composite/pipeline/surface_light.h"

#include <algorithm>

#include "composite/pipeline/air.h"
#include "engine_bridge/embree/surface_shadows.h"

namespace pellucid {

std::shared_ptr<const SurfaceVisibility> surfaceLight(const CastShadows& shadows, const Shot& shot,
                                                      std::shared_ptr<const Fog> fog) {
  if (!shot.hasScene || !(shadows.rays || (shadows.maps && fog))) return nullptr;
  const bool lit = std::any_of(shot.scene.primitives.begin(), shot.scene.primitives.end(), [&](const Primitive& each) {
    const Material& material = shot.scene.materials[static_cast<std::size_t>(each.material)];
    return material.transparent() && !material.unlit && !isParticle(each, material);
  });
  if (!lit) return nullptr;
  SurfaceVisibility surfaces;
  if (shadows.rays) {
    surfaces = surfaceShadows(shot.scene, shot.camera, shot.opaque.gbuffer, shadows.rays);
  } else {
    std::vector<std::size_t> numbers;  // into Scene::lights
    for (std::size_t i = 0; i < shot.scene.lights.size(); ++i)
      if (shines(shot.scene.lights[i])) numbers.push_back(i);
    surfaces = [maps = shadows.maps, numbers](std::size_t light, const glm::dvec3& point, std::uint32_t) {
      return maps->visibility(numbers[light], glm::vec3(point));
    };
  }
  auto air = std::make_shared<const AirBetween>(shot, std::move(fog), shadows.rays != nullptr);
  if (air->clear()) return std::make_shared<const SurfaceVisibility>(std::move(surfaces));
  const std::vector<PunctualLight> lights = lightBlocks(shot.scene.lights, shot.camera);
  return std::make_shared<const SurfaceVisibility>(
      [surfaces, air, lights](std::size_t light, const glm::dvec3& point, std::uint32_t identity) {
        const glm::vec3 passed = surfaces(light, point, identity);
        return passed == glm::vec3(0.0f) ? passed : passed * air->passed(lights[light], point);
      });
}

}  // namespace pellucid
