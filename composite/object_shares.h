// How much of an edge pixel either of its surfaces has, told by the objects that they belong to.
#pragma once
#include <optional>

#include "composite/surface_sides.h"

namespace pellucid {

// The part of pixel (x, y) that the nearer of its own surface and the one on the other side has, of both, [0,1].
// Nothing where the picture's file does not tell objects apart, or one object lies on both sides, as before itself.
std::optional<double> nearerShare(const GBuffer& gbuffer, const SurfaceSides& sides, int x, int y, Side other);

}  // namespace pellucid
