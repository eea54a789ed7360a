// What cut-out surfaces take their ambient occlusion from: the opaque pixels, and solid leaves before them.
#pragma once
#include "gbuffer/image.h"

namespace pellucid {

// Planes of one window, at pixel centres.
struct OccluderPlanes {
  Window data;
  Image<float> viewZ;      // planar metres, > 0, +inf for nothing
  Image<float> occlusion;  // ambient occlusion, [0,1], 1 = open
};

}  // namespace pellucid
