// The light that the rims of cut-out leaves get from around, apart from the other sums: what `resolve` darkens by the
// occlusion of the opaque pixels beside them.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/image.h"

namespace pellucid {

// Sums over the rims (0 < coverage < 1) of the data window; k is coverage times the weight of depth.
struct RimPlanes {
  Image<glm::vec4> averaged;  // what occlusion 0 takes from A.rgb; k
  Image<glm::vec4> added;     // what it takes from E.rgb; k z, planar metres
  Image<glm::vec2> gradient;  // k times the change of coverage per pixel, y down

  bool empty() const { return averaged.empty(); }
  RimPlanes() = default;
  RimPlanes(int width, int height)
      : averaged(width, height, glm::vec4(0.0f)),
        added(width, height, glm::vec4(0.0f)),
        gradient(width, height, glm::vec2(0.0f)) {}
  // Adds another's sums; either may be empty.
  void add(const RimPlanes& other) {
    if (other.empty()) return;
    if (empty()) *this = RimPlanes(other.averaged.width(), other.averaged.height());
    for (std::size_t i = 0; i < averaged.size(); ++i) {
      averaged[i] += other.averaged[i];
      added[i] += other.added[i];
      gradient[i] += other.gradient[i];
    }
  }
};

}  // namespace pellucid
