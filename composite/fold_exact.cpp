#include "composite/fold_exact.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "composite/denormals.h"
#include "composite/fold.h"

namespace pellucid {
namespace {

// The planes of a pixel as one row of numbers.
constexpr std::size_t kSums = 7 * 4;
using Sums = std::array<long double, kSums>;

void add(Sums& sums, std::size_t plane, const glm::vec4& term) {
  for (int c = 0; c < 4; ++c) sums[plane * 4 + static_cast<std::size_t>(c)] += static_cast<long double>(term[c]);
}

glm::vec4 rounded(const Sums& sums, std::size_t plane) {
  glm::vec4 result;
  for (int c = 0; c < 4; ++c) result[c] = static_cast<float>(sums[plane * 4 + static_cast<std::size_t>(c)]);
  return result;
}

// Orders fragments of one list by all their bits.
class Before {
 public:
  explicit Before(const FragmentLists& lists) : lists_(lists) {}
  bool operator()(const Fragment* a, const Fragment* b) const {
    const int order = std::memcmp(a, b, sizeof(Fragment));
    if (order != 0 || !lists_.disperses()) return order < 0;
    return std::memcmp(&dispersionOf(a), &dispersionOf(b), sizeof(glm::vec4)) < 0;
  }
  const glm::vec4& dispersionOf(const Fragment* fragment) const {
    return lists_.dispersion[static_cast<std::size_t>(fragment - lists_.fragments.data())];
  }

 private:
  const FragmentLists& lists_;
};

}  // namespace

void foldExact(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
               OitPlanes& planes) {
  copySolids(lists, planes);
  const bool scatters = anyScatters(lists);
  if (scatters) addScatterPlanes(planes);
  if (lists.disperses()) addDispersionPlane(planes);
  const Before before(lists);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<const Fragment*> sorted;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        sorted.clear();
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
          if (takesPart(lists.fragments[i], lists.solid.at(x, y))) sorted.push_back(&lists.fragments[i]);
        std::sort(sorted.begin(), sorted.end(), before);

        Sums sums{};
        float front = std::numeric_limits<float>::infinity(), diffuse = front;
        for (const Fragment* fragment : sorted) {
          const shading::Layer layer = layerFrom(*fragment);
          const shading::OitTargets term = shading::packSums(shading::layerSums(layer, weight, normalisation));
          add(sums, 0, term.radiance);
          add(sums, 1, term.weight);
          add(sums, 2, term.opacity);
          add(sums, 3, term.depth);
          add(sums, 4, term.light);
          front = std::min(front, fragment->z);
          if (!scatters) continue;
          const shading::ScatterTargets bent = shading::packScatter(layer, scatterFrom(*fragment));
          add(sums, 4, glm::vec4(0.0f, 0.0f, 0.0f, bent.refractionZ));
          add(sums, 5, bent.refraction);
          diffuse = std::min(diffuse, bent.diffuseZ);
          if (lists.disperses())
            add(sums, 6, shading::packDispersion(layer, scatterFrom(*fragment), before.dispersionOf(fragment)));
        }
        const int px = left + x, py = top + y;
        planes.radiance.at(px, py) = rounded(sums, 0);
        planes.weight.at(px, py) = rounded(sums, 1);
        planes.opacity.at(px, py) = rounded(sums, 2);
        planes.depth.at(px, py) = rounded(sums, 3);
        planes.light.at(px, py) = rounded(sums, 4);
        planes.frontZ.at(px, py) = front;
        if (!scatters) continue;
        planes.refraction.at(px, py) = rounded(sums, 5);
        planes.diffuseZ.at(px, py) = diffuse;
        if (lists.disperses()) planes.dispersion.at(px, py) = rounded(sums, 6);
      }
  });
}

}  // namespace pellucid
