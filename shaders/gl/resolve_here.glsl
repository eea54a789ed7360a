#pragma once
// Sums to what transparency does to a pixel: fetch and resolve through the shared model. Defines say how the sums lie:
// GREY, LEAN, PUBLISHED, FRONT_TAIL, else one plane per sum; and which planes there are: NO_LIGHT, SCATTER, DISPERSION.
// DECODED_PUBLISHED: planes of records in the published tier, whose 8 bits are decoded: depth holds beta.
// NEAREST_SAMPLERS: textures are looked up at their nearest texels. LOW_OVER: of gl/front_sums.glsl; DIFFUSE_IN_ALPHA, NO_DIFFUSE: of
// gl/sums_output.glsl.
#include "gl/lookup.glsl"
#include "shared/lean.glsl"
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

#ifndef PUBLISHED
layout(binding = 1) uniform sampler2D radianceSum;
layout(binding = 2) uniform sampler2D weightSum;
layout(binding = 3) uniform sampler2D opacitySum;
layout(binding = 4) uniform sampler2D depthSum;
layout(binding = 7) uniform sampler2D lightSum;
layout(binding = 9) uniform sampler2D nearestZ;  // g: of the layers that diffuse
layout(binding = 10) uniform sampler2D dispersionSum;
#endif
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

#ifdef LEAN
OitSums sumsAt(ivec2 pixel) {
  LeanTargets targets;
  targets.radiance = texelHere(radianceSum, pixel);
  targets.depth = texelHere(depthSum, pixel);
#ifdef GREY
  targets.weight = vec4(0.0f);
  return unpackLean(targets, true);
#else
  targets.weight = texelHere(weightSum, pixel);
  return unpackLean(targets, false);
#endif
}
#elif !defined(PUBLISHED)
OitTargets targetsAt(ivec2 pixel) {
#ifdef NO_LIGHT
  vec4 light = vec4(0.0f);
#else
  vec4 light = texelHere(lightSum, pixel);
#endif
#ifdef GREY
  GreyTargets grey;
  grey.radiance = texelHere(radianceSum, pixel);
  grey.opacity = texelHere(opacitySum, pixel);
#ifdef DIFFUSE_IN_ALPHA
  grey.opacity.a = grey.opacity.z;  // the count
  grey.opacity.z = 0.0f;
#endif
  vec4 depth = texelHere(depthSum, pixel);
  grey.depth = vec2(depth.x, depth.y);
  return unpackGrey(grey, light);
#else
  OitTargets targets;
  targets.radiance = texelHere(radianceSum, pixel);
  targets.weight = texelHere(weightSum, pixel);
  targets.opacity = texelHere(opacitySum, pixel);
  targets.depth = texelHere(depthSum, pixel);
  targets.light = light;
  return targets;
#endif
}

OitSums sumsAt(ivec2 pixel) { return unpackSums(targetsAt(pixel)); }
#endif

VeilHere veilAt(ivec2 pixel) {
  VeilHere veil;
  veil.kind = 0;
  veil.resolved.transparent = vec3(0.0f);
  veil.resolved.transmission = vec3(1.0f);
  veil.applied = vec4(0.0f);
#ifdef PUBLISHED
  PublishedSums sums = publishedAt(pixel);
  bool any = anyPublished(sums);
#else
  OitSums sums = sumsAt(pixel);
  bool any = sums.count != 0.0f;
#ifdef FRONT_TAIL
  FrontTargets nearest = frontAt(pixel);
  any = any || nearest.radiance.a != 0.0f;
#ifdef LOW_OVER
  FrontTargets over = overAt(pixel);
  any = any || over.radiance.a != 0.0f;
#endif
#endif
#endif
  vec4 front = solidAt(pixel);
  bool hidesAll = front.a < kNoDepth;
#ifdef SCATTER
  vec4 path = pathSumsAt(pixel);
  bool scatters = path.z > 0.0f || path.w > 0.0f;
  // A solid behind such layers is part of the background that they show.
  hidesAll = hidesAll && !scatters;
#endif
  if (!any && !hidesAll) return veil;
#ifdef PUBLISHED
  veil.resolved = resolvePublished(sums.numerator, sums.denominator, sums.beta, modulateSelf != 0);
#elif defined(DECODED_PUBLISHED)
  veil.resolved = resolvePublished(sums.numerator, sums.denominator.r, sums.depth, modulateSelf != 0);
#else
  veil.resolved = resolveSums(sums, modulateSelf != 0);
#endif
#ifdef FRONT_TAIL
  veil.resolved = frontOverTail(nearest, veil.resolved);
#ifdef LOW_OVER
  veil.resolved = frontOverTail(over, veil.resolved);
#endif
#endif
  if (hidesAll) {
    veil.resolved.transparent = overBackground(veil.resolved, vec3(front));
    veil.resolved.transmission = vec3(0.0f);
  }
  veil.kind = 1;
#ifdef SCATTER
  if (!scatters) return veil;
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
#if defined(DIFFUSE_IN_ALPHA) && defined(LEAN)
  float diffuseZ = texelHere(depthSum, pixel).a;
#elif defined(DIFFUSE_IN_ALPHA)
  float diffuseZ = texelHere(opacitySum, pixel).a;
#elif defined(NO_DIFFUSE)
  float diffuseZ = intBitsToFloat(0x7f800000);
#else
  float diffuseZ = texelHere(nearestZ, pixel).g;
#endif
#if defined(LEAN) && defined(GREY)
  float refractionZ = texelHere(depthSum, pixel).z;
#elif defined(LEAN)
  float refractionZ = texelHere(weightSum, pixel).a;
#else
  float refractionZ = texelHere(lightSum, pixel).a;
#endif
  vec2 depths = vec2(refractionZ, diffuseZ);
#endif
  vec4 seen = lookupAt(choice, pathOf(path, depths.x, depths.y), dispersion, pixel);
  precise vec3 shown = veil.resolved.transmission * throughOnly(veil.resolved.transmission, vec3(seen));
  precise float hole = meanOf(veil.resolved.transmission) * (1.0f - seen.a);
  veil.kind = 2;
  veil.applied = vec4(shown, hole);
#endif
  return veil;
}
