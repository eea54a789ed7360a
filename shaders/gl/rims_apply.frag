// Takes from the sums what the opaque pixels beside the rims hide, by targets that subtract: composite/rims.h, where the
// planes are.
layout(binding = 0) uniform sampler2D averagedRims;
layout(binding = 1) uniform sampler2D addedRims;
layout(binding = 2) uniform sampler2D rimGradients;
layout(binding = 3) uniform sampler2D opaqueZ;
layout(binding = 4) uniform sampler2D opaqueOpen;
layout(binding = 5) uniform sampler2D solid;

uniform ivec2 pictureSize;
uniform int form;

layout(location = 0) out vec4 fromRadiance;
#ifndef NO_LIGHT
layout(location = 4) out vec4 fromLight;
#endif

ivec2 occludersSize() { return pictureSize; }

vec2 occluderAt(ivec2 pixel) {
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifndef NO_SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  return vec2(z, texelFetch(opaqueOpen, pixel, 0).r);
}

#include "gl/neighbours.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 averaged = texelFetch(averagedRims, pixel, 0), added = texelFetch(addedRims, pixel, 0);
  if (!(averaged.a > 0.0f)) discard;
  precise float z = added.a / averaged.a;
  precise vec2 gradient = texelFetch(rimGradients, pixel, 0).rg / averaged.a;
  precise float hidden = 1.0f - neighboursOcclusion(gradient, z, pixel, form);
  fromRadiance = vec4(hidden * averaged.rgb, 0.0f);
#ifndef NO_LIGHT
  fromLight = vec4(hidden * added.rgb, 0.0f);
#endif
}
