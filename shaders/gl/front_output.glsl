#pragma once
// The planes of the nearest layer, beside the sums of the others, whose outputs come before.
#include "shared/front_tail.glsl"

layout(location = 6) out vec4 frontRadiance;
#ifdef GREY
layout(location = 7) out float frontDepth;  // tau of all channels
#else
layout(location = 7) out vec4 frontDepth;
#endif

// One layer to the planes of the nearest, or to the sums of the others.
void writeFrontOrTail(Layer layer, WeightSettings settings, bool front) {
  OitSums sums = layerSums(layer, settings, NORMALISATION);
  FrontTargets targets = packFront(layer, sums.depth);
  frontRadiance = front ? targets.radiance : vec4(0.0f);
#ifdef GREY
  frontDepth = front ? targets.depth.r : 0.0f;
#else
  frontDepth = front ? targets.depth : vec4(0.0f);
#endif
  writeOitSums(sums, layer.z);
  if (front) writeNothing();
}
