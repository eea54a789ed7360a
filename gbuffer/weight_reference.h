// Sums whose weights are powers of depth over other reference depths: the same sums but for a factor.
#pragma once
#include <optional>

#include "gbuffer/accum.h"
#include "gbuffer/rim_planes.h"

namespace pellucid {

bool readsReference(const shading::WeightSettings& weight);
// Kind and numbers agree, but for a reference depth.
bool sameButForReference(const shading::WeightSettings& a, const shading::WeightSettings& b);
// What a weight over the reference of `from` is to be multiplied by to be one over that of `to`; they are the same but
// for their reference. May lie beyond float.
double referenceFactor(const shading::WeightSettings& from, const shading::WeightSettings& to);

// Multiplies all that is weighed. False, and the planes mean nothing, where a sum leaves the range of floats: those of
// the published tier, which are halves, always do.
bool scaleWeights(OitPlanes& planes, double factor);
bool scaleWeights(RimPlanes& rims, double factor);

}  // namespace pellucid
