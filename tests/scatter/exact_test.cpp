// The `exact` fold: no order changes a bit, and every sum is the true one. Whole scenes: samples_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr shading::WeightSettings kPowerWeight{shading::PLD_WEIGHT_POWER, 0.1f, 1000.0f, 3.0f, 1.0f};

const Image<glm::vec4>* const* sumsOf(const OitPlanes& planes, const Image<glm::vec4>* (&list)[7]) {
  list[0] = &planes.radiance, list[1] = &planes.weight, list[2] = &planes.opacity, list[3] = &planes.depth;
  list[4] = &planes.light, list[5] = &planes.refraction, list[6] = &planes.solid;
  return list;
}

std::size_t differingWords(const OitPlanes& a, const OitPlanes& b) {
  const Image<glm::vec4>*left[7], *right[7];
  sumsOf(a, left), sumsOf(b, right);
  std::size_t words = 0;
  for (int k = 0; k < 7; ++k) {
    if (left[k]->size() != right[k]->size()) return SIZE_MAX;
    for (std::size_t i = 0; i < left[k]->size(); ++i)
      for (int c = 0; c < 4; ++c) {
        const float x = (*left[k])[i][c], y = (*right[k])[i][c];
        words += std::memcmp(&x, &y, sizeof x) != 0;
      }
  }
  for (std::size_t i = 0; i < a.frontZ.size(); ++i) words += a.frontZ[i] != b.frontZ[i];
  for (std::size_t i = 0; i < a.diffuseZ.size(); ++i) words += a.diffuseZ[i] != b.diffuseZ[i];
  return words;
}

// Terms of one pixel, added in list order, in long double: written here from the terms alone.
void longDoubleSums(const std::vector<Fragment>& fragments, long double (&sums)[6][4]) {
  std::fill(&sums[0][0], &sums[0][0] + 24, 0.0L);
  for (const Fragment& fragment : fragments) {
    shading::Layer layer;
    layer.radiance = fragment.radiance;
    layer.coverage = fragment.coverage;
    layer.transmission = fragment.transmission;
    layer.z = fragment.z;
    shading::Scatter scatter;
    scatter.offset = fragment.offset;
    scatter.variance = fragment.variance;
    const shading::OitTargets t =
        shading::packSums(shading::layerSums(layer, kPowerWeight, shading::PLD_NORMALISE_SPECTRAL));
    const shading::ScatterTargets s = shading::packScatter(layer, scatter);
    for (int c = 0; c < 4; ++c) {
      sums[0][c] += static_cast<long double>(t.radiance[c]);
      sums[1][c] += static_cast<long double>(t.weight[c]);
      sums[2][c] += static_cast<long double>(t.opacity[c]);
      sums[3][c] += static_cast<long double>(t.depth[c]);
      sums[4][c] += static_cast<long double>(t.light[c]);
      sums[5][c] += static_cast<long double>(s.refraction[c]);
    }
    sums[4][3] += static_cast<long double>(s.refractionZ);
  }
}

// |x|^-3 over four decades of depth: twelve decades of weight. Coplanar, duplicated and scattering layers among them.
std::vector<Fragment> stack(Random& random) {
  std::vector<Fragment> layers;
  const std::uint32_t count = 1 + random.below(200);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!layers.empty() && random.below(5) == 0) {
      layers.push_back(layers[random.below(static_cast<std::uint32_t>(layers.size()))]);
      continue;
    }
    Fragment fragment{};
    fragment.coverage = random.below(8) ? random.uniformf() : 0.0f;
    fragment.transmission = glm::vec3(random.uniformf(), random.uniformf(), random.below(4) ? random.uniformf() : 1.0f);
    fragment.radiance = glm::vec3(random.uniformf(), 100 * random.uniformf(), 1e-3f * random.uniformf());
    fragment.z = random.below(6) ? static_cast<float>(std::pow(10.0, random.between(-2, 2))) : 1.0f;
    if (random.below(3) == 0) fragment.offset = glm::vec2(50 * random.uniformf(), 5 + random.uniformf());
    if (random.below(3) == 0) fragment.variance = 100 * random.uniformf();
    fragment.identity = random.below(1000);
    layers.push_back(fragment);
  }
  return layers;
}

FragmentLists listsOf(const std::vector<std::vector<Fragment>>& pixels) {
  FragmentLists lists;
  lists.window = {0, 0, static_cast<int>(pixels.size()), 1};
  lists.solid = Image<glm::vec4>(lists.window.width(), 1, glm::vec4(0, 0, 0, kSky));
  lists.offsets = {0};
  for (const auto& pixel : pixels) {
    lists.fragments.insert(lists.fragments.end(), pixel.begin(), pixel.end());
    lists.offsets.push_back(lists.fragments.size());
  }
  return lists;
}

template <class Fold>
OitPlanes foldedBy(Fold fold, const std::vector<std::vector<Fragment>>& pixels) {
  const FragmentLists lists = listsOf(pixels);
  OitPlanes planes = emptyPlanes(lists.window, lists.window);
  fold(lists, kPowerWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
  return planes;
}

TEST(Exact, RandomStacksOverTwelveDecadesOfWeight) {
  Random random(31);
  std::vector<std::vector<Fragment>> pixels;
  for (int i = 0; i < 200; ++i) pixels.push_back(stack(random));
  const OitPlanes exact = foldedBy(foldExact, pixels), floats = foldedBy(foldFragments, pixels);

  double worst[2] = {0, 0};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    long double truth[6][4];
    longDoubleSums(pixels[i], truth);
    for (const bool isExact : {true, false}) {
      const Image<glm::vec4>* planes[7];
      sumsOf(isExact ? exact : floats, planes);
      for (int k = 0; k < 6; ++k)
        for (int c = 0; c < 4; ++c) {
          if (truth[k][c] == 0.0L) continue;
          const long double error = std::abs(static_cast<long double>((*planes[k])[i][c]) / truth[k][c] - 1.0L);
          worst[isExact ? 0 : 1] = std::max(worst[isExact ? 0 : 1], static_cast<double>(error));
        }
    }
  }
  EXPECT_LE(worst[0], 1e-6);

  std::size_t exactWords = 0, floatWords = 0;
  for (int turn = 0; turn < 20; ++turn) {
    for (auto& pixel : pixels)
      for (std::size_t i = pixel.size(); i > 1; --i)
        std::swap(pixel[i - 1], pixel[random.below(static_cast<std::uint32_t>(i))]);
    exactWords += differingWords(exact, foldedBy(foldExact, pixels));
    floatWords += differingWords(floats, foldedBy(foldFragments, pixels));
  }
  EXPECT_EQ(exactWords, 0u);
  std::printf(
      "200 stacks, 20 shuffles: words that change, exact %zu, float %zu; largest error against long double, exact "
      "%.2g, float %.2g\n",
      exactWords, floatWords, worst[0], worst[1]);
}

}  // namespace
}  // namespace pellucid::test
