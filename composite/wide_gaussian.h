// GatherText::gatherGaussian over rows of taps, eight rows side by side: the same bits, in less time.
#pragma once
#include <optional>

#include "composite/lookup_text.h"

namespace pellucid::shading {

// Nothing where taps lie beyond the picture or one may lie at the very centre, which the text alone knows.
std::optional<GatherText::Gathered> wideGaussian(const GatherText& text, vec2 centre, float spread, float layerZ);

}  // namespace pellucid::shading
