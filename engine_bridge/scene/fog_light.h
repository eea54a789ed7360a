// What fog leaves of a lamp's light on its straight way to a point: by its closed form, or by a march of its grid.
#pragma once
#include <memory>

#include "gbuffer/medium.h"

namespace pellucid {

class FogLight {
 public:
  explicit FogLight(std::shared_ptr<const Fog> fog);

  // Whether a grid is marched for an answer, which then takes as many steps as the way has half voxels.
  bool marches() const { return fog_->grid != nullptr; }

  // Beer and Lambert: exp of minus the optical depth between the point and the light. 1 where the light sends nothing.
  // Called from several threads at once. [0,1]
  //   light  view space
  //   point  view space, metres; in the fog or beyond it
  float passed(const shading::PunctualLight& light, const glm::dvec3& point) const;

 private:
  std::shared_ptr<const Fog> fog_;
  double step_ = 0.0;  // metres
};

}  // namespace pellucid
