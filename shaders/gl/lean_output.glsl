#pragma once
// Adds one layer to the planes of shared/lean.glsl. GREY: one opacity for all channels.
#include "shared/lean.glsl"

layout(location = 0) out vec4 radianceSum;
#ifdef GREY
layout(location = 1) out vec2 depthSum;
#else
layout(location = 1) out vec4 weightSum;
layout(location = 2) out vec4 depthSum;
#endif

void writeTargets(LeanTargets targets) {
  radianceSum = targets.radiance;
#ifdef GREY
  depthSum = vec2(targets.depth.x, targets.depth.y);
#else
  weightSum = targets.weight;
  depthSum = targets.depth;
#endif
}

//   z  nearest of what the sums hold, which these planes do not keep
void writeOitSums(OitSums sums, float z) {
#ifdef GREY
  writeTargets(packLean(sums, true));
#else
  writeTargets(packLean(sums, false));
#endif
}

void writeSums(Layer layer, WeightSettings settings) {
  writeOitSums(layerSums(layer, settings, NORMALISATION), layer.z);
}

// A fragment that goes elsewhere.
void writeNothing() {
  LeanTargets none;
  none.radiance = vec4(0.0f);
  none.weight = vec4(0.0f);
  none.depth = vec4(0.0f);
  writeTargets(none);
}

#ifdef HALF
// To the largest half: infinity would make a NaN of a mean.
void clampToHalf() {
  radianceSum = min(radianceSum, vec4(65504.0f));
#ifndef GREY
  weightSum = min(weightSum, vec4(65504.0f));
#endif
}
#endif
