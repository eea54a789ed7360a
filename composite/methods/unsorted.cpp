// Over in the order submitted: what a renderer that never sorts shows. The worst case of the study.
#include "composite/methods/method.h"

namespace pellucid {

LayerMix mixUnsorted(const std::vector<MethodLayer>& layers, const MethodChoice&) {
  LayerMix mix;
  for (const MethodLayer& layer : layers) {
    mix.light = layer.light + (glm::dvec3(1.0) - layer.opacity) * mix.light;
    mix.transmission *= glm::dvec3(1.0) - layer.opacity;
  }
  return mix;
}

}  // namespace pellucid
