// Whether a mesh has an inside.
#pragma once
#include "engine_bridge/scene/scene.h"

namespace pellucid {

// A mesh is closed when its edges are walked as often in one direction as in the other, corners at one position being
// one, and its faces' areas cancel as vectors; one edge in a thousand may be open. Of meshes of more than kMostTested
// triangles, and of those that stay in their file, only the areas are looked at.
bool isClosed(const Primitive& primitive);
constexpr std::size_t kMostTested = std::size_t{1} << 19;

}  // namespace pellucid
