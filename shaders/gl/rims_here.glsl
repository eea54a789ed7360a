#pragma once
// The rims of one pixel, and what the opaque pixels beside them hide. Whoever includes this declares the samplers
// averagedRim, addedRim, rimGradient (RIM_SAMPLERS), opaqueZ, opaqueOpen, without NO_SOLIDS solid, and pictureSize.
uniform int form;

ivec2 occludersSize() { return pictureSize; }

vec2 occluderAt(ivec2 pixel) {
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifndef NO_SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  return vec2(z, texelFetch(opaqueOpen, pixel, 0).r);
}

#include "gl/neighbours.glsl"

struct RimsHere {
  bool any;
  float hidden;          // of the light from around, [0,1]
  vec3 averaged, added;  // what the sums lose: of weighted colour, of light that adds
};

RimsHere rimsAt(ivec2 pixel) {
  vec4 averaged = texelFetch(averagedRim, pixel, 0), added = texelFetch(addedRim, pixel, 0);
  RimsHere rims;
  rims.any = averaged.a > 0.0f;
  rims.hidden = 0.0f;
  rims.averaged = vec3(0.0f);
  rims.added = vec3(0.0f);
  if (!rims.any) return rims;
  precise float z = added.a / averaged.a;
  precise vec2 gradient = texelFetch(rimGradient, pixel, 0).rg / averaged.a;
  precise float hidden = 1.0f - neighboursOcclusion(gradient, z, pixel, form);
  rims.hidden = hidden;
  rims.averaged = hidden * averaged.rgb;
  rims.added = hidden * added.rgb;
  return rims;
}
