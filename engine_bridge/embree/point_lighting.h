// Light that reaches one point of an opaque surface and leaves towards the eye: through the shared shading text, with
// rays for what is in the way. View space.
#pragma once
#include <cstdint>
#include <vector>

#include "engine_bridge/embree/environment.h"
#include "engine_bridge/embree/opaque_scene.h"
#include "engine_bridge/scene/blocks.h"

namespace pellucid::rays {

struct ShadePoint {
  glm::vec3 position;      // view space, metres
  glm::vec3 normal, flat;  // unit, interpolated and of the triangle, both on the eye's side
  glm::vec3 toEye;         // unit
  shading::Surface surface;
};

class Lighting {
 public:
  // All must outlive this.
  //   shadows  false: nothing is in the way of any light
  Lighting(const OpaqueScene& scene, const Environment& environment, const Camera& camera, bool shadows);

  // What one light adds. W/(m^2 sr)
  glm::vec3 direct(const PunctualLight& light, const ShadePoint& point) const;
  // What the environment adds: exact where it is constant and nothing is in the way, else the mean of `samples`
  // estimates that choose a direction by the surface and, for maps, one by the map, weighted by the balance heuristic.
  glm::vec3 surroundings(const ShadePoint& point, int samples, std::uint32_t firstSample, std::uint32_t seed) const;
  // Part of the cosine-weighted hemisphere that is open within `radius` metres. [0,1]
  float openness(const ShadePoint& point, float radius, int samples, std::uint32_t seed) const;

  // Radiance of the environment along a camera ray.
  glm::vec3 background(glm::vec3 directionView) const;

 private:
  bool blocked(const ShadePoint& point, glm::vec3 direction, float reach) const;
  glm::vec3 oneDirection(const ShadePoint& point, glm::vec3 towards, float density) const;

  const OpaqueScene& scene_;
  const Environment& environment_;
  glm::mat3 worldFromView_, viewFromWorld_;
  bool shadows_;
};

}  // namespace pellucid::rays
