#pragma once
// Ambient occlusion of the cut-out surface under this fragment: of a solid its own, of a rim that of its neighbours.
#include "gl/frame.glsl"
#include "shared/occlusion.glsl"
#ifdef OCCLUDED

layout(binding = 7) uniform sampler2D occluders;  // r planar z, g occlusion: opaque pixels and solids, at pixel centres

// To be called before any discard.
vec2 coverageGradient(float coverage) {
  return vec2(dFdxFine(coverage), dFdyFine(coverage));
}

ivec2 occludersSize() { return textureSize(occluders, 0); }
vec2 occluderAt(ivec2 pixel) { return texelFetch(occluders, pixel, 0).rg; }
#include "gl/neighbours.glsl"

float occlusionHere(float coverage, vec2 gradient, float z, ivec2 pixel) {
  if (isRim(coverage)) {
#ifdef RIM_FORM
    return neighboursOcclusion(gradient, z, pixel, RIM_FORM);
#else
    return 1.0f;
#endif
  }
  vec2 own = texelFetch(occluders, pixel, 0).rg;
  // Away from the pixel's centre another leaf may lie there.
  return isAtDepth(own.r, z) ? own.g : neighboursOcclusion(vec2(0.0f), z, pixel, PLD_OCCLUSION_RELATIVE);
}
#endif
