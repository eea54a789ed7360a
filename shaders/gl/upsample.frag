// The low-resolution texels around a pixel, as one layer of its sums: composite/low_resolution.h, where the planes are.
#include "shared/low_resolution.glsl"
#include "gl/sums_output.glsl"

layout(binding = 0) uniform sampler2D radianceTexels;  // of shaders/gl/low_texel.frag
layout(binding = 1) uniform sampler2D opacityTexels;
layout(binding = 2) uniform sampler2D depthTexels;
layout(binding = 3) uniform sampler2D opaqueZ;
layout(binding = 4) uniform sampler2D solid;

uniform ivec2 texelCount;
uniform float texelsAPixel;  // 1 over the factor

LowSums withTexel(LowSums sums, ivec2 at, vec4 depths, float share, float opaque) {
  if (share <= 0.0f) return sums;
  if (depths.w == 0.0f) {
    sums.share = sums.share + share;  // all that an empty texel adds
    return sums;
  }
  vec4 radiance = texelFetch(radianceTexels, at, 0), opacity = texelFetch(opacityTexels, at, 0);
  LowTexel texel;
  texel.radiance = radiance.rgb;
  texel.opacity = opacity.rgb;
  texel.weight = radiance.a;
  texel.depthWeight = opacity.a;
  texel.z = depths.x;
  texel.nearestZ = depths.y;
  return addTexel(sums, texel, share, standingBefore(texel, opaque, depths.z));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float opaque = texelFetch(opaqueZ, pixel, 0).r;
#ifndef NO_SOLIDS
  opaque = min(opaque, texelFetch(solid, pixel, 0).a);
#endif
  vec2 place = placeInTexels(vec2(pixel), vec2(0.5f), texelsAPixel);
  ivec2 centre = ivec2(floor(place + vec2(0.5f)));
  ivec2 last = texelCount - 1;
  LowSums sums = noTexels();
  // Beyond, the tent is 0.
  ivec2 first = max(ivec2(ceil(place - PLD_UPSAMPLE_TENT)), ivec2(0));
  ivec2 end = min(ivec2(floor(place + PLD_UPSAMPLE_TENT)), last);
  for (int j = first.y; j <= end.y; ++j)
    for (int i = first.x; i <= end.x; ++i) {
      vec4 depths = texelFetch(depthTexels, ivec2(i, j), 0);
      sums = withTexel(sums, ivec2(i, j), depths, upsampleShare(vec2(float(i), float(j)) - place, opaque, depths.z), opaque);
    }
  float wide = wideWeight(sums.share);
  if (wide > 0.0f)
    for (int j = max(centre.y - PLD_UPSAMPLE_REACH, 0); j <= min(centre.y + PLD_UPSAMPLE_REACH, last.y); ++j)
      for (int i = max(centre.x - PLD_UPSAMPLE_REACH, 0); i <= min(centre.x + PLD_UPSAMPLE_REACH, last.x); ++i) {
        vec4 depths = texelFetch(depthTexels, ivec2(i, j), 0);
        sums = withTexel(sums, ivec2(i, j), depths, wideShare(vec2(float(i), float(j)) - place, opaque, depths.z, wide), opaque);
      }
  LowLayer layer = lowLayerOf(sums);
  if (!layer.shows) discard;
  writeOitSums(lowLayerSums(layer, NORMALISATION), sums.nearestZ);
#ifdef SCATTER
  writeDiffuseZ(intBitsToFloat(0x7f800000));
  refractionSum = vec4(0.0f);
#endif
#ifdef DISPERSION
  dispersionSum = vec4(0.0f);
#endif
#ifdef HALF
  clampToHalf();
#endif
}
