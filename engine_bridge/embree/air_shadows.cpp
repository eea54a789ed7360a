#include "engine_bridge/embree/air_shadows.h"

#include <limits>
#include <vector>

#include "engine_bridge/embree/opaque_scene.h"
#include "engine_bridge/embree/shadow_rays.h"
#include "engine_bridge/scene/blocks.h"

namespace pellucid {

struct AirShadows::Impl {
  rays::OpaqueScene opaque;
  ShadowRays transparent;
  std::vector<PunctualLight> lights;
  std::vector<std::size_t> numbers;  // into Scene::lights

  Impl(const Scene& scene, const Camera& camera)
      : opaque(scene, camera), transparent(scene, camera), lights(lightBlocks(scene.lights, camera)) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (shines(scene.lights[i])) numbers.push_back(i);
  }
};

AirShadows::AirShadows(const Scene& scene, const Camera& camera) : impl_(new Impl(scene, camera)) {}
AirShadows::~AirShadows() = default;

bool AirShadows::hasOpaque() const {
  return impl_->opaque.triangles() > 0;
}

glm::vec3 AirShadows::visible(std::size_t light, const glm::dvec3& point) const {
  const PunctualLight& block = impl_->lights[light];
  const bool endless = block.direction.w == 0.0f;
  const glm::vec3 from(point);
  const glm::vec3 path = endless ? -glm::vec3(block.direction) : glm::vec3(block.position) - from;
  if (hasOpaque() && impl_->opaque.blocked(from, path, endless ? std::numeric_limits<float>::infinity() : 1.0f))
    return glm::vec3(0.0f);
  return impl_->transparent.visibility(impl_->numbers[light], point);
}

}  // namespace pellucid
