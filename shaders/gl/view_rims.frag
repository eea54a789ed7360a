// Rims as a picture, to look at. PLD_VIEW_RIM_* of pellucid.h
#include "gl/resolve_here.glsl"

RIM_SAMPLERS  // where the spread pyramid lies, which is not looked up
layout(binding = 14) uniform sampler2D opaqueOpen;

layout(location = 0) out vec4 picture;

uniform int view;

#include "gl/rims_here.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  RimsHere rims = rimsAt(pixel);
  picture = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  if (!rims.any) return;
  if (view == 10) picture.rgb = vec3(rims.hidden, 1.0f - rims.hidden, 0.0f);
  if (view == 11) {
    OitSums sums = sumsAt(pixel);
    vec3 left = resolveSums(sums, false).transparent;
    sums.numerator += rims.averaged;
#ifdef LIGHT_TARGET
    sums.light += rims.added;
#endif
    picture.rgb = max(resolveSums(sums, false).transparent - left, vec3(0.0f));
  }
}
