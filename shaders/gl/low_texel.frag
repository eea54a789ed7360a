// The sums of one low-resolution texel, resolved, for shaders/gl/upsample.frag.
#include "gl/resolve_here.glsl"
#include "shared/low_resolution.glsl"

layout(binding = 5) uniform sampler2D farthestZ;

layout(location = 0) out vec4 radiance;  // and the weight
layout(location = 1) out vec4 opacity;   // and the weight of depth
layout(location = 2) out vec4 depths;    // mean, nearest, of what it was tested against; 0: nothing is here

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float nothing = intBitsToFloat(0x7f800000);
  WeightSettings settings;  // of solids, of which there are none here
  settings.kind = 0;
  settings.rangeNear = 0.1f;
  settings.rangeFar = 1.0f;
  settings.exponent = 0.0f;
  settings.reference = 1.0f;
  OitSums sums = sumsAt(at);
  LowTexel texel = lowTexelOf(sums, vec4(0.0f, 0.0f, 0.0f, nothing), texelFetch(nearestZ, at, 0).r, settings);
  radiance = vec4(texel.radiance, texel.weight);
  opacity = vec4(texel.opacity, texel.depthWeight);
  depths = vec4(texel.z, texel.nearestZ, texelFetch(farthestZ, at, 0).r, sums.count);
}
