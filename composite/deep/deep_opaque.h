// A deep picture as the opaque one: each of its samples holds transparent layers out on its own, so that edges between
// near and far surfaces stay clean.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "composite/deep/sample_channels.h"
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
  float reach = 0;  // half of a volume's length: it lies from z - reach to z + reach; 0 for a surface
};

// Depths of samples as the file has them.
struct StoredDepths {
  std::size_t negative = 0, positive = 0;  // samples
  double least = 0, most = 0;              // of finite ones; both 0 where there are none

  void add(double depth) {
    const bool any = negative + positive > 0;
    if (!std::isfinite(depth) || depth == 0.0) return;
    ++(depth < 0.0 ? negative : positive);
    least = any ? std::min(least, depth) : depth;
    most = any ? std::max(most, depth) : depth;
  }
};

struct DeepOpaque {
  Window display, data;
  std::vector<std::uint64_t> offsets;  // width * height + 1: pixel i owns samples [offsets[i], offsets[i + 1])
  std::vector<OpaqueSample> samples;   // front to back
  Image<glm::vec4> flat;               // the picture they make: premultiplied, and alpha
  // Of depth, relative: a layer at z <= that of a sample * (1 + depthPrecision) is in front of it.
  float depthPrecision = 0x1p-20f;
  Image<float> farthest;  // behind it the pixel shows nothing; +inf where something shows through
  StoredDepths stored;
  DeepOddities oddities;
};

// Throws what DeepReader throws.
//   channels  of the file
//   depth     from the file's numbers
DeepOpaque readDeepOpaque(const std::string& path, const DeepChannels& channels, const DepthConverter& depth);

// Lists of one row of pixels: for every pixel of some lists, one entry for each of its opaque samples, with the layers
// in front of that sample alone, and one with all layers for what shows beyond.
struct HeldOutRow {
  FragmentLists lists;               // window: entries x 1
  std::vector<std::uint64_t> first;  // per pixel of the lists given, and the end: its entries in the row
  std::vector<glm::ivec2> pixel;     // per entry: where in the display window
  std::vector<float> z;              // per entry: depth of its opaque sample, planar metres, +inf beyond all
  std::vector<std::size_t> place;    // per entry: where among all entries of the picture, see placesOf()
  std::vector<std::uint8_t> bends;   // per entry: a layer in front of its sample refracts or diffuses
  // Per entry, or empty where no volume is cut: how much of its sample it is, and whether the entry before it is of the
  // same sample. Parts of a cut volume have no place of their own, kNoPlace.
  std::vector<glm::vec3> part;
  std::vector<std::uint8_t> goesOn;

  static constexpr std::size_t kNoPlace = ~std::size_t{0};
  glm::dvec3 partOf(std::size_t entry) const { return part.empty() ? glm::dvec3(1.0) : glm::dvec3(part[entry]); }
  bool isOfSampleBefore(std::size_t entry) const { return entry < goesOn.size() && goesOn[entry]; }
};
// How a volume of the picture holds out the layers inside of it: as if it lay half way, which keeps one entry for each
// sample, or cut where they are.
enum class VolumeCuts { halfWay, atLayers };
// A pixel without layers or solid has no entry, unless `everywhere` says that something else is in front of it.
HeldOutRow holdOut(const FragmentLists& lists, const DeepOpaque& opaque, bool everywhere = false,
                   VolumeCuts cuts = VolumeCuts::halfWay);
// How many entries the whole picture has: its samples, and one more for each pixel.
std::size_t placesOf(const DeepOpaque& opaque);

// The veil of such a row back to pixels of `veil`: every sample's light and transmission by its share. What stands
// behind is in `applied`, except for what the lookups are still to add.
//   window    of the lists, in the display window
//   veil      scatters()
//   row       veil of heldOut.lists
//   scatter   where layers look the background up elsewhere, or null
//   lookedUp  transmission of the samples that layers in front of them scatter
void addHeldOut(const Window& window, const HeldOutRow& heldOut, const Veil& row, const DeepOpaque& opaque,
                const OitPlanes* scatter, Veil& veil, Image<glm::vec3>& lookedUp);

// Sums each pixel's entries by their shares: what was worked out for every place of the picture, for its pixels.
glm::vec3 sumOfPlaces(const DeepOpaque& opaque, std::size_t pixel, const Image<glm::vec3>& places);

// Adds what the layers look up.
void showThroughHeldOut(const Lookups& lookups, const Image<glm::vec3>& lookedUp, Veil& veil);

}  // namespace pellucid
