// The pyramid of shaders/shared/gather.glsl, eight rows of texels side by side: the same bits, in less time.
#pragma once
#include <optional>

#include "composite/lookup_text.h"

namespace pellucid::shading {

// GatherText::gatherPyramid; nothing where taps lie beyond what a level repeats of its border.
std::optional<GatherText::Gathered> widePyramid(GatherText& text, int level, vec2 centre, float spread, float layerZ);

// Fills columns of a level from what lies below it: GatherText::halvedTexel of each of its texels.
//   x0, x1  of the columns that may hold something
void wideHalved(GatherText& text, int level, int x0, int x1, SpreadLevel& made);

}  // namespace pellucid::shading
