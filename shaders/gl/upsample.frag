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
#ifdef FRONT_TAIL
layout(binding = 5) uniform sampler2D frontZ;  // nearest layer of the whole resolution, +inf for none
#endif
#ifdef SCATTER
TEXEL_SAMPLERS  // the texels' sums, as shaders/gl/sums_output.glsl writes them
#endif

uniform ivec2 texelCount;
uniform float texelsAPixel;  // 1 over the factor
#ifdef SCATTER
uniform float factor;

// Of the texels around, by their shares. Macros are one line each: below GLSL 4.20 none may go on.
#define AROUND(plane, texels, around, scale) vec4 around = vec4(0.0f);
SCATTER_PLANES(AROUND)
float refractionZAround = 0.0f, diffuseZAround = 3.4e38f;  // then +inf: a global of ES takes constants alone

vec4 withShare(vec4 around, float share, vec4 texel) {
  precise vec4 sum = around + share * texel;
  return sum;
}
#define ADD_TEXEL(plane, texels, around, scale) around = withShare(around, share, texelFetch(texels, at, 0));
void scatterTexel(ivec2 at, float share) {
  SCATTER_PLANES(ADD_TEXEL)
  precise float z = refractionZAround + share * texelFetch(lightSumTexels, at, 0).a;
  refractionZAround = z;
  if (share > 0.0f) diffuseZAround = min(diffuseZAround, texelFetch(nearestZTexels, at, 0).g);
}

// Offsets and spreads of texels are in texels.
#define WRITE_AROUND(plane, texels, around, scale) { precise vec4 sum = scale * (around / shares); plane = sum; }
void writeScatterAround(float shares) {
  SCATTER_PLANES(WRITE_AROUND)
  precise float z = refractionZAround / shares;
  REFRACTION_Z(PLANE_OUTPUT) = z;
  writeDiffuseZ(refractionSum.w > 0.0f ? diffuseZAround : intBitsToFloat(0x7f800000));
}
#endif

// 0 outside of the picture.
float opaqueAt(ivec2 pixel) {
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, textureSize(opaqueZ, 0)))) return 0.0f;
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifndef NO_SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  return z;
}

vec4 opaqueAlong(ivec2 pixel, ivec2 axis) {
  return vec4(opaqueAt(pixel - 2 * axis), opaqueAt(pixel - axis), opaqueAt(pixel + axis), opaqueAt(pixel + 2 * axis));
}

SurfaceNear around;  // of the pixel

// A thin layer is compared with the pixel's surface at the texel.
//   offset  from the pixel's sample to the texel's, texels
float beforePixel(LowTexel texel, vec2 offset, float opaque, float tested) {
  if (!(opaque < 3e38f) || !isThinTexel(texel)) return standingBefore(texel, opaque, tested, PLD_UPSAMPLE_CONTACT);
  float pixelsATexel = 1.0f / texelsAPixel;
  precise vec2 pixels = offset * pixelsATexel;
  return standingBefore(texel, surfaceAt(around, opaque, pixels), tested, surfaceContact(around, pixelsATexel, pixels));
}

LowSums withTexel(LowSums sums, ivec2 at, vec2 offset, vec4 depths, float share, float opaque) {
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
  float before = beforePixel(texel, offset, opaque, depths.z);
#ifdef SCATTER
  precise float part = share * before;
  scatterTexel(at, part);
#endif
  return addTexel(sums, texel, share, before);
}

void main() {
#ifdef SCATTER
  diffuseZAround = intBitsToFloat(0x7f800000);
#endif
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float opaque = opaqueAt(pixel);
  around = surfaceNear(opaque, opaqueAlong(pixel, ivec2(1, 0)), opaqueAlong(pixel, ivec2(0, 1)));
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
      vec2 offset = vec2(float(i), float(j)) - place;
      sums = withTexel(sums, ivec2(i, j), offset, depths, upsampleShare(offset, opaque, depths.z), opaque);
    }
  float wide = wideWeight(sums.share);
  if (wide > 0.0f)
    for (int j = max(centre.y - PLD_UPSAMPLE_REACH, 0); j <= min(centre.y + PLD_UPSAMPLE_REACH, last.y); ++j)
      for (int i = max(centre.x - PLD_UPSAMPLE_REACH, 0); i <= min(centre.x + PLD_UPSAMPLE_REACH, last.x); ++i) {
        vec4 depths = texelFetch(depthTexels, ivec2(i, j), 0);
        vec2 offset = vec2(float(i), float(j)) - place;
        sums = withTexel(sums, ivec2(i, j), offset, depths, wideShare(offset, opaque, depths.z, wide), opaque);
      }
  LowLayer layer = lowLayerOf(sums);
  bool bends = false;
#ifdef SCATTER
  bends = refractionSumAround.z > 0.0f || refractionSumAround.w > 0.0f;
#endif
  if (!layer.shows && !bends) discard;
  OitSums added = lowLayerSums(layer, NORMALISATION);
  writeOitSums(added, sums.nearestZ);
#ifdef FRONT_TAIL
  // Before the nearest layer it lies over that; else it is one of the others.
  bool before = layer.layer.z < texelFetch(frontZ, pixel, 0).r;
  writeFront(packFront(layer.layer, added.depth), before);
  if (before) writeNothing();
#endif
#ifdef SCATTER
  writeScatterAround(sums.share);
#endif
#ifdef HALF
  clampToHalf();
#endif
}
