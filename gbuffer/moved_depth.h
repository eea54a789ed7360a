// The opaque depth of a picture as another camera would have it: at another time, or from another point of the lens.
#pragma once
#include <cstdint>

#include "gbuffer/depth_plane.h"

namespace pellucid {

// Every pixel's plane is carried over as the small square that it is in the picture; where several land on one sample
// the nearest counts. What the picture does not show, behind its nearest surfaces and beyond its borders, is taken to
// go on as what lies beside it, farther away. The picture must be flat: one surface a pixel.
//   taken   the camera of the picture
//   from    the other one
//   sample  where in the pixel, (0..1, y down)
//   viewZ   out, of the data window: planar metres along `from`'s axis, +inf where nothing is hit
//   unseen  out, where it is not null: 1 where nothing that the picture shows landed, else 0
void depthFrom(const DepthPlanes& planes, const GBuffer& gbuffer, const Camera& taken, const Camera& from,
               glm::dvec2 sample, Image<float>& viewZ, Image<std::uint8_t>* unseen = nullptr);

}  // namespace pellucid
