// One transparent fragment: fetch, shade through the shared model, write. Defines choose the output (OUTPUT_SUMS,
// OUTPUT_PUBLISHED, OUTPUT_RIMS, OUTPUT_COUNT, OUTPUT_LIST, OUTPUT_SOLID; of stochastic transparency OUTPUT_COVER,
// OUTPUT_CLAIM, OUTPUT_ADD), what the material has and what the frame needs.
#ifdef OUTPUT_LIST
#extension GL_ARB_gpu_shader_int64 : enable
#endif
#include "gl/frame.glsl"
#include "gl/material.glsl"
#include "gl/lights.glsl"
#include "gl/exact_cut.glsl"
#include "gl/contact_depth.glsl"
#include "gl/identity.glsl"
#include "gl/piece.glsl"
// Here, where no #if leaves them out: a text is included once.
#include "shared/diffusion.glsl"
#include "shared/resolve.glsl"
#include "shared/stochastic_mask.glsl"
#ifdef ENVIRONMENT
#include "gl/environment.glsl"
#endif
#ifdef SHADOWS
#include "gl/shadow_maps.glsl"
#elif defined(SHADOW_RAYS)
#include "gl/shadow_rays.glsl"
#endif
#include "gl/occlusion.glsl"
#if defined(POINTS) || defined(PARTICLE) || defined(SOFT)
#include "gl/particle.glsl"
#endif
#include "gl/scatter.glsl"
#ifdef PROBES
#include "shared/probe.glsl"
#endif
#if defined(OUTPUT_SUMS)
#include "gl/sums_output.glsl"
#elif defined(OUTPUT_PUBLISHED)
#include "gl/published_output.glsl"
#elif defined(OUTPUT_RIMS)
#include "gl/rims_output.glsl"
#elif defined(OUTPUT_COUNT)
layout(location = 0) out float fragmentCount;
#elif defined(OUTPUT_LIST)
#include "gl/list_output.glsl"
#elif defined(OUTPUT_COVER) || defined(OUTPUT_CLAIM) || defined(OUTPUT_ADD)
#include "gl/stochastic_frame.glsl"
#if defined(OUTPUT_COVER)
#include "gl/stochastic_cover.glsl"
#elif defined(OUTPUT_CLAIM)
#include "gl/stochastic_claim.glsl"
#else
#include "gl/stochastic_add.glsl"
#endif
#else
PLANE_OUTPUTS                   // solidRadiance: rgb, planar z
const float kClipNear = 1e-7f;  // as in gbuffer/camera.h
#endif

// What of a surface's light reaches the eye.
struct Reflected {
  vec3 light;             // all of it
  vec3 direct, indirect;  // of lamps, of the surroundings: what occlusion tells apart
  float cosEye;
};

#if !defined(UNLIT) && !defined(PARTICLE)
vec3 directHere(Surface surface, vec3 normal, vec3 toEye, float z, ivec2 pixel) {
  vec3 direct = vec3(0.0f);
#ifdef LIGHTS
#ifdef SHADOW_RAYS
  int traced = tracedPlace(pixel, identityOf(instanceIdentity, triangleNumber), z, lightCount);
#endif
  for (int i = 0; i < lightCount; ++i) {
    Arriving arriving = arrivingAt(lights[i], viewPosition);
#ifdef SHADOWS
    arriving.irradiance *= shadowVisibility(i, viewPosition);
#elif defined(SHADOW_RAYS)
    arriving.irradiance *= tracedVisibility(traced, i);
#endif
    direct += reflectTowardsEye(surface, normal, toEye, arriving.toLight) * arriving.irradiance;
  }
#endif
  return direct;
}
#endif

Reflected reflectedHere(Surface surface, float z, vec2 gradient, ivec2 pixel) {
  Reflected found;
  found.light = found.direct = found.indirect = vec3(0.0f);
  found.cosEye = 1.0f;
#ifdef UNLIT
  found.light = surface.baseColor;
#elif defined(PARTICLE)
  vec3 toEye = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
  vec3 around = vec3(0.0f);
#ifdef SURROUNDINGS
  around = surroundings.rgb;
#endif
#ifdef ENVIRONMENT
  around += environmentMean();
#endif
  found.light = scatteredByParticle(surface.baseColor, around, toEye);
#else
  vec3 toEye = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
  vec3 normal = normalHere(toEye);
  found.cosEye = clamp(dot(normal, toEye), PLD_GRAZING, 1.0f);
#ifdef SURROUNDINGS
  found.indirect = reflectSurroundings(surface, found.cosEye) * surroundings.rgb;
#endif
#ifdef ENVIRONMENT
  found.indirect += environmentReflected(surface, normal, toEye, found.cosEye);
#endif
  found.direct = directHere(surface, normal, toEye, z, pixel);
#ifdef OCCLUDED
  found.light =
      occludedLight(found.direct, found.indirect, occlusionHere(surface.coverage, gradient, z, pixel), diffusion.w);
#else
  found.light = found.direct + found.indirect;
#endif
#endif
  return found;
}

