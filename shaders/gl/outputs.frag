// What temporal antialiasing, upscalers and later passes ask of the layers. PLD_VIEW_REACTIVE and _NEAREST_DEPTH of
// pellucid.h
#include "gl/resolve_here.glsl"

layout(location = 0) out vec4 picture;

uniform int view;

float nearestAt(ivec2 pixel) {
#ifdef SORTED
  return texelHere(sortedTransmission, pixel).a;
#else
  float layers = texelHere(nearestZ, pixel).r, solid = solidAt(pixel).a;
  return min(layers, solid < kNoDepth ? solid : intBitsToFloat(0x7f800000));
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  VeilHere veil = veilAt(pixel);
  float hidden = veil.kind == 0 ? 0.0f : 1.0f - meanOf(veil.resolved.transmission);
  picture = vec4(vec3(view == 19 ? nearestAt(pixel) : hidden), 1.0f);
}
