// Sums that no order changes: the `exact` tier.
#pragma once
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"

namespace pellucid {

// As foldFragments(), but each pixel's terms are added by shaders/shared/exact_sums.glsl, whose additions are exact,
// and rounded once. The lists must hold every fragment of their pixels: sums already in the planes are replaced. Bits
// are the same for every order of the lists; each plane is the true sum of its terms, but for 2^-84 of the largest of a
// thousand, rounded to float.
void foldExact(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation, OitPlanes& planes);

// Only what foldScattering() says, with the bits of foldExact(). Whatever the planes hold in the lists' window is
// replaced, so that planes may be used again; false where nothing there refracts or diffuses.
//   planes  as emptyScatterPlanes() makes them
bool foldExactScattering(const FragmentLists& lists, OitPlanes& planes);

}  // namespace pellucid
