// The depth of a deep picture's samples at other places of their pixels, as `gbuffer/depth_plane.h` has it of a flat
// one.
#pragma once
#include <vector>

#include "composite/deep/deep_opaque.h"

namespace pellucid {

// Each sample lies on a plane whose slope the neighbouring pixels tell: of their samples those that continue it. Where
// none do, its depth is that of the centre all over the pixel.
class SamplePlanes {
 public:
  //   opaque  must outlive this
  SamplePlanes(const DeepOpaque& opaque, bool orthographic);

  // Puts the samples of the same picture where they are at one place in every pixel, and its farthest depths.
  //   sample  (0..1, y down), (0.5, 0.5) the centre
  void moveTo(glm::dvec2 sample, DeepOpaque& moved) const;

 private:
  const DeepOpaque& centres_;
  bool orthographic_;
  std::vector<glm::vec2> slopes_;  // per sample, as DepthPlane::across and down
};

}  // namespace pellucid