// What hides nothing behind it completely, into the outputs.
void writeHere(Layer layer, Surface surface, Reflected reflected, vec2 gradient, ivec2 pixel) {
#if defined(OUTPUT_SUMS) || defined(OUTPUT_PUBLISHED) || defined(OUTPUT_RIMS)
  WeightSettings settings;
  settings.kind = WEIGHT;
  settings.rangeNear = weightNear;
  settings.rangeFar = weightFar;
  settings.exponent = weightExponent;
  settings.reference = weightReference;
#endif
#if defined(OUTPUT_LIST) || defined(OUTPUT_PUBLISHED)
  Scattered here = scattersNothing();
#ifdef SCATTER
  here = scatterHere(layer, surface, pixel);
#endif
#endif
#if defined(OUTPUT_SUMS)
  writeSums(layer, settings);
#ifdef SCATTER
  Scattered here = scatterHere(layer, surface, pixel);
  WRITE_SCATTERED(layer, here);
#endif
#elif defined(OUTPUT_PUBLISHED)
  writePublished(layer, here.scatter, settings);
#elif defined(OUTPUT_RIMS)
#if defined(OCCLUDED) && !defined(UNLIT)
  if (!isRim(surface.coverage)) discard;
  writeRim(layer, surface.coverage * (diffusion.w * reflected.direct + reflected.indirect), gradient, settings);
#else
  discard;
#endif
#elif defined(OUTPUT_COUNT)
  fragmentCount = 1.0f;
#elif defined(OUTPUT_COVER)
  coverSamples(layer, identityHere(), pixel);
#elif defined(OUTPUT_CLAIM)
  claimSamples(layer, identityHere(), pixel);
#elif defined(OUTPUT_ADD)
  addVisible(layer, identityHere(), pixel);
#elif defined(OUTPUT_LIST)
  appendFragment(layer, here, pixel);
#endif
}

void main() {
  Surface surface = surfaceHere();
  vec2 gradient = vec2(0.0f);
#ifdef OCCLUDED
  gradient = coverageGradient(surface.coverage);
#endif
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float z = -viewPosition.z;
#ifdef PROBES
  if (!isProbe(origin + pixel, band.w)) discard;
#endif
  if (outsideTriangle()) discard;
#ifdef POINTS
  float square = dot(textureUv.xy, textureUv.xy);
  if (square >= 1.0f || !(z > 0.0f)) discard;
  Chord chord = chordOf(square, z, textureUv.z * pointScale, depthBehind(pixel));
  surface.coverage = ballCoverage(surface.coverage, chord.share);
  z = chord.z;
#elif defined(SOFT)
  surface.coverage *= cardShare(z, depthBehind(pixel), material.particle.x);
#endif
  if (!(z > 0.0f) || !(surface.coverage > 0.0f)) discard;
#ifdef POINTS
  if (z > texelFetch(opaqueZ, pixel, 0).r * depthFactor) discard;
#else
  if (isBehind(z, texelFetch(opaqueZ, pixel, 0).r)) discard;
#endif

  Reflected reflected = reflectedHere(surface, z, gradient, pixel);
  Layer layer = layerOf(surface, reflected.light, reflected.cosEye, z, material.covering.g != 0.0f);
  layer.radiance = min(layer.radiance, vec3(PLD_BRIGHTEST));
  bool hidesAll = isSolid(layer.coverage, layer.transmission);
#ifdef OUTPUT_SOLID
  if (!hidesAll) discard;
  solidRadiance = vec4(layer.radiance, z);
  gl_FragDepth = kClipNear / z;
#else
#ifdef SOLIDS
  if (hidesAll || z > texelFetch(solid, pixel, 0).a) discard;
#endif
  writeHere(layer, surface, reflected, gradient, pixel);
#endif
}
