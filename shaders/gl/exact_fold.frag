// A pixel's list to its sums, whose bits do not know in which order the list is. What the list holds goes through the text
// that writes the planes of the float tier, fragment by fragment; what it would blend is summed here.
#include "gl/half.glsl"
#include "shared/diffusion.glsl"
#include "shared/resolve.glsl"  // as in gl/seam.glsl
#if defined(STAGE_RIMS)
#include "gl/rims_output.glsl"
#elif defined(LEAN)
#include "gl/lean_output.glsl"
#else
#include "gl/sums_output.glsl"
#endif
#ifdef FRONT_TAIL
#include "gl/front_output.glsl"
#endif
#include "gl/exact_lists.glsl"
#include "shared/exact_sums.glsl"

uniform int rowLength;
uniform vec4 weight;  // range near, far in metres; exponent

// Planes that add.
#if defined(STAGE_RIMS)
const int kPlanes = 3;
#elif defined(LEAN) && defined(GREY)
const int kSums = 2;
#elif defined(LEAN)
const int kSums = 3;
#elif defined(GREY)
const int kSums = 4;
#else
const int kSums = 5;
#endif
#if defined(FRONT_TAIL) || (defined(SCATTER) && defined(DISPERSION))
const int kPlanes = kSums + 2;
#elif defined(SCATTER)
const int kPlanes = kSums + 1;
#elif !defined(STAGE_RIMS)
const int kPlanes = kSums;
#endif

// Puts this fragment's share of every plane into the outputs.
//   frontZ  nearest of the pixel's list
void writeOne(uint place, float frontZ) {
  vec4 radiance = pldRadiances[place], transmission = pldTransmissions[place];
  Layer layer;
  layer.radiance = radiance.rgb;
  layer.coverage = radiance.a;
  layer.transmission = transmission.rgb;
  layer.z = transmission.a;
  WeightSettings settings;
  settings.kind = WEIGHT;
  settings.rangeNear = weight.x;
  settings.rangeFar = weight.y;
  settings.exponent = weight.z;
#if defined(STAGE_RIMS)
  writeRim(layer, layer.radiance, pldOffsets[place].xy, settings);
#elif defined(FRONT_TAIL)
  writeFrontOrTail(layer, settings, isFront(layer.z, frontZ));
#else
  writeSums(layer, settings);
#endif
#ifdef SCATTER
  vec4 offset = pldOffsets[place];
  Scatter scatter;
  scatter.offset = offset.xy;
  scatter.variance = offset.z;
#ifdef DISPERSION
  writeScatter(layer, scatter, pldDispersions[place]);
#else
  writeScatter(layer, scatter, vec4(0.0f));
#endif
#endif
}

#ifdef DIFFUSE_IN_ALPHA
// The nearest layer that diffuses, beside a sum.
float diffuseZNow() {
#ifdef LEAN
  return depthSum.a;
#else
  return opacitySum.a;
#endif
}

void setDiffuseZ(float z) {
#ifdef LEAN
  depthSum.a = z;
#else
  opacitySum.a = z;
#endif
}
#endif

// What the outputs hold, of the planes that add.
vec4[kPlanes] planesNow() {
  vec4 planes[kPlanes];
  int i = 0;
#if defined(STAGE_RIMS)
  planes[i++] = averagedRim;
  planes[i++] = addedRim;
  planes[i++] = vec4(rimGradient, 0.0f, 0.0f);
#else
  planes[i++] = radianceSum;
#if defined(GREY) && defined(LEAN) && defined(SCATTER)
  planes[i++] = depthSum;
#elif defined(GREY)
  planes[i++] = vec4(depthSum, 0.0f, 0.0f);
#else
  planes[i++] = weightSum;
  planes[i++] = depthSum;
#endif
#ifndef LEAN
  planes[i++] = opacitySum;
  planes[i++] = lightSum;
#endif
#ifdef FRONT_TAIL
  planes[i++] = frontRadiance;
#ifdef GREY
  planes[i++] = vec4(frontDepth, 0.0f, 0.0f, 0.0f);
#else
  planes[i++] = frontDepth;
#endif
#endif
#ifdef SCATTER
  planes[i++] = refractionSum;
#ifdef DISPERSION
  planes[i++] = dispersionSum;
#endif
#endif
#endif
  return planes;
}

