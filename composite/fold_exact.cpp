#include "composite/fold_exact.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "composite/lanes.h"
#include "composite/layer_terms.h"
#include "shaders/exact_sums.h"

namespace pellucid {
namespace {

PlaneTerms summed(const std::vector<PlaneTerms>& terms) {
  PlaneTerms largest{}, sums{};
  for (const PlaneTerms& one : terms)
    for (std::size_t k = 0; k < kAddedSums; ++k) largest[k] = glm::max(largest[k], glm::abs(one[k]));
  if (terms.empty()) return sums;
  for (std::size_t k = 0; k < kAddedSums; ++k) {
    if (largest[k] == glm::vec4(0.0f)) continue;
    shading::ExactSums plane = shading::exactSums(largest[k], static_cast<glm::uint>(terms.size()));
    for (const PlaneTerms& one : terms) plane = shading::addedTo(plane, one[k]);
    sums[k] = shading::roundedSums(plane);
  }
  return sums;
}

// What scattering reads of a pixel's sums: light, and what stands after it.
constexpr auto kFirstRead = static_cast<std::size_t>(PlaneSum::light);
constexpr std::size_t kReadSums = kAddedSums - kFirstRead;
static_assert(kFirstRead + 1 == kFirstScatterSum);

struct ScatteringTerms {
  glm::vec4 sums[kReadSums];
};

glm::vec4 summed(const std::vector<ScatteringTerms>& terms, std::size_t plane) {
  if (terms.size() == 1) return terms.front().sums[plane] + 0.0f;  // which the sums hold exactly, and no -0
  glm::vec4 largest(0.0f);
  for (const ScatteringTerms& one : terms) largest = glm::max(largest, glm::abs(one.sums[plane]));
  if (largest == glm::vec4(0.0f)) return largest;
  shading::ExactSums sums = shading::exactSums(largest, static_cast<glm::uint>(terms.size()));
  for (const ScatteringTerms& one : terms) sums = shading::addedTo(sums, one.sums[plane]);
  return shading::roundedSums(sums);
}

// One row of the lists' window.
//   terms  room that is used again
PLD_CLONES void foldScatteringRow(const FragmentLists& lists, int y, std::vector<ScatteringTerms>& terms,
                                  OitPlanes& planes) {
  const int left = lists.window.x0 - planes.data.x0, py = lists.window.y0 - planes.data.y0 + y;
  // Of light, which comes first, its alpha alone is kept.
  Image<glm::vec4>* kept[kReadSums] = {nullptr};
  std::size_t places[kReadSums] = {kFirstRead}, count = 1;
  for (std::size_t k = kFirstScatterSum; k < kAddedSums; ++k) {
    if (planes.sums()[k]->empty()) continue;
    kept[count] = planes.sums()[k];
    places[count++] = k;
  }
  for (int x = 0; x < lists.window.width(); ++x) {
    const auto pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
    float diffuse = std::numeric_limits<float>::infinity();
    terms.clear();
    for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
      if (!takesPart(lists.fragments[i], lists.solid.at(x, y))) continue;
      LayerTerms one;
      addScattering(lists, i, one);
      ScatteringTerms read;
      for (std::size_t k = 0; k < count; ++k) read.sums[k] = one.sums[places[k]];
      terms.push_back(read);
      diffuse = std::min(diffuse, one.diffuseZ);
    }
    planes.refractionZ.at(left + x, py) = terms.empty() ? 0.0f : summed(terms, 0).a;
    for (std::size_t k = 1; k < count; ++k)
      kept[k]->at(left + x, py) = terms.empty() ? glm::vec4(0.0f) : summed(terms, k);
    planes.diffuseZ.at(left + x, py) = diffuse;
  }
}

}  // namespace

bool foldExactScattering(const FragmentLists& lists, OitPlanes& planes) {
  copySolids(lists, planes);
  const LayerModel layers = modelOf(lists);
  addPlanes(planes, layers);
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<ScatteringTerms> terms;
    for (int y = rows.begin(); y != rows.end(); ++y) foldScatteringRow(lists, y, terms, planes);
  });
  return layers.scatters();
}

void foldExact(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
               OitPlanes& planes) {
  copySolids(lists, planes);
  const LayerModel layers = modelOf(lists);
  const bool scatters = layers.scatters();
  addPlanes(planes, layers);
  const PixelSums pixels(planes);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<PlaneTerms> terms;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        terms.clear();
        float front = std::numeric_limits<float>::infinity(), diffuse = front;
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
          if (!takesPart(lists.fragments[i], lists.solid.at(x, y))) continue;
          LayerTerms one;
          addSums(lists, i, weight, normalisation, one);
          if (scatters) addScattering(lists, i, one);
          terms.push_back(one.sums);
          front = std::min(front, one.frontZ);
          diffuse = std::min(diffuse, one.diffuseZ);
        }
        const int px = left + x, py = top + y;
        pixels.set(
            static_cast<std::size_t>(py) * static_cast<std::size_t>(planes.data.width()) + static_cast<std::size_t>(px),
            summed(terms));
        planes.frontZ.at(px, py) = front;
        if (scatters) planes.diffuseZ.at(px, py) = diffuse;
      }
  });
}

}  // namespace pellucid
