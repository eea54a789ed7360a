#include "composite/over.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

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

// By insertion, which is the quickest for as few as most pixels have.
template <class Record>
void sortPlaces(std::vector<Place<Record>>& places) {
  constexpr std::size_t kFew = 32;
  if (places.size() > kFew) {
    std::sort(places.begin(), places.end(), before<Record>);
    return;
  }
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Place<Record> moved = places[i];
    std::size_t k = i;
    for (; k > 0 && before(moved, places[k - 1]); --k) places[k] = places[k - 1];
    places[k] = moved;
  }
}

template <class Record>
Layer layerOf(const Record& fragment) {
  const dvec3 opacity = static_cast<double>(fragment.coverage) * (dvec3(1.0) - dvec3(fragment.transmission));
  return {dvec3(fragment.radiance), opacity};
}

template <class Record>
void composite(const ListsOf<Record>& lists, const Window& data, Veil& veil, const std::vector<std::uint8_t>* only) {
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    std::vector<Place<Record>> sorted;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        if (only && !(*only)[pixel]) continue;
        const glm::vec4 solid = lists.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        sorted.clear();
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
          const Record& fragment = lists.fragments[i];
          if (fragment.z <= solid.a && !shading::isSolid(fragment.coverage, fragment.transmission))
            sorted.push_back({fragment.z, &fragment});
        }
        if (sorted.empty() && !hasSolid) continue;
        sortPlaces(sorted);

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
  composite(lists, data, veil, only);
}

void compositeSorted(const LeanLists& lists, const Window& data, Veil& veil) {
  composite(lists, data, veil, nullptr);
}

}  // namespace pellucid
