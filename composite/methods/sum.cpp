// WB13 eq. 3 (Meshkin 2007): C = sum C_i + C_0 (1 - sum alpha_i). Right to first order only: thick stacks blow up. A
// display would clamp what is left of the background at 0, and so do we.
#include "composite/methods/method.h"

namespace pellucid {

LayerMix mixSum(const std::vector<MethodLayer>& layers, const MethodChoice&) {
  LayerMix mix;
  for (const MethodLayer& layer : layers) {
    mix.light += layer.light;
    mix.transmission -= layer.opacity;
  }
  mix.transmission = glm::max(mix.transmission, glm::dvec3(0.0));
  return mix;
}

}  // namespace pellucid
