// Fragment lists through the targets of the `published` tier, on the CPU.
#pragma once
#include "gbuffer/fragments.h"
#include "gbuffer/published.h"

namespace pellucid {

// Replaces what planes (of emptyPublishedPlanes) hold in the lists' window by what the 112-bit targets hold after the
// lists' layers were blended into them in list order. Counts into `clamps` what did not fit.
void foldPublished(const FragmentLists& lists, const shading::WeightSettings& weight, OitPlanes& planes,
                   PublishedClamps& clamps);

// Sums that came about elsewhere as one layer of these targets, which does not bend.
//   variance  by which it spreads, float pixels^2
shading::PublishedTargets publishedLayer(const shading::OitSums& sums, float variance = 0.0f);
// Blends one more layer into a pixel of such planes, whatever else it holds: fog, or what was drawn at low resolution.
void blendPublished(const shading::PublishedTargets& layer, OitPlanes& planes, int x, int y, PublishedClamps& clamps);

}  // namespace pellucid
