#pragma once
// Adds one layer to the planes by fixed-function blending: targets 0-4 and 6 ONE, ONE; targets 5 and 7 MIN. GREY: the
// layout of scenes without coloured transmission.
#include "shared/refraction.glsl"

layout(location = 0) out vec4 radianceSum;
#ifdef GREY
layout(location = 1) out vec4 opacitySum;
layout(location = 2) out vec2 depthSum;
#else
layout(location = 1) out vec4 weightSum;
layout(location = 2) out vec4 opacitySum;
layout(location = 3) out vec4 depthSum;
#endif
layout(location = 4) out vec4 lightSum;
layout(location = 5) out float frontZ;
#ifdef SCATTER
layout(location = 6) out vec4 refractionSum;
layout(location = 7) out float diffuseZ;
#endif

void writeSums(Layer layer, WeightSettings settings) {
  OitSums sums = layerSums(layer, settings, NORMALISATION);
#ifdef GREY
  GreyTargets targets = packGrey(sums);
  lightSum = vec4(sums.light, 0.0f);
#else
  OitTargets targets = packSums(sums);
  weightSum = targets.weight;
  lightSum = targets.light;
#endif
  radianceSum = targets.radiance;
  opacitySum = targets.opacity;
  depthSum = targets.depth;
  frontZ = layer.z;
}

#ifdef SCATTER
// After writeSums().
void writeScatter(Layer layer, Scatter scatter) {
  ScatterTargets targets = packScatter(layer, scatter);
  refractionSum = targets.refraction;
  lightSum.a = targets.refractionZ;
  diffuseZ = targets.diffuseZ;
}
#endif
