// Fragment lists through the targets of the `published` tier, on the CPU.
#pragma once
#include "gbuffer/fragments.h"
#include "gbuffer/published.h"

namespace pellucid {

// Replaces what planes (of emptyPublishedPlanes) hold in the lists' window by what the 112-bit targets hold after the
// lists' layers were blended into them in list order. Counts into `clamps` what did not fit.
void foldPublished(const FragmentLists& lists, const shading::WeightSettings& weight, OitPlanes& planes,
                   PublishedClamps& clamps);

}  // namespace pellucid
