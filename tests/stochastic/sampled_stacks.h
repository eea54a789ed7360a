// Stacks of layers for the stochastic estimators, and what our sampler makes of them.
#pragma once
#include <vector>

#include "composite/methods/stochastic.h"
#include "tests/reference/stochastic_enumeration.h"
#include "tests/support/random.h"

namespace pellucid::test {

// Layers at depths 1, 2, ..., as the sampler takes them.
class Stack {
 public:
  explicit Stack(const std::vector<reference::StochasticLayer>& layers) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      Fragment fragment{};
      fragment.coverage = static_cast<float>(layers[i].alpha);
      for (int c = 0; c < 3; ++c)
        fragment.radiance[c] = static_cast<float>(layers[i].alpha * layers[i].colour[static_cast<std::size_t>(c)]);
      fragment.z = 1.0f + static_cast<float>(i);
      fragment.identity = shading::identityOf(7, static_cast<std::uint32_t>(i));
      fragments_.push_back(fragment);
    }
  }
  explicit Stack(std::vector<Fragment> fragments) : fragments_(std::move(fragments)) {}

  std::vector<MethodLayer> layers() const {
    std::vector<MethodLayer> layers;
    for (const Fragment& fragment : fragments_)
      layers.push_back({glm::dvec3(fragment.radiance),
                        static_cast<double>(fragment.coverage) * (glm::dvec3(1.0) - glm::dvec3(fragment.transmission)),
                        static_cast<double>(fragment.z), &fragment});
    return layers;
  }
  std::vector<Fragment>& fragments() { return fragments_; }

 private:
  std::vector<Fragment> fragments_;
};

inline bool correctsBackground(const StochasticSettings& settings) {
  return settings.variant == StochasticSettings::Variant::alpha ||
         (settings.variant == StochasticSettings::Variant::depth && settings.corrected);
}

// The picture of one pixel.
inline glm::dvec3 sampled(const Stack& stack, const glm::dvec3& background, const StochasticSettings& settings,
                          const MaskTable& masks, glm::ivec2 pixel = {3, 5}) {
  std::vector<MethodLayer> layers = stack.layers();
  const StochasticSums sums = samplePixel(layers, pixel, settings, masks, {});
  const glm::dvec3 shows = correctsBackground(settings) ? sums.beta : sums.empty;
  return stochasticLight(sums, glm::dvec3(1.0) - sums.beta, settings) + shows * background;
}

inline glm::dvec3 sortedOver(const std::vector<reference::StochasticLayer>& layers, const glm::dvec3& background) {
  glm::dvec3 result = background;
  for (std::size_t i = layers.size(); i-- > 0;)
    for (int c = 0; c < 3; ++c)
      result[c] = layers[i].alpha * layers[i].colour[static_cast<std::size_t>(c)] + (1 - layers[i].alpha) * result[c];
  return result;
}

inline std::vector<reference::StochasticLayer> randomStack(Random& random, std::size_t count) {
  std::vector<reference::StochasticLayer> layers;
  for (std::size_t i = 0; i < count; ++i) {
    // Floats, so that our records hold the same numbers.
    const auto unit = [&] { return static_cast<double>(random.uniformf()); };
    layers.push_back({unit(), {unit(), unit(), unit()}});
  }
  return layers;
}

}  // namespace pellucid::test
