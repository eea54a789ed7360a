// Takes from the sums what the opaque pixels beside the rims hide, by targets that subtract: composite/rims.h, where the
// planes are.
layout(binding = 0) uniform sampler2D averagedRims;
layout(binding = 1) uniform sampler2D addedRims;
layout(binding = 2) uniform sampler2D rimGradients;
layout(binding = 3) uniform sampler2D opaqueZ;
layout(binding = 4) uniform sampler2D opaqueOpen;
layout(binding = 5) uniform sampler2D solid;

uniform ivec2 pictureSize;

layout(location = 0) out vec4 fromRadiance;
#ifndef NO_LIGHT
layout(location = 4) out vec4 fromLight;
#endif

#include "gl/rims_here.glsl"

void main() {
  RimsHere rims = rimsAt(ivec2(gl_FragCoord.xy));
  if (!rims.any) discard;
  fromRadiance = vec4(rims.averaged, 0.0f);
#ifndef NO_LIGHT
  fromLight = vec4(rims.added, 0.0f);
#endif
}
