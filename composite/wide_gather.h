// The gathers of shaders/shared/gather.glsl over rows of taps, eight at a time: the same bits, in less time.
#pragma once
#include <optional>

#include "composite/lookup_text.h"

namespace pellucid::shading {

// GatherText::gatherGaussian; nothing where taps lie beyond the picture or one may lie at the very centre, which the
// text alone knows.
std::optional<GatherText::Gathered> wideGaussian(const GatherText& text, vec2 centre, float spread, float layerZ);

// GatherText::gatherPyramid; nothing where taps lie beyond what a level repeats of its border.
std::optional<GatherText::Gathered> widePyramid(GatherText& text, int level, vec2 centre, float spread, float layerZ);

// Fills a level from what lies below it: GatherText::halvedTexel of a row.
//   y  of the texels that may hold something
void wideHalvedRow(GatherText& text, int level, int y, SpreadLevel& made);

}  // namespace pellucid::shading
