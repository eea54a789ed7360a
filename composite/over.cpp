#include "composite/over.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <vector>

#include "composite/depth_order.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

using glm::dvec3;

struct Layer {
  dvec3 light;    // premultiplied
  dvec3 opacity;  // per channel
};

// OpenEXR's rule for samples in the same place, one channel: densities add, each keeps its share of the light.
void mergeCoincident(double& light, double& opacity, double otherLight, double otherOpacity) {
  if (opacity >= 1.0 || otherOpacity >= 1.0) {
    if (opacity >= 1.0 && otherOpacity >= 1.0)
      light = 0.5 * (light + otherLight);
    else if (otherOpacity >= 1.0)
      light = otherLight;
    opacity = 1.0;
    return;
  }
  const double depth = -std::log1p(-opacity), otherDepth = -std::log1p(-otherOpacity);
  const double sumDepth = depth + otherDepth;
  const double merged = -std::expm1(-sumDepth);
  const double scale = opacity > 0.0 ? depth / opacity : 1.0;
  const double otherScale = otherOpacity > 0.0 ? otherDepth / otherOpacity : 1.0;
  light = (light * scale + otherLight * otherScale) * (sumDepth > 0.0 ? merged / sumDepth : 1.0);
  opacity = merged;
}

// A total order on all bits of the record, so that sums of coincident layers do not depend on list order either.
template <class Record>
struct Place {
  float z;  // of the fragment, which sorting reads most
  const Record* fragment;
};
template <class Record>
bool before(const Place<Record>& a, const Place<Record>& b) {
  if (a.z != b.z) return a.z < b.z;
  return std::memcmp(a.fragment, b.fragment, sizeof(Record)) < 0;
}

std::span<const Fragment> fragmentsOf(const FragmentLists& lists, std::size_t pixel) {
  const std::uint64_t begin = lists.offsets[pixel];
  return {lists.fragments.data() + begin, static_cast<std::size_t>(lists.offsets[pixel + 1] - begin)};
}

std::span<const LeanFragment> fragmentsOf(const LeanLists& lists, std::size_t pixel) {
  const LeanLists::Range range = lists.ranges[pixel];
  return lists.fragments.subspan(range.begin, range.count);
}

// The fragments of a pixel that show, from near to far. Neighbours are mostly drawn in the same order, so the last
// pixel's order is tried before any sorting.
template <class Record>
class Sorted {
 public:
  const std::vector<Place<Record>>& of(std::span<const Record> fragments, float solidZ) {
    places_.clear();
    if (order_.size() != fragments.size()) {
      order_.resize(fragments.size());
      std::iota(order_.begin(), order_.end(), 0u);
    }
    for (const std::uint32_t i : order_) {
      const Record& fragment = fragments[i];
      if (fragment.z <= solidZ && !shading::isSolid(fragment.coverage, fragment.transmission))
        places_.push_back({fragment.z, &fragment});
    }
    if (std::is_sorted(places_.begin(), places_.end(), before<Record>)) return places_;
    sort();
    if (places_.size() == order_.size())
      for (std::size_t i = 0; i < order_.size(); ++i)
        order_[i] = static_cast<std::uint32_t>(places_[i].fragment - fragments.data());
    return places_;
  }

 private:
  void sort() {
    const std::size_t count = places_.size();
    float z[kMostRanked];
    std::uint32_t order[kMostRanked];
    for (std::size_t i = 0; i < std::min(count, kMostRanked); ++i) z[i] = places_[i].z;
    if (count > kMostRanked || !orderByDepth(z, count, order)) {
      std::sort(places_.begin(), places_.end(), before<Record>);
      return;
    }
    unsorted_ = places_;
    for (std::size_t i = 0; i < count; ++i) places_[i] = unsorted_[order[i]];
  }

  std::vector<Place<Record>> places_, unsorted_;
  std::vector<std::uint32_t> order_;
};

template <class Record>
Layer layerOf(const Record& fragment) {
  const dvec3 opacity = static_cast<double>(fragment.coverage) * (dvec3(1.0) - dvec3(fragment.transmission));
  return {dvec3(fragment.radiance), opacity};
}

template <class Record, class Lists>
void composite(const Lists& lists, const Window& data, Veil& veil, const std::vector<std::uint8_t>* only) {
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    Sorted<Record> sorter;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        if (only && !(*only)[pixel]) continue;
        const glm::vec4 solid = lists.solid.empty() ? glm::vec4(0, 0, 0, INFINITY) : lists.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        const std::vector<Place<Record>>& sorted = sorter.of(fragmentsOf(lists, pixel), solid.a);
        if (sorted.empty() && !hasSolid) continue;

        dvec3 light = hasSolid ? dvec3(glm::vec3(solid)) : dvec3(0.0);
        dvec3 transmission = hasSolid ? dvec3(0.0) : dvec3(1.0);
        for (std::size_t end = sorted.size(); end > 0;) {
          std::size_t begin = end - 1;
          while (begin > 0 && sorted[begin - 1].z == sorted[begin].z) --begin;
          Layer layer = layerOf(*sorted[begin].fragment);
          for (std::size_t k = begin + 1; k < end; ++k) {
            const Layer other = layerOf(*sorted[k].fragment);
            for (int c = 0; c < 3; ++c)
              mergeCoincident(layer.light[c], layer.opacity[c], other.light[c], other.opacity[c]);
          }
          light = layer.light + (dvec3(1.0) - layer.opacity) * light;
          transmission *= dvec3(1.0) - layer.opacity;
          end = begin;
        }
        veil.light.at(left + x, top + y) = glm::vec3(light);
        veil.transmission.at(left + x, top + y) = glm::vec3(transmission);
        veil.frontZ.at(left + x, top + y) = sorted.empty() ? solid.a : std::min(sorted.front().z, solid.a);
        veil.touched.at(left + x, top + y) = 1;
      }
  });
}

}  // namespace

void compositeSorted(const FragmentLists& lists, const Window& data, Veil& veil,
                     const std::vector<std::uint8_t>* only) {
  composite<Fragment>(lists, data, veil, only);
}

void compositeSorted(const LeanLists& lists, const Window& data, Veil& veil) {
  composite<LeanFragment>(lists, data, veil, nullptr);
}

}  // namespace pellucid
