#include "engine_bridge/embree/surface_shadows.h"

#include <limits>
#include <optional>
#include <vector>

#include "engine_bridge/embree/opaque_scene.h"
#include "engine_bridge/embree/picture_surface.h"
#include "engine_bridge/scene/blocks.h"

namespace pellucid {
namespace {

constexpr double kLift = 8e-6;  // as shadow_rays.cpp

struct Surfaces {
  std::shared_ptr<const ShadowRays> transparent;
  rays::OpaqueScene opaque;
  std::optional<rays::PictureSurface> picture;  // where the scene holds nothing opaque
  std::vector<PunctualLight> lights;
  std::vector<std::size_t> numbers;  // into Scene::lights

  Surfaces(const Scene& scene, const Camera& camera, const GBuffer& gbuffer, std::shared_ptr<const ShadowRays> given)
      : transparent(std::move(given)), opaque(scene, camera), lights(lightBlocks(scene.lights, camera)) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (shines(scene.lights[i])) numbers.push_back(i);
    if (opaque.triangles() == 0) picture.emplace(gbuffer, camera);
  }

  bool blocked(const PunctualLight& light, const glm::dvec3& point) const {
    const bool endless = light.direction.w == 0.0f;
    const glm::dvec3 path =
        endless ? -glm::dvec3(glm::vec3(light.direction)) : glm::dvec3(glm::vec3(light.position)) - point;
    const double metres = glm::length(path);
    if (!(metres > 0.0)) return false;
    const double lift = picture ? picture->lift(point) : kLift * glm::length(point);
    if (!endless && lift >= metres) return false;
    const glm::vec3 from(point + lift / metres * path), towards(path);
    const float reach = endless ? std::numeric_limits<float>::infinity() : static_cast<float>(1.0 - lift / metres);
    return picture ? picture->blocked(from, towards, reach) : opaque.blocked(from, towards, reach);
  }
};

}  // namespace

SurfaceVisibility surfaceShadows(const Scene& scene, const Camera& camera, const GBuffer& gbuffer,
                                 std::shared_ptr<const ShadowRays> rays) {
  auto surfaces = std::make_shared<const Surfaces>(scene, camera, gbuffer, std::move(rays));
  return [surfaces](std::size_t light, const glm::dvec3& point, std::uint32_t identity) {
    if (surfaces->blocked(surfaces->lights[light], point)) return glm::vec3(0.0f);
    return surfaces->transparent->visibilityFrom(identity, surfaces->numbers[light], point);
  };
}

}  // namespace pellucid
