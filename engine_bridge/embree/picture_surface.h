// What a G-buffer shows, as a surface for rays: quads between every four pixels that lie near each other, as
// shaders/gl/picture_mesh.vert draws them into shadow maps.
#pragma once
#include "engine_bridge/embree/embree_device.h"
#include "gbuffer/gbuffer.h"

namespace pellucid::rays {

class PictureSurface {
 public:
  // Throws ResourceError when memory runs out.
  PictureSurface(const GBuffer& gbuffer, const Camera& camera);

  // Whether it lies between a point and a light. View space.
  //   reach  in lengths of `direction`, infinity allowed
  bool blocked(glm::vec3 origin, glm::vec3 direction, float reach) const;
  // How far a point moves towards the light first: the depth that two pixels span at 45 degrees. Metres
  double lift(const glm::dvec3& point) const;

 private:
  Device device_;
  SceneHandle scene_;
  bool orthographic_;
  double pixel_;  // its edge at a distance of 1 m, or everywhere
};

}  // namespace pellucid::rays
