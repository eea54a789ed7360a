// Fragment lists to sums, in the order given, as GL's blending makes them.
#pragma once
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"

namespace pellucid {

// Adds every fragment of the lists to `planes`, whose window must contain theirs, in list order; solid and frontZ
// included. Solid fragments in a list, and fragments behind the solid, are not added.
void foldFragments(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
                   OitPlanes& planes);

// Only what scattering needs of the same: refraction, diffuseZ, the depth of the refracting layers in light.a, and the
// solid plane. Planes stay without refraction when no fragment refracts or diffuses. foldFragments() does it too.
void foldScattering(const FragmentLists& lists, OitPlanes& planes);

// What folds share. A fragment takes part unless it is solid or lies behind the solid.
shading::Layer layerFrom(const Fragment& fragment);
shading::Scatter scatterFrom(const Fragment& fragment);
bool takesPart(const Fragment& fragment, const glm::vec4& solid);
void copySolids(const FragmentLists& lists, OitPlanes& planes);

}  // namespace pellucid
