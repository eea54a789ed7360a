#pragma once
// Adds one layer to the targets of PT17 table 2.
#include "shared/published.glsl"

layout(location = 0) out vec4 radianceSum;
layout(location = 1) out vec4 betaProduct;  // rgb; a: the sum of spreads
layout(location = 2) out vec2 deltaSum;

#ifndef UNCOUNTED
layout(std430, binding = 3) buffer Clamped { uint clampedNumbers; };  // where other outputs list fragments
#endif

void writePublished(Layer layer, Scatter scatter, WeightSettings settings) {
  PublishedTargets targets = packPublished(layer, scatter, settings);
  radianceSum = targets.radiance;
  betaProduct = targets.beta;
  deltaSum = targets.delta;
#ifndef UNCOUNTED
  if (targets.clamped > 0) atomicAdd(clampedNumbers, uint(targets.clamped));
#endif
}
