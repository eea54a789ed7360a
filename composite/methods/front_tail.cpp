// The nearest layer exactly, over a weighted blend of the others.
#include <algorithm>

#include "composite/methods/method.h"

namespace pellucid {

LayerMix mixFrontTail(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  const auto front = std::min_element(layers.begin(), layers.end(), [](const MethodLayer& a, const MethodLayer& b) {
    return a.z != b.z ? a.z < b.z : a.record->identity < b.record->identity;
  });
  LayerMix mix;
  if (layers.size() > 1) {
    std::vector<MethodLayer> tail(layers.begin(), front);
    tail.insert(tail.end(), front + 1, layers.end());
    mix = mixWeighted(tail, choice);
  }
  mix.light = front->light + (glm::dvec3(1.0) - front->opacity) * mix.light;
  mix.transmission *= glm::dvec3(1.0) - front->opacity;
  return mix;
}

}  // namespace pellucid
