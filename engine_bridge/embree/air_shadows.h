// Shadows in the air: what a scene leaves of its lights at a point that need not lie on anything, by rays through
// opaque and transparent surfaces.
#pragma once
#include <memory>

#include "engine_bridge/scene/light_volume.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid {

class AirShadows {
 public:
  // The scene must outlive this, decoded. Throws ResourceError when memory runs out.
  AirShadows(const Scene& scene, const Camera& camera);
  ~AirShadows();

  bool hasOpaque() const;  // something opaque is there to cast shadows
  // Counts lights as lightBlocks() does: those that shine.
  glm::vec3 visible(std::size_t light, const glm::dvec3& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
