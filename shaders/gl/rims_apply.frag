// Takes from the sums what the opaque pixels beside the rims hide, by targets that subtract: composite/rims.h, where
// the planes are.
RIM_SAMPLERS
layout(binding = 3) uniform sampler2D opaqueZ;
layout(binding = 4) uniform sampler2D opaqueOpen;
layout(binding = 5) uniform sampler2D solid;

uniform ivec2 pictureSize;

layout(location = 0) out vec4 fromRadiance;
#ifdef LIGHT_TARGET
layout(location = LIGHT_TARGET) out vec4 fromLight;
#endif

#include "gl/rims_here.glsl"

void main() {
  RimsHere rims = rimsAt(ivec2(gl_FragCoord.xy));
  if (!rims.any) discard;
  fromRadiance = vec4(rims.averaged, 0.0f);
#ifdef LIGHT_TARGET
  fromLight = vec4(rims.added, 0.0f);
#endif
}
