// What later passes ask of a pixel's layers, of their list: it has the same bits for every order of the list. MARKS:
// motion and identity; DEPTHS: where opacity is reached, and the mean.
#include "gl/exact_lists.glsl"
#include "gl/mark_share.glsl"
#include "shared/exact_sums.glsl"
#ifdef MARKS
#include "gl/listed_marks.glsl"
layout(location = 0) out vec4 layerMarks;  // sums of share * motion, of shares; identity of the nearest, +inf for none
#endif
#ifdef DEPTHS
#include "gl/exact_order.glsl"
layout(location = 1) out vec2 layerDepths;  // where opacity is reached; mean. Planar metres, +inf for none
#endif

uniform int rowLength;
#ifdef DEPTHS
uniform float depthOpacity;
#ifdef SOLIDS
layout(binding = 6) uniform sampler2D solidHere;  // rgb, planar z
#endif
#endif

uint firstHere() { return pldLinks[headHere(uint(rowLength))]; }
uint nextOf(uint link) { return pldLinks[linkOf(link - 1u)]; }

// What a fragment adds: its share times motion and depth.
vec4 termsOf(uint link) {
  float share = markShare(pldRadiances[link - 1u].a, pldTransmissions[link - 1u].rgb);
  vec2 motion = vec2(0.0f);
#ifdef MARKS
  motion = pldMarks[link - 1u].xy;
#endif
  precise vec4 terms = share * vec4(motion, 1.0f, pldTransmissions[link - 1u].a);
  return terms;
}

vec4 sumsHere() {
  vec4 largest = vec4(0.0f);
  uint count = 0u;
  for (uint link = firstHere(); link != 0u; link = nextOf(link)) {
    largest = max(largest, abs(termsOf(link)));
    ++count;
  }
  if (count == 0u) return vec4(0.0f);
  ExactSums sums = exactSums(largest, count);
  for (uint link = firstHere(); link != 0u; link = nextOf(link)) sums = addedTo(sums, termsOf(link));
  return roundedSums(sums);
}

float nearestHere() {
  float nearest = intBitsToFloat(0x7f800000);
  for (uint link = firstHere(); link != 0u; link = nextOf(link)) nearest = min(nearest, pldTransmissions[link - 1u].a);
  return nearest;
}

#ifdef MARKS
// Of several at one depth the smallest.
float identityAt(float nearest) {
  float identity = intBitsToFloat(0x7f800000);
  for (uint link = firstHere(); link != 0u; link = nextOf(link))
    if (pldTransmissions[link - 1u].a == nearest) identity = min(identity, pldMarks[link - 1u].w);
  return identity;
}
#endif

#ifdef DEPTHS
// Turned around in place: from near to far.
uint reversedList(uint list) {
  uint reversed = 0u;
  while (list != 0u) {
    uint next = after(list);
    setAfter(list, reversed);
    reversed = list;
    list = next;
  }
  return reversed;
}

// Depth of the first layer from the eye with which all so far hide the stated part of what is behind; layers in one
// plane count together.
float depthReached() {
  precise dvec3 passed = dvec3(1.0lf);
  uint next = reversedList(sortedList(firstHere()));
  pldLinks[headHere(uint(rowLength))] = next;
  while (next != 0u) {
    float z = depthOf(next);
    for (; next != 0u && depthOf(next) == z; next = after(next))
      for (int c = 0; c < 3; ++c) {
        precise double hidden =
            double(pldRadiances[next - 1u].a) * (1.0lf - double(pldTransmissions[next - 1u][c]));
        passed[c] = passed[c] * (1.0lf - hidden);
      }
    precise double opacity = 1.0lf - (passed.r + passed.g + passed.b) / 3.0lf;
    if (opacity >= double(depthOpacity)) return z;
  }
  return intBitsToFloat(0x7f800000);
}

vec2 depthsOf(vec4 sums) {
  float nowhere = intBitsToFloat(0x7f800000), solidZ = nowhere;
#ifdef SOLIDS
  solidZ = texelFetch(solidHere, ivec2(gl_FragCoord.xy), 0).a;
#endif
  precise float share = sums.z, z = sums.w;
  if (solidZ < nowhere) {
    share = share + 1.0f;
    z = z + solidZ;
  }
  // What only adds light has no share.
  float mean = share > 0.0f ? z / share : nearestHere();
  return vec2(min(depthReached(), solidZ), mean);
}
#endif

void main() {
  vec4 sums = sumsHere();
#ifdef MARKS
  layerMarks = vec4(sums.xyz, identityAt(nearestHere()));
#endif
#ifdef DEPTHS
  layerDepths = depthsOf(sums);
#endif
}