void setPlanes(vec4 planes[kPlanes]) {
  int i = 0;
#if defined(STAGE_RIMS)
  averagedRim = planes[i++];
  addedRim = planes[i++];
  rimGradient = planes[i++].xy;
#else
  radianceSum = planes[i++];
#if defined(GREY) && defined(LEAN) && defined(SCATTER)
  depthSum = planes[i++];
#elif defined(GREY)
  depthSum = planes[i++].xy;
#else
  weightSum = planes[i++];
  depthSum = planes[i++];
#endif
#ifndef LEAN
  opacitySum = planes[i++];
  lightSum = planes[i++];
#endif
#ifdef FRONT_TAIL
  frontRadiance = planes[i++];
#ifdef GREY
  frontDepth = planes[i++].x;
#else
  frontDepth = planes[i++];
#endif
#endif
#ifdef SCATTER
  refractionSum = planes[i++];
#ifdef DISPERSION
  dispersionSum = planes[i++];
#endif
#endif
#endif
}

// Planes that keep the nearest: of all layers, of those that diffuse.
vec2 nearestNow() {
#if defined(DIFFUSE_IN_ALPHA)
  return vec2(diffuseZNow());
#elif defined(STAGE_RIMS) || defined(LEAN) || defined(NO_DIFFUSE)
  return vec2(0.0f);
#elif defined(SCATTER)
  return nearestZ;
#else
  return vec2(nearestZ);
#endif
}

void setNearest(vec2 nearest) {
#if defined(DIFFUSE_IN_ALPHA)
  setDiffuseZ(nearest.y);
#elif defined(STAGE_RIMS) || defined(LEAN) || defined(NO_DIFFUSE)
#elif defined(SCATTER)
  nearestZ = nearest;
#else
  nearestZ = nearest.x;
#endif
}

void main() {
  const float kNowhere = intBitsToFloat(0x7f800000);
  vec4 planes[kPlanes], largest[kPlanes];
  for (int i = 0; i < kPlanes; ++i) planes[i] = largest[i] = vec4(0.0f);
  vec2 nearest = vec2(kNowhere);
  uint links = linkOf(0u) - 1u;
  uint first = pldLinks[headHere(uint(rowLength))];
  float frontZ = kNowhere;
#ifdef FRONT_TAIL
  for (uint next = first; next != 0u; next = pldLinks[links + next]) frontZ = min(frontZ, pldTransmissions[next - 1u].a);
#endif
  uint count = 0u;
  for (uint next = first; next != 0u; next = pldLinks[links + next]) {
    writeOne(next - 1u, frontZ);
    nearest = min(nearest, nearestNow());
#ifdef DIFFUSE_IN_ALPHA
    setDiffuseZ(0.0f);  // no sum
#endif
    vec4 terms[kPlanes] = planesNow();
    for (int i = 0; i < kPlanes; ++i) largest[i] = max(largest[i], abs(terms[i]));
    ++count;
  }
  if (count > 0u) {
    ExactSums sums[kPlanes];
    for (int i = 0; i < kPlanes; ++i) sums[i] = exactSums(largest[i], count);
    for (uint next = first; next != 0u; next = pldLinks[links + next]) {
      writeOne(next - 1u, frontZ);
#ifdef DIFFUSE_IN_ALPHA
      setDiffuseZ(0.0f);
#endif
      vec4 terms[kPlanes] = planesNow();
      for (int i = 0; i < kPlanes; ++i) sums[i] = addedTo(sums[i], terms[i]);
    }
    for (int i = 0; i < kPlanes; ++i) planes[i] = roundedSums(sums[i]);
  }
  setPlanes(planes);
  setNearest(nearest);
}
