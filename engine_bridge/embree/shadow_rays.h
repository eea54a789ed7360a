// Shadows of transparent things, exactly: the part of each light that passes them on its way to a point, by rays that
// meet every surface. The truth that shadow maps approximate. PT17 section 5, MODEL section 6
#pragma once
#include <memory>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/medium.h"

namespace pellucid {

class ShadowRays {
 public:
  // As transparent things cast; or as renderers cast that know no others: what covers half of where it is hides all.
  enum class Casters { transparent, opaque };

  // The scene must outlive this. Throws ResourceError when memory runs out.
  ShadowRays(const Scene& scene, const Camera& camera, Casters casters = Casters::transparent);
  ~ShadowRays();

  // product of (1 - rho) over the transparent surfaces between a point and a light, per channel, [0,1]; 1 where the
  // light does not reach at all. Surfaces whose material casts no shadow are passed over. A single-sided mesh counts by
  // its faces towards the light; by the others only where none of them is met, so that a lone pane lit from behind
  // still counts. Cut-out leaves are cut hard; textures are read bilinearly at level 0.
  //   light  index into Scene::lights
  //   point  view space, metres
  glm::vec3 visibility(std::size_t light, const glm::dvec3& point) const;
  // The same of a point on a transparent triangle, which is passed over.
  //   identity  of the triangle, as Fragment::identity
  glm::vec3 visibilityFrom(std::uint32_t identity, std::size_t light, const glm::dvec3& point) const;

  // The same for every pixel of a G-buffer, at the mean of `samples` positions in it: 1 is its centre. Between depths
  // of one surface the position follows its plane. 1 where nothing was hit. The same bits for every number of threads.
  //   air  multiplies what arrives at each position; empty: nothing is in the air
  Image<glm::vec3> visibility(std::size_t light, const GBuffer& gbuffer, int samples, const AirPassed& air = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
