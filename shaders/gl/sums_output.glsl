#pragma once
// Adds one layer to the planes by fixed-function blending: targets 0-4 ONE, ONE; target 5 MIN.
#include "shared/accumulate.glsl"

layout(location = 0) out vec4 radianceSum;
layout(location = 1) out vec4 weightSum;
layout(location = 2) out vec4 opacitySum;
layout(location = 3) out vec4 depthSum;
layout(location = 4) out vec4 lightSum;
layout(location = 5) out float frontZ;

void writeSums(Layer layer, WeightSettings settings) {
  OitTargets targets = packSums(layerSums(layer, settings, NORMALISATION));
  radianceSum = targets.radiance;
  weightSum = targets.weight;
  opacitySum = targets.opacity;
  depthSum = targets.depth;
  lightSum = targets.light;
  frontZ = layer.z;
}
