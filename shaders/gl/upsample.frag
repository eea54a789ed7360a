// The low-resolution texels around a pixel, as one layer of its sums: composite/low_resolution.h, where the planes are.
#include "shared/low_resolution.glsl"
#include "gl/sums_output.glsl"
#ifdef FRONT_TAIL
#include "gl/front_output.glsl"
#endif

layout(binding = 0) uniform sampler2D radianceTexels;  // of shaders/gl/low_texel.frag
layout(binding = 1) uniform sampler2D opacityTexels;
layout(binding = 2) uniform sampler2D depthTexels;
layout(binding = 3) uniform sampler2D opaqueZ;
layout(binding = 4) uniform sampler2D solid;
#ifdef SCATTER
layout(binding = 5) uniform sampler2D refractionTexels;  // the texels' sums, as shaders/gl/sums_output.glsl writes them
layout(binding = 6) uniform sampler2D lightTexels;
layout(binding = 7) uniform sampler2D nearestTexels;
layout(binding = 8) uniform sampler2D dispersionTexels;
#endif
#ifdef FRONT_TAIL
layout(binding = 5) uniform sampler2D frontZ;  // nearest layer of the whole resolution, +inf for none
#endif

uniform ivec2 texelCount;
uniform float texelsAPixel;  // 1 over the factor
#ifdef SCATTER
uniform float factor;

// Of the texels around, by their shares.
vec4 refractionAround = vec4(0.0f), dispersionAround = vec4(0.0f);
float refractionZAround = 0.0f, diffuseZAround = intBitsToFloat(0x7f800000);

void scatterTexel(ivec2 at, float share) {
  precise vec4 refraction = refractionAround + share * texelFetch(refractionTexels, at, 0);
  precise float z = refractionZAround + share * texelFetch(lightTexels, at, 0).a;
  refractionAround = refraction;
  refractionZAround = z;
#ifdef DISPERSION
  precise vec4 dispersion = dispersionAround + share * texelFetch(dispersionTexels, at, 0);
  dispersionAround = dispersion;
#endif
  if (share > 0.0f) diffuseZAround = min(diffuseZAround, texelFetch(nearestTexels, at, 0).g);
}

// Offsets and spreads of texels are in texels.
void writeScatterAround(float shares) {
  precise vec4 mean = refractionAround / shares;
  precise vec4 refraction = vec4(factor * mean.x, factor * mean.y, mean.z, factor * factor * mean.w);
  precise float z = refractionZAround / shares;
  refractionSum = refraction;
  lightSum.a = z;
  writeDiffuseZ(mean.w > 0.0f ? diffuseZAround : intBitsToFloat(0x7f800000));
#ifdef DISPERSION
  precise vec4 dispersion = (factor / shares) * dispersionAround;
  dispersionSum = dispersion;
#endif
}
#endif

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
  float before = standingBefore(texel, opaque, depths.z);
#ifdef SCATTER
  precise float part = share * before;
  scatterTexel(at, part);
#endif
  return addTexel(sums, texel, share, before);
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
  bool bends = false;
#ifdef SCATTER
  bends = refractionAround.z > 0.0f || refractionAround.w > 0.0f;
#endif
  if (!layer.shows && !bends) discard;
  OitSums added = lowLayerSums(layer, NORMALISATION);
  writeOitSums(added, sums.nearestZ);
#ifdef FRONT_TAIL
  // Before the nearest layer it lies over that; else it is one of the others.
  bool before = layer.layer.z < texelFetch(frontZ, pixel, 0).r;
  FrontTargets over = packFront(layer.layer, added.depth);
  frontRadiance = before ? over.radiance : vec4(0.0f);
#ifdef GREY
  frontDepth = before ? over.depth.r : 0.0f;
#else
  frontDepth = before ? over.depth : vec4(0.0f);
#endif
  if (before) writeNothing();
#endif
#ifdef SCATTER
  writeScatterAround(sums.share);
#endif
#ifdef HALF
  clampToHalf();
#endif
}
