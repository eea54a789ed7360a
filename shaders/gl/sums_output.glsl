#pragma once
// Adds one layer to the planes by fixed-function blending: all targets ONE, ONE but target 5, MIN. GREY: the layout of
// scenes without coloured transmission. Where depths serve no low resolution there is no target 5: DIFFUSE_IN_ALPHA, the
// nearest layer that diffuses is the alpha of the opacities, MIN, in place of what nobody reads then; NO_DIFFUSE, no layer
// does.
#include "shared/refraction.glsl"
#include "gl/half.glsl"

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
#ifdef SCATTER
#if !defined(DIFFUSE_IN_ALPHA) && !defined(NO_DIFFUSE)
layout(location = 5) out vec2 nearestZ;  // of all layers, of those that diffuse
#endif
layout(location = 6) out vec4 refractionSum;
#else
layout(location = 5) out float nearestZ;
#endif
#ifdef DISPERSION
layout(location = 7) out vec4 dispersionSum;
#endif

//   z  nearest of what the sums hold
void writeOitSums(OitSums sums, float z) {
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
#if defined(GREY) && defined(DIFFUSE_IN_ALPHA)
  opacitySum.z = targets.opacity.a;  // the count
#endif
  depthSum = targets.depth;
#ifndef SCATTER
  nearestZ = z;
#elif !defined(DIFFUSE_IN_ALPHA) && !defined(NO_DIFFUSE)
  nearestZ.x = z;
#endif
}

void writeSums(Layer layer, WeightSettings settings) {
  writeOitSums(layerSums(layer, settings, NORMALISATION), layer.z);
}

#ifdef SCATTER
// After writeOitSums().
//   z  of a layer that diffuses, else +inf
void writeDiffuseZ(float z) {
#if defined(DIFFUSE_IN_ALPHA) && defined(HALF)
  opacitySum.a = towardsEye(z);
#elif defined(DIFFUSE_IN_ALPHA)
  opacitySum.a = z;
#elif !defined(NO_DIFFUSE)
  nearestZ.y = z;
#endif
}

// After writeSums().
//   dispersion  see packDispersion()
void writeScatter(Layer layer, Scatter scatter, vec4 dispersion) {
  ScatterTargets targets = packScatter(layer, scatter);
  refractionSum = targets.refraction;
  lightSum.a = targets.refractionZ;
  writeDiffuseZ(targets.diffuseZ);
#ifdef DISPERSION
  dispersionSum = packDispersion(layer, scatter, dispersion);
#endif
}
#endif

#if defined(FRONT_TAIL)
// A fragment that goes elsewhere.
void writeNothing() {
  radianceSum = vec4(0.0f);
  opacitySum = vec4(0.0f);
  lightSum = vec4(0.0f);
#ifdef GREY
  depthSum = vec2(0.0f);
#else
  weightSum = vec4(0.0f);
  depthSum = vec4(0.0f);
#endif
  nearestZ = intBitsToFloat(0x7f800000);
}
#endif

#ifdef HALF
// To the largest half: infinity would make a NaN of a mean.
void clampToHalf() {
  const float largest = 65504.0f;
  radianceSum = min(radianceSum, vec4(largest));
#ifdef DIFFUSE_IN_ALPHA
  opacitySum.rgb = min(opacitySum.rgb, vec3(largest));
#else
  opacitySum = min(opacitySum, vec4(largest));
#endif
  lightSum = min(lightSum, vec4(largest));
#ifndef GREY
  weightSum = min(weightSum, vec4(largest));
#endif
#ifdef SCATTER
  refractionSum = clamp(refractionSum, vec4(-largest), vec4(largest));
#endif
}
#endif
