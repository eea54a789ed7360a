#include "tests/reference/sorted_over.h"

#include <algorithm>

namespace pellucid::reference {

Rgb sortedOver(std::vector<Layer> layers, Rgb background) {
  std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.z > b.z; });
  Rgb light = background;
  for (const Layer& layer : layers)
    for (std::size_t c = 0; c < 3; ++c)
      light[c] = layer.coverage * (layer.reflected[c] + layer.transmission[c] * light[c]) +
                 (1.0 - layer.coverage) * light[c] + layer.additive[c];
  return light;
}

Rgb modulation(const std::vector<Layer>& layers) {
  Rgb beta{1, 1, 1};
  for (const Layer& layer : layers)
    for (std::size_t c = 0; c < 3; ++c) beta[c] *= 1.0 - layer.coverage * (1.0 - layer.transmission[c]);
  return beta;
}

}  // namespace pellucid::reference
