#pragma once
// Adds one layer to the targets of PT17 table 2.
#include "shared/published.glsl"

PLANE_OUTPUTS  // radianceSum, betaProduct: rgb; a: the sum of spreads, deltaSum where layers scatter

#ifndef UNCOUNTED
layout(std430, binding = 3) buffer Clamped { uint clampedNumbers; };  // where other outputs list fragments
#endif

void writePublished(Layer layer, Scatter scatter, WeightSettings settings) {
  PublishedTargets targets = packPublished(layer, scatter, settings);
  radianceSum = targets.radiance;
  betaProduct = targets.beta;
#ifdef SCATTER
  deltaSum = targets.delta;
#endif
#ifndef UNCOUNTED
  if (targets.clamped > 0) atomicAdd(clampedNumbers, uint(targets.clamped));
#endif
}
