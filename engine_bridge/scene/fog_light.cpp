#include "engine_bridge/scene/fog_light.h"

#include <algorithm>
#include <cmath>

#include "engine_bridge/scene/light_volume.h"

namespace pellucid {

FogLight::FogLight(std::shared_ptr<const Fog> fog) : fog_(std::move(fog)) {
  if (!fog_->grid) return;
  const glm::dmat3 worldFromBox(glm::inverse(fog_->grid->boxFromWorld));
  const glm::dvec3 voxels(fog_->grid->density.size);
  step_ = 0.5 * std::min({glm::length(worldFromBox[0]) / voxels.x, glm::length(worldFromBox[1]) / voxels.y,
                          glm::length(worldFromBox[2]) / voxels.z});
}

float FogLight::passed(const shading::PunctualLight& light, const glm::dvec3& point) const {
  const shading::Arriving arriving = shading::arrivingAt(light, glm::vec3(point));
  if (arriving.irradiance == glm::vec3(0.0f)) return 1.0f;
  if (!fog_->grid) return shading::lightPassed(fog_->medium, light, arriving.toLight, glm::vec3(point));
  const float depth = gridDepth(*fog_, light, point, step_);
  return depth > 0.0f ? std::exp(-depth) : 1.0f;
}

}  // namespace pellucid
