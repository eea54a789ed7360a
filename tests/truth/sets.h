// The five sets of random pixels on which methods are ranked, as fragment lists of a square of pixels.
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gbuffer/fragments.h"
#include "tests/support/random.h"

namespace pellucid::test {

inline Fragment layerAt(Random& random, double z, double alpha, bool coloured) {
  Fragment fragment{};
  fragment.coverage = static_cast<float>(alpha);
  for (int c = 0; c < 3; ++c) {
    fragment.radiance[c] = static_cast<float>(alpha * random.uniform());
    fragment.transmission[c] = coloured ? random.uniformf() : 0.0f;
  }
  fragment.z = static_cast<float>(z);
  fragment.identity = static_cast<std::uint32_t>(random.bits());
  return fragment;
}

// A: 1-4 layers over 1-50 m. B: 8 layers inside 0.5 m. C: 64 layers of smoke, which darkens as it recedes. D: alpha .99
// in front of others. E: clusters at 2, 30 and 60 m.
inline std::vector<Fragment> pixelOfSet(char set, Random& random, bool coloured) {
  std::vector<Fragment> layers;
  if (set == 'A') {
    const std::uint32_t count = 1 + random.below(4);
    for (std::uint32_t i = 0; i < count; ++i)
      layers.push_back(layerAt(random, random.between(1, 50), random.between(.1, .9), coloured));
  } else if (set == 'B') {
    const double start = random.between(2, 20);
    for (int i = 0; i < 8; ++i)
      layers.push_back(layerAt(random, start + random.between(0, .5), random.between(.1, .9), coloured));
  } else if (set == 'C') {
    const double nearest = random.between(5, 10), depth = random.between(20, 40);
    for (int i = 0; i < 64; ++i) {
      const double t = random.uniform();
      Fragment fragment = layerAt(random, nearest + depth * t, random.between(.02, .12), coloured);
      fragment.radiance = glm::vec3(fragment.coverage * static_cast<float>(1.0 - t));
      layers.push_back(fragment);
    }
  } else if (set == 'D') {
    layers.push_back(layerAt(random, random.between(1, 3), .99, coloured));
    for (int i = 0; i < 4; ++i)
      layers.push_back(layerAt(random, random.between(4, 50), random.between(.3, .9), coloured));
  } else {
    for (const double centre : {2.0, 30.0, 60.0})
      for (std::uint32_t i = 0; i < 2; ++i)
        layers.push_back(layerAt(random, centre + random.between(-.5, .5), random.between(.3, .7), coloured));
  }
  for (std::size_t i = layers.size(); i > 1; --i)
    std::swap(layers[i - 1], layers[random.below(static_cast<std::uint32_t>(i))]);
  return layers;
}

inline FragmentLists listsOf(const std::vector<std::vector<Fragment>>& pixels) {
  FragmentLists lists;
  lists.window = {0, 0, static_cast<int>(pixels.size()), 1};
  lists.offsets.assign(1, 0);
  for (const auto& pixel : pixels) {
    lists.fragments.insert(lists.fragments.end(), pixel.begin(), pixel.end());
    lists.offsets.push_back(lists.fragments.size());
  }
  lists.solid = Image<glm::vec4>(lists.window.width(), 1, glm::vec4(0, 0, 0, std::numeric_limits<float>::infinity()));
  return lists;
}

inline FragmentLists listsOfSet(char set, int pixels, bool coloured, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::vector<Fragment>> all(static_cast<std::size_t>(pixels));
  for (auto& pixel : all) pixel = pixelOfSet(set, random, coloured);
  return listsOf(all);
}

}  // namespace pellucid::test
