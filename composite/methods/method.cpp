#include "composite/methods/method.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "composite/denormals.h"

namespace pellucid {
namespace {

constexpr int kFloat = 32;
// Beyond this nothing shows; a cap keeps sums of absorbance meaningful. Münstermann et al. 2018 and its ports.
constexpr double kAbsorbanceCap = 10.0;

int bitsSum(int) {
  return 6 * kFloat;
}
int bitsAverage(int) {
  return 7 * kFloat;
}
int bitsBlended(int) {
  return 9 * kFloat;
}
int bitsWeighted(int) {
  return 20 * kFloat;
}
// RGBA16F and R16F, or the first alone.
int bitsListing(int) {
  return 5 * 16;
}
int bitsMonochrome(int) {
  return 4 * 16;
}
int bitsFrontTail(int) {
  return 27 * kFloat;
}
int bitsWavelet(int order) {
  return (3 * (2 << order) + 2 + 9) * kFloat;
}
int bitsMoments(int order) {
  return (3 * (order + 1) + 2 + 6) * kFloat;
}
int bitsMlab(int order) {
  return 7 * order * kFloat;
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> table{
      {"sum", mixSum, 0, 0, 0, false, false, false, "double", 1, bitsSum, "WB13 eq. 3 (Meshkin 2007)"},
      {"average", mixAverage, 0, 0, 0, false, false, false, "double", 1, bitsAverage,
       "WB13 eq. 4 (Bavoil, Myers 2008)"},
      {"blended", mixBlended, 0, 0, 0, false, false, false, "float", 1, bitsBlended, "WB13 eq. 5"},
      {"weighted", mixWeighted, 0, 0, 0, false, true, true, "float", 1, bitsWeighted, "WB13 eq. 6"},
      {"listing3", mixListing3, 0, 0, 0, false, true, false, "half", 1, bitsListing, "WB13 listing 3"},
      {"listing4", mixListing4, 0, 0, 0, false, true, false, "half", 1, bitsListing,
       "WB13 listing 4: one blend function"},
      {"monochrome", mixMonochrome, 0, 0, 0, false, true, false, "half", 1, bitsMonochrome, "WB13: one target"},
      {"unsorted", mixUnsorted, 0, 0, 0, false, false, false, "double", 1, bitsSum, "over in the order submitted"},
      {"front+tail", mixFrontTail, 0, 0, 0, false, true, true, "float", 2, bitsFrontTail,
       "exact nearest layer over eq. 6"},
      {"wavelet", mixWavelet, 2, 0, 6, false, false, false, "double", 3, bitsWavelet,
       "Aizenshtein, Smal, McGuire 2022"},
      {"moments", mixMoments, 4, 4, 8, true, false, false, "double", 3, bitsMoments, "Münstermann et al. 2018"},
      {"mlab", mixMlab, 4, 1, 64, false, false, false, "double", 1, bitsMlab, "Salvi, Vaidyanathan 2014"},
  };
  return table;
}

std::optional<ChosenMethod> chooseMethod(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  for (const Method& method : methods()) {
    if (name != method.name) continue;
    ChosenMethod chosen{&method, method.orderDefault, name};
    if (colon != std::string::npos) {
      const char* end = text.data() + text.size();
      const auto [next, error] = std::from_chars(text.data() + colon + 1, end, chosen.order);
      if (error != std::errc() || next != end || method.orderMost == 0 || chosen.order < method.orderLeast ||
          chosen.order > method.orderMost || (method.evenOrder && chosen.order % 2 != 0))
        return std::nullopt;
    }
    if (method.orderMost > 0) chosen.name += ":" + std::to_string(chosen.order);
    return chosen;
  }
  return std::nullopt;
}

std::string methodNames() {
  std::string names;
  for (const Method& method : methods()) {
    names += (names.empty() ? "" : ", ") + std::string(method.name);
    if (method.orderMost > 0)
      names += ":N (N " + std::to_string(method.orderLeast) + " to " + std::to_string(method.orderMost) +
               (method.evenOrder ? ", even)" : ")");
  }
  return names;
}

glm::dvec3 absorbanceOf(const glm::dvec3& opacity) {
  glm::dvec3 absorbance;
  for (int c = 0; c < 3; ++c)
    absorbance[c] = opacity[c] >= 1.0 ? kAbsorbanceCap : std::min(-std::log1p(-opacity[c]), kAbsorbanceCap);
  return absorbance;
}

glm::dvec3 productOfPassed(const std::vector<MethodLayer>& layers) {
  glm::dvec3 beta(1.0);
  for (const MethodLayer& layer : layers) beta *= glm::dvec3(1.0) - layer.opacity;
  return beta;
}

LayerMix mixByTransmittance(const std::vector<MethodLayer>& layers, const std::vector<glm::dvec3>& before) {
  LayerMix mix;
  mix.transmission = productOfPassed(layers);
  for (int c = 0; c < 3; ++c) {
    double light = 0, opacity = 0, added = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const double T = before[i][c];
      if (layers[i].adds(c)) {
        added += T * layers[i].light[c];
      } else {
        light += T * layers[i].light[c];
        opacity += T * layers[i].opacity[c];
      }
    }
    mix.light[c] = added + (opacity > 0.0 ? light / opacity * (1.0 - mix.transmission[c]) : 0.0);
  }
  return mix;
}

void layersOf(const FragmentLists& lists, std::size_t i, float solidZ, std::vector<MethodLayer>& layers) {
  layers.clear();
  for (std::uint64_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) {
    const Fragment& fragment = lists.fragments[k];
    if (fragment.z > solidZ || shading::isSolid(fragment.coverage, fragment.transmission)) continue;
    const glm::dvec3 opacity =
        static_cast<double>(fragment.coverage) * (glm::dvec3(1.0) - glm::dvec3(fragment.transmission));
    layers.push_back({glm::dvec3(fragment.radiance), opacity, static_cast<double>(fragment.z), &fragment});
  }
}

void compositeBy(const ChosenMethod& chosen, const MethodChoice& settings, const FragmentLists& lists,
                 const Window& data, Veil& veil) {
  MethodChoice choice = settings;
  choice.order = chosen.order;
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    std::vector<MethodLayer> layers;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        const glm::vec4 solid = lists.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        layersOf(lists, pixel, solid.a, layers);
        float front = solid.a;
        for (const MethodLayer& layer : layers) front = std::min(front, layer.record->z);
        if (layers.empty() && !hasSolid) continue;
        LayerMix mix;
        if (!layers.empty()) mix = chosen.method->mix(layers, choice);
        if (hasSolid) {
          mix.light += mix.transmission * glm::dvec3(glm::vec3(solid));
          mix.transmission = glm::dvec3(0.0);
        }
        veil.light.at(left + x, top + y) = glm::vec3(mix.light);
        veil.transmission.at(left + x, top + y) = glm::vec3(mix.transmission);
        veil.frontZ.at(left + x, top + y) = front;
        veil.touched.at(left + x, top + y) = 1;
      }
  });
}

}  // namespace pellucid
