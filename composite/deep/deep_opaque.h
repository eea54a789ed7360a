// A deep picture as the opaque one: each of its samples holds transparent layers out on its own, so that edges between
// near and far surfaces stay clean.
#pragma once
#include <string>
#include <vector>

#include "composite/deep/channels.h"
#include "composite/gather.h"
#include "composite/veil.h"
#include "gbuffer/fragments.h"
#include "gbuffer/image.h"

namespace pellucid {

// One surface that a pixel shows, as far as nearer ones of the same pixel leave it.
struct OpaqueSample {
  float z;          // planar metres, > 0; half way through a volume
  glm::vec3 share;  // of the pixel, per channel, [0,1]
  glm::vec3 light;  // premultiplied by the share
};

struct DeepOpaque {
  Window display, data;
  std::vector<std::uint64_t> offsets;  // width * height + 1: pixel i owns samples [offsets[i], offsets[i + 1])
  std::vector<OpaqueSample> samples;   // front to back
  Image<glm::vec4> flat;               // the picture they make: premultiplied, and alpha
  Image<float> farthest;               // behind it the pixel shows nothing; +inf where something shows through
  DeepOddities oddities;
};

// Throws what resolveDeep and DeepReader throw.
DeepOpaque readDeepOpaque(const std::string& path, double metresPerUnit);

// Lists of one row of pixels: for every pixel of `lists`, one for each of its opaque samples, with the layers in front
// of that sample alone, and one with all layers for what shows beyond. A pixel without layers or solid has none.
FragmentLists holdOut(const FragmentLists& lists, const DeepOpaque& opaque);

// The veil of such a row back to pixels of `veil`: every sample's light and transmission by its share. What stands
// behind is in `applied`, except for what the lookups are still to add.
//   veil      scatters()
//   row       veil of holdOut(lists, opaque)
//   scatter   where layers look the background up elsewhere, or null
//   lookedUp  transmission of the samples that layers in front of them scatter
void addHeldOut(const FragmentLists& lists, const FragmentLists& heldOut, const Veil& row, const DeepOpaque& opaque,
                const OitPlanes* scatter, Veil& veil, Image<glm::vec3>& lookedUp);

// Adds what the layers look up.
void showThroughHeldOut(const Lookups& lookups, const Image<glm::vec3>& lookedUp, Veil& veil);

}  // namespace pellucid
