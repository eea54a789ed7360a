// Whether a mesh fills a shape whose inside is known: a ball, stretched or not, or a box, along its object's axes.
#pragma once
#include <optional>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

// Nothing where it does not: where it is open, doubled or of another shape, and of more than kMostFitted triangles.
// Throws InputError when its file is no longer what it was.
std::optional<SolidBody> closedBodyOf(const Primitive& primitive);
constexpr std::size_t kMostFitted = std::size_t{1} << 19;

}  // namespace pellucid
