#pragma once
// Adds one layer to the planes of shared/lean.glsl. GREY: one opacity for all channels. DIFFUSE_IN_ALPHA: the nearest layer
// that diffuses is the alpha of the depth, MIN.
#include "shared/lean.glsl"
#include "shared/refraction.glsl"
#include "gl/half.glsl"

layout(location = 0) out vec4 radianceSum;
#if defined(GREY) && defined(SCATTER)
layout(location = 1) out vec4 depthSum;
#elif defined(GREY)
layout(location = 1) out vec2 depthSum;
#else
layout(location = 1) out vec4 weightSum;
layout(location = 2) out vec4 depthSum;
#endif
#ifdef SCATTER
layout(location = 6) out vec4 refractionSum;
#ifdef DISPERSION
layout(location = 7) out vec4 dispersionSum;
#endif
#endif

void writeTargets(LeanTargets targets) {
  radianceSum = targets.radiance;
#if defined(GREY) && !defined(SCATTER)
  depthSum = vec2(targets.depth);
#elif defined(GREY)
  depthSum = targets.depth;
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

#ifdef SCATTER
// After writeSums().
//   dispersion  see packDispersion()
void writeScatter(Layer layer, Scatter scatter, vec4 dispersion) {
  ScatterTargets targets = packScatter(layer, scatter);
  refractionSum = targets.refraction;
#ifdef GREY
  depthSum.z = targets.refractionZ;
#else
  weightSum.a = targets.refractionZ;
#endif
#if defined(DIFFUSE_IN_ALPHA) && defined(HALF)
  depthSum.a = towardsEye(targets.diffuseZ);
#elif defined(DIFFUSE_IN_ALPHA)
  depthSum.a = targets.diffuseZ;
#endif
#ifdef DISPERSION
  dispersionSum = packDispersion(layer, scatter, dispersion);
#endif
}
#endif

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
#ifdef SCATTER
  refractionSum = clamp(refractionSum, vec4(-65504.0f), vec4(65504.0f));
#ifdef GREY
  depthSum.z = min(depthSum.z, 65504.0f);
#endif
#endif
}
#endif
