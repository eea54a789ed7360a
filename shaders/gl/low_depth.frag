// What a low-resolution texel is tested against: the farthest of its pixels, opaque or solid, planar metres.
layout(binding = 0) uniform sampler2D opaqueZ;
layout(binding = 1) uniform sampler2D solid;

uniform ivec2 pictureSize;
uniform int factor;

layout(location = 0) out float farthestZ;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * factor;
  farthestZ = 0.0f;
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) {
      ivec2 pixel = min(first + ivec2(x, y), pictureSize - 1);
      float z = texelFetch(opaqueZ, pixel, 0).r;
#ifndef NO_SOLIDS
      z = min(z, texelFetch(solid, pixel, 0).a);
#endif
      farthestZ = max(farthestZ, z);
    }
}
