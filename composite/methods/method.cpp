#include "composite/methods/method.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

#include "composite/denormals.h"

namespace pellucid {
namespace {

// Beyond this nothing shows; a cap keeps sums of absorbance meaningful. Münstermann et al. 2018 and its ports.
constexpr double kAbsorbanceCap = 10.0;

bool orderFits(const MethodOrder& order, const std::string& text, int& value) {
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && next == end && order.most > 0 && value >= order.least && value <= order.most &&
         (!order.even || value % 2 == 0);
}

bool variantFits(const char* variants, const std::string& text) {
  std::istringstream all(variants ? variants : "");
  for (std::string one; std::getline(all, one, '|');)
    if (text == one) return true;
  return false;
}

// "wavelet:N (N 0 to 6)", "stochastic[:basic|alpha|depth]", "over"
std::string formOf(const Method& method) {
  if (method.variants) return std::string(method.name) + "[:" + method.variants + "]";
  if (method.order.most == 0) return method.name;
  return std::string(method.name) + ":N (N " + std::to_string(method.order.least) + " to " +
         std::to_string(method.order.most) + (method.order.even ? ", even)" : ")");
}

std::string namesOf(const std::vector<Method>& table) {
  std::string names;
  for (const Method& method : table) names += (names.empty() ? "" : ", ") + formOf(method);
  return names;
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> table = [] {
    std::vector<Method> rows;
    std::copy_if(allMethods().begin(), allMethods().end(), std::back_inserter(rows),
                 [](const Method& method) { return method.mix != nullptr; });
    return rows;
  }();
  return table;
}

const Method* methodNamed(const std::string& text) {
  const std::size_t colon = text.find(':');
  for (const Method& method : allMethods()) {
    if (text.substr(0, colon) != method.name) continue;
    int order = 0;
    const bool fits = colon == std::string::npos || orderFits(method.order, text.substr(colon + 1), order) ||
                      variantFits(method.variants, text.substr(colon + 1));
    return fits ? &method : nullptr;
  }
  return nullptr;
}

std::optional<ChosenMethod> chooseMethod(const std::string& text) {
  const Method* method = methodNamed(text);
  if (!method || !method->mix) return std::nullopt;
  ChosenMethod chosen{method, method->order.usual, method->name};
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) orderFits(method->order, text.substr(colon + 1), chosen.order);
  if (method->order.most > 0) chosen.name += ":" + std::to_string(chosen.order);
  return chosen;
}

std::string methodNames() {
  return namesOf(methods());
}

std::string allMethodNames() {
  return namesOf(allMethods());
}

std::string sumMethodNames() {
  std::vector<Method> sums;
  for (const Method& row : allMethods())
    if (row.isSum) sums.push_back(row);
  return namesOf(sums);
}

std::string methodsHelp() {
  std::string text;
  for (const Method& method : allMethods()) text += formOf(method) + ": " + method.help + " (" + method.source + ")\n";
  return text;
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
