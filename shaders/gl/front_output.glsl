#pragma once
// The planes of the nearest layer, beside the sums of the others, whose outputs come before.
#include "shared/front_tail.glsl"

layout(location = 6) out vec4 frontRadiance;
layout(location = 7) out vec4 frontDepth;

void writeFront(Layer layer) {
  FrontTargets targets = packFront(layer);
  frontRadiance = targets.radiance;
  frontDepth = targets.depth;
  writeNothing();
}

void writeTail(Layer layer, WeightSettings settings) {
  frontRadiance = vec4(0.0f);
  frontDepth = vec4(0.0f);
  writeSums(layer, settings);
}
