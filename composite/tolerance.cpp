#include "composite/tolerance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/over.h"

namespace pellucid {
namespace {

// Float sums of n terms and the polynomials of resolve: (n + 16) roundings of half an ulp each, on what they sum to.
constexpr double kRounding = 0x1p-23;
constexpr double kResolveRoundings = 16.0;

// The fragments of some pixels of the lists, the others empty.
FragmentLists onlyPixels(const FragmentLists& lists, const std::vector<bool>& wanted) {
  FragmentLists chosen;
  chosen.window = lists.window;
  chosen.offsets.assign(1, 0);
  chosen.solid = lists.solid;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i])
      chosen.fragments.insert(chosen.fragments.end(),
                              lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                              lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]));
    chosen.offsets.push_back(chosen.fragments.size());
  }
  return chosen;
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

void compositeWithin(const FragmentLists& lists, const MethodChoice& choice, const GBuffer& background,
                     double tolerance, Veil& veil, ToleranceCounts& counts) {
  const Window& data = background.data;
  compositeBy(*chooseMethod("weighted"), choice, lists, data, veil);
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0;
  std::vector<bool> uncertain(lists.solid.size(), false);
  std::vector<MethodLayer> layers;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
      if (!veil.touched.at(left + x, top + y)) continue;
      layersOf(lists, pixel, lists.solid.at(x, y).a, layers);
      bool certain = true;
      if (!layers.empty()) {
        const glm::dvec3 bound = errorBound(layers);
        for (int c = 0; c < 3; ++c) {
          const double transmission = static_cast<double>(veil.transmission.at(left + x, top + y)[c]);
          const double behind = static_cast<double>(background.beauty.at(left + x, top + y)[c]);
          // What is not finite behind makes both pictures so.
          const double shown = static_cast<double>(veil.light.at(left + x, top + y)[c]) +
                               (std::isfinite(behind) ? transmission * behind : 0.0);
          // Rounding acts on the background's share, too.
          const double rounding = std::isfinite(behind) ? kResolveRoundings * kRounding * std::abs(behind) : 0.0;
          certain = certain && bound[c] + rounding <= tolerance * std::max(1.0, std::abs(shown));
        }
      }
      ++(certain ? counts.certified : counts.recomputed);
      uncertain[pixel] = !certain;
    }
  Veil exact(data.width(), data.height());
  const FragmentLists rest = onlyPixels(lists, uncertain);
  compositeSorted(rest, data, exact);
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x) {
      if (!uncertain[static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) +
                     static_cast<std::size_t>(x)])
        continue;
      veil.light.at(left + x, top + y) = exact.light.at(left + x, top + y);
      veil.transmission.at(left + x, top + y) = exact.transmission.at(left + x, top + y);
    }
}

}  // namespace pellucid
