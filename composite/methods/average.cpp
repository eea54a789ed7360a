// WB13 eq. 4 (Bavoil and Myers 2008): n equal layers of the mean opacity. Its flaw: a layer that nobody sees changes n,
// and so the picture.
#include <cmath>

#include "composite/methods/method.h"

namespace pellucid {

LayerMix averageOf(const glm::dvec3& light, const glm::dvec3& opacity, double layers) {
  LayerMix mix;
  for (int c = 0; c < 3; ++c) {
    mix.transmission[c] = std::pow(1.0 - opacity[c] / layers, layers);
    mix.light[c] = opacity[c] > 0.0 ? light[c] / opacity[c] * (1.0 - mix.transmission[c]) : light[c];
  }
  return mix;
}

LayerMix mixAverage(const std::vector<MethodLayer>& layers, const MethodChoice&) {
  glm::dvec3 light(0.0), opacity(0.0);
  for (const MethodLayer& layer : layers) {
    light += layer.light;
    opacity += layer.opacity;
  }
  return averageOf(light, opacity, static_cast<double>(layers.size()));
}

}  // namespace pellucid
