// PLD_VIEW_MEAN_DEPTH of pellucid.h, of sums: each layer by its share; a solid has the share 1.
#include "gl/resolve_here.glsl"

layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  OitSums sums = sumsAt(pixel);
  float nowhere = intBitsToFloat(0x7f800000), nearest = texelHere(nearestZ, pixel).r;
  precise float share = meanOf(sums.opacity), z = sums.opacityZ;
#ifdef FRONT_TAIL
  // The sums are those of the others.
  vec3 depth = frontAt(pixel).depth.rgb;
  float front = meanOf(netOpacityOf(depth, transmittanceOf(depth)));
  share = share + front;
  if (front > 0.0f) z = z + front * nearest;
#endif
  float solidZ = solidAt(pixel).a;
  if (solidZ < kNoDepth) {
    share = share + 1.0f;
    z = z + solidZ;
  }
  picture = vec4(vec3(share > 0.0f ? z / share : nearest), 1.0f);
}
