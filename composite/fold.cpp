#include "composite/fold.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "composite/denormals.h"
#include "composite/layer_terms.h"

namespace pellucid {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();

}  // namespace

shading::Layer layerFrom(const Fragment& fragment) {
  shading::Layer layer;
  layer.radiance = fragment.radiance;
  layer.coverage = fragment.coverage;
  layer.transmission = fragment.transmission;
  layer.z = fragment.z;
  return layer;
}

shading::Scatter scatterFrom(const Fragment& fragment) {
  shading::Scatter scatter;
  scatter.offset = fragment.offset;
  scatter.variance = fragment.variance;
  return scatter;
}

bool takesPart(const Fragment& fragment, const glm::vec4& solid) {
  return !(fragment.z > solid.a) && !shading::isSolid(fragment.coverage, fragment.transmission);
}

void copySolids(const FragmentLists& lists, OitPlanes& planes) {
  if (planes.solid.empty()) {
    const auto hides = [](const glm::vec4& solid) { return solid.a < kNowhere; };
    if (std::none_of(lists.solid.data(), lists.solid.data() + lists.solid.size(), hides)) return;
    planes.solid = Image<glm::vec4>(planes.data.width(), planes.data.height(), glm::vec4(0.0f, 0.0f, 0.0f, kNowhere));
  }
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  for (int y = 0; y < lists.window.height(); ++y)
    std::copy(lists.solid.row(y), lists.solid.row(y) + lists.window.width(), &planes.solid.at(left, top + y));
}

namespace {

// Adds what `termsOf(place, terms)` says of every fragment that takes part, in list order.
template <class TermsOf>
void foldInto(const FragmentLists& lists, OitPlanes& planes, const TermsOf& termsOf) {
  copySolids(lists, planes);
  if (anyScatters(lists)) addPlanes(planes, modelOf(lists));
  const PixelSums pixels(planes);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  const auto width = static_cast<std::size_t>(lists.window.width());
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const std::size_t from = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        const int px = left + x, py = top + y;
        const std::size_t to =
            static_cast<std::size_t>(py) * static_cast<std::size_t>(planes.data.width()) + static_cast<std::size_t>(px);
        PlaneTerms sums = pixels.at(to);
        float front = planes.frontZ[to], diffuse = planes.scatters() ? planes.diffuseZ[to] : kNowhere;
        for (std::uint64_t i = lists.offsets[from]; i < lists.offsets[from + 1]; ++i) {
          if (!takesPart(lists.fragments[i], lists.solid.at(x, y))) continue;
          LayerTerms terms;
          termsOf(i, terms);
          for (std::size_t k = 0; k < kAddedSums; ++k) sums[k] += terms.sums[k];
          front = std::min(front, terms.frontZ);
          diffuse = std::min(diffuse, terms.diffuseZ);
        }
        pixels.set(to, sums);
        planes.frontZ[to] = front;
        if (planes.scatters()) planes.diffuseZ[to] = diffuse;
      }
  });
}

}  // namespace

void foldScattering(const FragmentLists& lists, OitPlanes& planes) {
  if (!anyScatters(lists)) return copySolids(lists, planes);
  foldInto(lists, planes, [&](std::size_t i, LayerTerms& terms) { addScattering(lists, i, terms); });
}

void foldFragments(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
                   OitPlanes& planes) {
  const bool scatters = anyScatters(lists);
  foldInto(lists, planes, [&](std::size_t i, LayerTerms& terms) {
    addSums(lists, i, weight, normalisation, terms);
    if (scatters) addScattering(lists, i, terms);
  });
}

}  // namespace pellucid
