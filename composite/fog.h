// Fog marched on the CPU: into the sums of a picture, or as runs between the surfaces of fragment lists. MODEL section
// 11
#pragma once
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/medium.h"

namespace pellucid {

// Adds the fog before each pixel's opaque surface and solid to its sums.
//   sample  where in the pixel
void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes);

// The same for lists: what lies between two fragments that follow one another in depth, composited front to back, is
// one more fragment. Sorted compositing of the result is the ordered march; the order of `lists` does not matter.
FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists);

// Light and transmission of the fog alone on one pixel's ray, front to back: for tests and studies.
struct FogRay {
  glm::vec3 radiance{0.0f};
  float transmission = 1.0f, depth = 0.0f;
};
FogRay fogThrough(const Fog& fog, glm::vec3 origin, glm::vec3 direction, float zPerMetre, float z);

}  // namespace pellucid
