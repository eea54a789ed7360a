// Fog marched on the CPU: into the sums of a picture, or as runs between the surfaces of fragment lists. MODEL section
// 11
#pragma once
#include "composite/deep/deep_opaque.h"
#include "composite/probe_lists.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/medium.h"
#include "gbuffer/published.h"

namespace pellucid {

// Adds the fog before each pixel's opaque surface and solid to its sums, of any tier.
//   sample  where in the pixel
//   clamps  of the published tier; may be null for the others
void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes,
            PublishedClamps* clamps = nullptr);
// The same for the row of a deep picture: each entry has the fog before its own sample and solid.
void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const HeldOutRow& row, OitPlanes& planes,
            PublishedClamps* clamps = nullptr);

// Only how the fog spreads what lies behind it, into sums that hold the layers' already.
void addFogScattering(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes);

// The same for lists: what lies between two fragments that follow one another in depth, composited front to back, is
// one more fragment. Sorted compositing of the result is the ordered march; the order of `lists` does not matter. Fog
// that diffuses does so in one of them, as all of it.
//   deep  a deep picture, of gbuffer's window, whose samples cut the fog too; null for a flat one
FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists,
                      const DeepOpaque* deep = nullptr);

// The same for lists of a window of their own, whose pixels lie in `places` of the data window.
FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists,
                      const PixelPlaces& places);

// The steps of some pixels' marches, which no weight changes: to be added to sums of one weight after another.
class MarchedFog {
 public:
  //   solid  of the pixels: rgb, planar z, row by row of the sums' window
  MarchedFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const PixelPlaces& places,
             const Image<glm::vec4>& solid);
  // What addFog() adds, to sums whose pixels lie in `places` row by row.
  void addTo(OitPlanes& planes, PublishedClamps& clamps) const;

 private:
  struct Step {
    glm::vec3 source;   // radiance scattered towards the eye, per opacity
    glm::vec3 emitted;  // radiance of its own
    float depth, z;     // optical depth; planar metres
  };
  int order_;
  std::vector<std::vector<Step>> steps_;
  std::vector<float> netOpacity_;
};

// Light and transmission of the fog alone on one pixel's ray, front to back: for tests and studies.
struct FogRay {
  glm::vec3 radiance{0.0f};
  float transmission = 1.0f, depth = 0.0f;
};
FogRay fogThrough(const Fog& fog, glm::vec3 origin, glm::vec3 direction, float zPerMetre, float z);

}  // namespace pellucid
