#include "composite/fold_exact.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "shaders/exact_sums.h"

namespace pellucid {
namespace {

constexpr std::size_t kPlanes = 7;
using Terms = std::array<glm::vec4, kPlanes>;  // radiance, weight, opacity, depth, light, refraction, dispersion

Terms termsOf(const FragmentLists& lists, std::size_t place, const shading::WeightSettings& weight, int normalisation,
              bool scatters, float& diffuseZ) {
  const Fragment& fragment = lists.fragments[place];
  const shading::Layer layer = layerFrom(fragment);
  const shading::OitTargets sums = shading::packSums(shading::layerSums(layer, weight, normalisation));
  Terms terms{sums.radiance, sums.weight, sums.opacity, sums.depth, sums.light, glm::vec4(0.0f), glm::vec4(0.0f)};
  if (!scatters) return terms;
  const shading::ScatterTargets bent = shading::packScatter(layer, scatterFrom(fragment));
  terms[4].a = bent.refractionZ;
  terms[5] = bent.refraction;
  diffuseZ = std::min(diffuseZ, bent.diffuseZ);
  if (lists.disperses()) terms[6] = shading::packDispersion(layer, scatterFrom(fragment), lists.dispersion[place]);
  return terms;
}

Terms summed(const std::vector<Terms>& terms) {
  Terms largest{}, sums{};
  for (const Terms& one : terms)
    for (std::size_t k = 0; k < kPlanes; ++k) largest[k] = glm::max(largest[k], glm::abs(one[k]));
  if (terms.empty()) return sums;
  for (std::size_t k = 0; k < kPlanes; ++k) {
    if (largest[k] == glm::vec4(0.0f)) continue;
    shading::ExactSums plane = shading::exactSums(largest[k], static_cast<glm::uint>(terms.size()));
    for (const Terms& one : terms) plane = shading::addedTo(plane, one[k]);
    sums[k] = shading::roundedSums(plane);
  }
  return sums;
}

}  // namespace

void foldExact(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
               OitPlanes& planes) {
  copySolids(lists, planes);
  const bool scatters = anyScatters(lists);
  if (scatters) addScatterPlanes(planes);
  if (lists.disperses()) addDispersionPlane(planes);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<Terms> terms;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        terms.clear();
        float front = std::numeric_limits<float>::infinity(), diffuse = front;
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
          if (!takesPart(lists.fragments[i], lists.solid.at(x, y))) continue;
          terms.push_back(termsOf(lists, i, weight, normalisation, scatters, diffuse));
          front = std::min(front, lists.fragments[i].z);
        }
        const Terms sums = summed(terms);
        const int px = left + x, py = top + y;
        planes.radiance.at(px, py) = sums[0];
        planes.weight.at(px, py) = sums[1];
        planes.opacity.at(px, py) = sums[2];
        planes.depth.at(px, py) = sums[3];
        planes.light.at(px, py) = sums[4];
        planes.frontZ.at(px, py) = front;
        if (!scatters) continue;
        planes.refraction.at(px, py) = sums[5];
        planes.diffuseZ.at(px, py) = diffuse;
        if (lists.disperses()) planes.dispersion.at(px, py) = sums[6];
      }
  });
}

}  // namespace pellucid
