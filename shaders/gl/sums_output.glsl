#pragma once
// Adds one layer to the planes by fixed-function blending. Which planes there are, where they lie and how they blend:
// shaders/plane_layout.h, by the defines of shaders/plane_defines.h.
#include "gl/packing.glsl"
#include "shared/refraction.glsl"
#include "gl/half.glsl"

PLANE_OUTPUTS

#define WRITE_SUM(type, plane, field) plane = type(targets.field);
#define WRITE_NO_SUM(type, plane, field) plane = type(0.0f);
#define WRITE_NO_SCATTER(plane, texels, around, scale) plane = vec4(0.0f);
#define CLAMP_TO_HALF(place, type) place = clamp(place, type(-65504.0f), type(65504.0f));

//   z  nearest of what the sums hold
void writeOitSums(OitSums sums, float z) {
  OitTargets targets = packHere(sums);
  SUM_PLANES(WRITE_SUM)
#ifdef NEAREST_Z
  NEAREST_Z = z;
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
  DIFFUSE_Z(PLANE_OUTPUT) = towardsEye(z);
#elif defined(DIFFUSE_Z)
  DIFFUSE_Z(PLANE_OUTPUT) = z;
#endif
}

// After writeSums().
//   dispersion  see packDispersion()
void writeScatter(Layer layer, Scatter scatter, vec4 dispersion) {
  ScatterTargets targets = packScatter(layer, scatter);
  refractionSum = targets.refraction;
  REFRACTION_Z(PLANE_OUTPUT) = targets.refractionZ;
  writeDiffuseZ(targets.diffuseZ);
#ifdef DISPERSION
  dispersionSum = packDispersion(layer, scatter, dispersion);
#endif
}

// Of what does not scatter, where other layers do.
void writeNoScatter() {
  SCATTER_PLANES(WRITE_NO_SCATTER)
  writeDiffuseZ(intBitsToFloat(0x7f800000));
}
#endif

#ifdef FRONT_TAIL
// A fragment that goes elsewhere.
void writeNothing() {
  SUM_PLANES(WRITE_NO_SUM)
#ifdef NEAREST_Z
  NEAREST_Z = intBitsToFloat(0x7f800000);
#endif
}
#endif

#ifdef HALF
// To the largest half: infinity would make a NaN of a mean.
void clampToHalf() {
  HALF_PLANES(CLAMP_TO_HALF)
}
#endif
