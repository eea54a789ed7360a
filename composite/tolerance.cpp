#include "composite/tolerance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "composite/denormals.h"
#include "composite/gather.h"
#include "composite/over.h"

namespace pellucid {
namespace {

// Float sums of n terms and the polynomials of resolve: (n + 16) roundings of half an ulp each, on what they sum to.
constexpr double kRounding = 0x1p-23;
constexpr double kResolveRoundings = 16.0;

// The weighted mean of a pixel's layers over its solid, and whether it provably lies within the tolerance. Transmission
// is exact: only its rounding acts on what lies behind, however bright that is.
//   behind  the background's colour; nothing: not known yet, not negative
bool certify(const std::vector<MethodLayer>& layers, const MethodChoice& choice, const glm::vec4& solid,
             const std::optional<glm::dvec3>& behind, double tolerance, LayerMix& mix) {
  const glm::dvec3 beta = productOfPassed(layers), bound = errorBound(layers);
  mix = mixWeighted(layers, choice);
  mix.transmission = beta;
  glm::dvec3 back = behind.value_or(glm::dvec3(0.0));
  if (std::isfinite(solid.a)) {
    back = glm::dvec3(glm::vec3(solid));
    mix.light += beta * back;
    mix.transmission = glm::dvec3(0.0);
  }
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(back[c])) back[c] = 0.0;  // it makes both pictures so
    const double shown = mix.light[c] + mix.transmission[c] * back[c];
    const double size = behind || std::isfinite(solid.a) ? std::max(1.0, std::abs(shown)) : 1.0;
    if (bound[c] + kRounding * beta[c] * std::abs(back[c]) > (tolerance - kRounding) * size) return false;
  }
  return true;
}

}  // namespace

glm::dvec3 errorBound(const std::vector<MethodLayer>& layers) {
  const glm::dvec3 beta = productOfPassed(layers);
  glm::dvec3 bound;
  for (int c = 0; c < 3; ++c) {
    double low = std::numeric_limits<double>::infinity(), high = 0, added = 0;
    bool averages = false;
    for (const MethodLayer& layer : layers) {
      if (layer.adds(c)) {
        added += layer.light[c];
        continue;
      }
      if (layer.opacity[c] <= 0.0) return glm::dvec3(std::numeric_limits<double>::infinity());
      const double mean = layer.light[c] / layer.opacity[c];
      low = std::min(low, mean);
      high = std::max(high, mean);
      averages = true;
    }
    const double spread = averages ? high - low : 0.0;
    // A clear channel hides up to 1e-3 a layer but is not in the mean: its share of 1 - beta shows the mean instead of
    // its own light.
    double clear = 0.0;
    for (const MethodLayer& layer : layers)
      if (layer.adds(c)) clear += layer.opacity[c];
    const double largest = averages ? std::max(std::abs(low), std::abs(high)) : 0.0;
    const double size = largest + std::abs(added) + 1.0;
    const double rounding = (static_cast<double>(layers.size()) + kResolveRoundings) * kRounding * size;
    bound[c] = (1.0 - beta[c]) * (spread + std::abs(added)) + clear * largest + rounding;
  }
  return bound;
}

void compositeWithin(const FragmentLists& lists, const MethodChoice& choice, const Window& data,
                     const Image<glm::vec4>* background, const OitPlanes* scatter, double tolerance, Veil& veil,
                     ToleranceCounts& counts) {
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0, width = lists.window.width();
  std::vector<std::uint8_t> uncertain(lists.solid.size(), 0);
  std::atomic<std::size_t> certified{0}, recomputed{0};
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<MethodLayer> layers;
    std::size_t certain = 0, others = 0;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const int px = left + x, py = top + y;
        const glm::vec4 solid = lists.solid.at(x, y);
        layersOf(lists, pixel, solid.a, layers);
        if (layers.empty() && !std::isfinite(solid.a)) continue;
        std::optional<glm::dvec3> behind;
        if (background && !(scatter && scattersAt(*scatter, px, py)))
          behind = glm::dvec3(glm::vec3(background->at(px, py)));
        LayerMix mix;
        if (layers.empty() || !certify(layers, choice, solid, behind, tolerance, mix)) {
          uncertain[pixel] = 1;
          ++(layers.empty() ? certain : others);  // a solid alone is exact
          continue;
        }
        ++certain;
        float front = solid.a;
        for (const MethodLayer& layer : layers) front = std::min(front, layer.record->z);
        veil.light.at(px, py) = glm::vec3(mix.light);
        veil.transmission.at(px, py) = glm::vec3(mix.transmission);
        veil.frontZ.at(px, py) = front;
        veil.touched.at(px, py) = 1;
      }
    certified += certain;
    recomputed += others;
  });
  counts.certified += certified;
  counts.recomputed += recomputed;
  compositeSorted(lists, data, veil, &uncertain);
}

}  // namespace pellucid
