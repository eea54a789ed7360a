// WB13 eq. 3 (Meshkin 2007): C = sum C_i + C_0 (1 - sum alpha_i). Right to first order only: thick stacks blow up. A
// display would clamp what is left of the background at 0, and so do we.
#include "composite/methods/method.h"

namespace pellucid {

LayerMix sumOf(const glm::dvec3& light, const glm::dvec3& opacity) {
  return {light, glm::max(glm::dvec3(1.0) - opacity, glm::dvec3(0.0))};
}

LayerMix mixSum(const std::vector<MethodLayer>& layers, const MethodChoice&) {
  glm::dvec3 light(0.0), passed(1.0);
  for (const MethodLayer& layer : layers) {
    light += layer.light;
    passed -= layer.opacity;
  }
  return {light, glm::max(passed, glm::dvec3(0.0))};
}

}  // namespace pellucid
