// WB13 listings 3 and 4 as their targets hold them: half floats, rounded at every blend, one coverage for all channels.
// What they cannot hold is lost, as it is on the page: coloured transmission, and light without coverage.
#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "composite/methods/method.h"

namespace pellucid {
namespace {

constexpr float kLargestHalf = 65504.0f;

// What a half float target keeps; beyond its range the largest value, where the paper's would become infinite.
float stored(float value) {
  return glm::unpackHalf1x16(glm::packHalf1x16(std::min(value, kLargestHalf)));
}

float coverageOf(const MethodLayer& layer) {
  return shading::meanOf(shading::opacityOf(layer.record->coverage, layer.record->transmission));
}

float weightOf(const MethodLayer& layer, float alpha, const MethodChoice& choice) {
  return shading::layerWeight(choice.weight, layer.record->z, alpha);
}

LayerMix mixOf(const glm::vec3& sum, float weight, float revealage) {
  const glm::vec3 colour = listingColour(sum, weight);
  return {glm::dvec3(colour * (1.0f - revealage)), glm::dvec3(static_cast<double>(revealage))};
}

}  // namespace

glm::vec3 listingColour(const glm::vec3& sum, float weight) {
  return sum / std::clamp(weight, 1e-4f, 5e4f);
}

LayerMix mixListing3(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  glm::vec4 accum(0.0f);   // target 0: blended ONE, ONE
  float revealage = 1.0f;  // target 1: blended ZERO, ONE_MINUS_SRC_ALPHA
  for (const MethodLayer& layer : layers) {
    const float alpha = coverageOf(layer), w = weightOf(layer, alpha, choice);
    const glm::vec4 source = glm::vec4(layer.record->radiance, alpha) * w;
    for (int c = 0; c < 4; ++c) accum[c] = stored(accum[c] + source[c]);
    revealage = stored(revealage * (1.0f - alpha));
  }
  return mixOf(glm::vec3(accum), accum.a, revealage);
}

LayerMix mixListing4(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  // One blend function for both targets: colour ONE, ONE; alpha ZERO, ONE_MINUS_SRC_ALPHA.
  glm::vec4 a(0.0f, 0.0f, 0.0f, 1.0f);
  float b = 0.0f;
  for (const MethodLayer& layer : layers) {
    const float alpha = coverageOf(layer), w = weightOf(layer, alpha, choice);
    for (int c = 0; c < 3; ++c) a[c] = stored(a[c] + layer.record->radiance[c] * w);
    a.a = stored(a.a * (1.0f - alpha));
    b = stored(b + alpha * w);
  }
  return mixOf(glm::vec3(a), b, a.a);
}

LayerMix mixMonochrome(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  // Listing 4 in one target: (C, alpha) w in red and green, what is left of the background in alpha.
  glm::vec4 a(0.0f, 0.0f, 0.0f, 1.0f);
  for (const MethodLayer& layer : layers) {
    const float alpha = coverageOf(layer), w = weightOf(layer, alpha, choice);
    a.r = stored(a.r + shading::meanOf(layer.record->radiance) * w);
    a.g = stored(a.g + alpha * w);
    a.a = stored(a.a * (1.0f - alpha));
  }
  return mixOf(glm::vec3(a.r), a.g, a.a);
}

}  // namespace pellucid
