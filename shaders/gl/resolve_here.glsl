#pragma once
// Sums to what transparency does to a pixel: fetch and resolve through the shared model. Which planes there are and how
// sums lie in them is said by the defines of shaders/plane_defines.h. NEAREST_SAMPLERS: textures are looked up at their
// nearest texels. DECODED_PUBLISHED: planes of records in the published tier, whose 8 bits are decoded: depth holds beta.
#include "gl/lookup.glsl"
#include "gl/packing.glsl"
#include "shared/picture.glsl"

// `pixel` is the one under this fragment.
vec4 texelHere(sampler2D plane, ivec2 pixel) {
#ifdef NEAREST_SAMPLERS
  // A rasteriser on a CPU takes this for less than a fetch, which asks for its level.
  return textureLod(plane, gl_FragCoord.xy / vec2(textureSize(plane, 0)), 0.0f);
#else
  return texelFetch(plane, pixel, 0);
#endif
}

#ifdef FRONT_TAIL
#include "gl/front_sums.glsl"
#endif

#ifdef NO_SELF_MODULATION
const int modulateSelf = 0;
#else
uniform int modulateSelf;
#endif
uniform ivec3 lookup;  // kernel, exact, levels of the pyramid
uniform float largestSpread;

// Of one pixel.
struct VeilHere {
  Resolved resolved;  // transmission is of the background that is seen, the pixel's own or another's
  int kind;           // 0 untouched, 1 shows its own background, 2 another
  vec4 applied;       // 2: transmission times what is seen; its mean times (1 - that alpha)
};

#if !defined(PUBLISHED) && !defined(SORTED)
#define FETCH_SUM(type, plane, field) targets.field = texelHere(plane, pixel);
#define TEXEL_HERE(plane) texelHere(plane, pixel)

OitSums sumsAt(ivec2 pixel) {
  OitTargets targets;
  targets.radiance = targets.weight = targets.opacity = targets.depth = targets.light = vec4(0.0f);
  SUM_PLANES(FETCH_SUM)
  return unpackHere(targets);
}
#endif

// What the layers of a pixel leave of what is behind them all, and whether there are any.
struct LayersHere {
  Resolved resolved;
  bool any;
};

#if defined(SORTED)
LayersHere layersAt(ivec2 pixel) {
  LayersHere layers;
  vec4 light = texelHere(sortedLight, pixel);
  layers.any = light.a != 0.0f;
  layers.resolved.transparent = light.rgb;
  layers.resolved.transmission = texelHere(sortedTransmission, pixel).rgb;
  return layers;
}
#elif defined(PUBLISHED)
LayersHere layersAt(ivec2 pixel) {
  LayersHere layers;
  PublishedSums sums = publishedAt(pixel);
  layers.any = anyPublished(sums);
  layers.resolved = resolvePublished(sums.numerator, sums.denominator, sums.beta, modulateSelf != 0);
  return layers;
}
#else
LayersHere layersAt(ivec2 pixel) {
  LayersHere layers;
  OitSums sums = sumsAt(pixel);
  layers.any = sums.count != 0.0f;
#if defined(DECODED_PUBLISHED)
  layers.resolved = resolvePublished(sums.numerator, sums.denominator.r, sums.depth, modulateSelf != 0);
#else
  layers.resolved = resolveSums(sums, modulateSelf != 0);
#endif
#ifdef FRONT_TAIL
  FrontTargets nearest = frontAt(pixel);
  layers.any = layers.any || nearest.radiance.a != 0.0f;
  layers.resolved = frontOverTail(nearest, layers.resolved);
#ifdef LOW_OVER
  FrontTargets over = overAt(pixel);
  layers.any = layers.any || over.radiance.a != 0.0f;
  layers.resolved = frontOverTail(over, layers.resolved);
#endif
#endif
  return layers;
}
#endif

#ifdef SCATTER
// What a pixel's layers show of another place than the one behind them.
vec4 appliedAt(ivec2 pixel, vec4 path, vec3 transmission) {
  LookupChoice choice;
  choice.kernel = lookup.x;
  choice.exact = lookup.y;
  choice.levels = lookup.z;
  choice.largestSpread = largestSpread;
  vec4 dispersion = vec4(0.0f);
#ifdef DISPERSION
  dispersion = dispersionOf(texelHere(dispersionSum, pixel), path.z);
#endif
#ifdef PUBLISHED
  vec2 depths = vec2(0.0f);  // no depth says what stands in front
#else
  float diffuseZ = intBitsToFloat(0x7f800000);
#ifdef DIFFUSE_Z
  diffuseZ = DIFFUSE_Z(TEXEL_HERE);
#endif
  float refractionZ = REFRACTION_Z(TEXEL_HERE);
  vec2 depths = vec2(refractionZ, diffuseZ);
#endif
  vec4 seen = lookupAt(choice, pathOf(path, depths.x, depths.y), dispersion, pixel, backdropColour(pixel));
  precise vec3 shown = transmission * throughOnly(transmission, vec3(seen));
  precise float hole = meanOf(transmission) * (1.0f - seen.a);
  return vec4(shown, hole);
}
#endif

VeilHere veilAt(ivec2 pixel) {
  VeilHere veil;
  veil.kind = 0;
  veil.resolved.transparent = vec3(0.0f);
  veil.resolved.transmission = vec3(1.0f);
  veil.applied = vec4(0.0f);
  LayersHere layers = layersAt(pixel);
  vec4 front = solidAt(pixel);
  bool hidesAll = front.a < kNoDepth;
#ifdef SCATTER
  vec4 path = pathSumsAt(pixel);
  bool scatters = path.z > 0.0f || path.w > 0.0f;
  // A solid behind such layers is part of the background that they show.
  hidesAll = hidesAll && !scatters;
#endif
  if (!layers.any && !hidesAll) return veil;
  veil.resolved = layers.resolved;
#ifndef SORTED  // where what is solid lies under the layers already
  if (hidesAll) {
    veil.resolved.transparent = overBackground(veil.resolved, vec3(front));
    veil.resolved.transmission = vec3(0.0f);
  }
#endif
  veil.kind = 1;
#ifdef SCATTER
  if (!scatters) return veil;
  veil.kind = 2;
  veil.applied = appliedAt(pixel, path, veil.resolved.transmission);
#endif
  return veil;
}
