// Sums one pixel's list; the result has the same bits for every order of the list. What the list holds goes through the
// text that writes the planes of the float tier, fragment by fragment; what it would blend is summed here.
#include "gl/half.glsl"
#include "shared/diffusion.glsl"
#include "shared/resolve.glsl"  // as in gl/seam.glsl
#ifdef STAGE_RIMS
#include "gl/rims_output.glsl"
#else
#include "gl/sums_output.glsl"
#endif
#ifdef FRONT_TAIL
#include "gl/front_output.glsl"
#endif
#include "gl/exact_lists.glsl"
#include "shared/exact_sums.glsl"

uniform int rowLength;
uniform vec4 weight;  // range near, far in metres; exponent; reference in metres

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
  settings.reference = weight.w;
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

vec4 asFour(vec4 x) { return x; }
vec4 asFour(vec2 x) { return vec4(x, 0.0f, 0.0f); }
vec4 asFour(float x) { return vec4(x, 0.0f, 0.0f, 0.0f); }
#define PLANE_NOW(type, plane) planes[i++] = asFour(plane);
#define SET_PLANE(type, plane) plane = type(planes[i++]);

// What the outputs hold, of the planes that add.
vec4[ADDED_PLANE_COUNT] planesNow() {
  vec4 planes[ADDED_PLANE_COUNT];
  int i = 0;
  ADDED_PLANES(PLANE_NOW)
  return planes;
}

void setPlanes(vec4 planes[ADDED_PLANE_COUNT]) {
  int i = 0;
  ADDED_PLANES(SET_PLANE)
}

// Nearest depths: of all layers, of those that diffuse. 0 where they are not kept.
vec2 nearestNow() {
  vec2 nearest = vec2(0.0f);
#ifdef NEAREST_Z
  nearest.x = NEAREST_Z;
#endif
#ifdef DIFFUSE_Z
  nearest.y = DIFFUSE_Z(PLANE_OUTPUT);
#endif
  return nearest;
}

void setNearest(vec2 nearest) {
#ifdef NEAREST_Z
  NEAREST_Z = nearest.x;
#endif
#ifdef DIFFUSE_Z
  DIFFUSE_Z(PLANE_OUTPUT) = nearest.y;
#endif
}

// Of a depth that lies beside a sum: it is none.
void clearDiffuseZ() {
#ifdef DIFFUSE_IN_ALPHA
  DIFFUSE_Z(PLANE_OUTPUT) = 0.0f;
#endif
}

void main() {
  const float kNowhere = intBitsToFloat(0x7f800000);
  vec4 planes[ADDED_PLANE_COUNT], largest[ADDED_PLANE_COUNT];
  for (int i = 0; i < ADDED_PLANE_COUNT; ++i) planes[i] = largest[i] = vec4(0.0f);
  vec2 nearest = vec2(kNowhere);
  uint links = linkOf(0u) - 1u;
  uint first = pldLinks[headHere(uint(rowLength))];
  float frontZ = kNowhere;
#ifdef FRONT_TAIL
  for (uint next = first; next != 0u; next = pldLinks[links + next])
    frontZ = min(frontZ, pldTransmissions[next - 1u].a);
#endif
  uint count = 0u;
  for (uint next = first; next != 0u; next = pldLinks[links + next]) {
    writeOne(next - 1u, frontZ);
    nearest = min(nearest, nearestNow());
    clearDiffuseZ();
    vec4 terms[ADDED_PLANE_COUNT] = planesNow();
    for (int i = 0; i < ADDED_PLANE_COUNT; ++i) largest[i] = max(largest[i], abs(terms[i]));
    ++count;
  }
  if (count > 0u) {
    ExactSums sums[ADDED_PLANE_COUNT];
    for (int i = 0; i < ADDED_PLANE_COUNT; ++i) sums[i] = exactSums(largest[i], count);
    for (uint next = first; next != 0u; next = pldLinks[links + next]) {
      writeOne(next - 1u, frontZ);
      clearDiffuseZ();
      vec4 terms[ADDED_PLANE_COUNT] = planesNow();
      for (int i = 0; i < ADDED_PLANE_COUNT; ++i) sums[i] = addedTo(sums[i], terms[i]);
    }
    for (int i = 0; i < ADDED_PLANE_COUNT; ++i) planes[i] = roundedSums(sums[i]);
  }
  setPlanes(planes);
  setNearest(nearest);
}
