// Unbiased where ST10 proves it, consistent where it proves that, the same bits whatever the order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tests/stochastic/sampled_stacks.h"

namespace pellucid {
namespace {

using namespace test;
using Variant = StochasticSettings::Variant;

StochasticSettings settingsOf(Variant variant, int samples, bool corrected = true, bool stratified = true) {
  StochasticSettings settings;
  settings.variant = variant;
  settings.samples = samples;
  settings.corrected = corrected;
  settings.stratified = stratified;
  return settings;
}

const glm::dvec3 kBehind(.3, .6, .9);

TEST(Stochastic, BasicAndUncorrectedDepthAreUnbiased) {
  constexpr int kStacks = 24, kSeeds = 4096;
  // 4 standard errors for one test; with this many, the level that keeps the same chance of a false alarm (Sidak).
  const double kLimit = 5.2;
  Random random(1);
  double worst = 0;
  for (int k = 0; k < kStacks; ++k) {
    const auto layers = randomStack(random, 1 + random.below(8));
    const Stack stack(layers);
    const glm::dvec3 truth = sortedOver(layers, kBehind);
    const int samples = k % 2 ? 8 : 5;
    const MaskTable masks(samples);
    for (const Variant variant : {Variant::basic, Variant::depth})
      for (const bool stratified : {false, true}) {
        StochasticSettings settings = settingsOf(variant, samples, false, stratified);
        glm::dvec3 first(0), second(0);
        for (int seed = 0; seed < kSeeds; ++seed) {
          settings.seed = static_cast<std::uint32_t>(seed);
          const glm::dvec3 value = sampled(stack, kBehind, settings, masks, {k, 2 * k});
          first += value;
          second += value * value;
        }
        first /= kSeeds;
        second = second / static_cast<double>(kSeeds) - first * first;
        for (int c = 0; c < 3; ++c) {
          const double error = std::sqrt(std::max(0.0, second[c]) / kSeeds) + 1e-8;
          worst = std::max(worst, std::abs(first[c] - truth[c]) / error);
          EXPECT_LT(std::abs(first[c] - truth[c]), kLimit * error) << k << " " << c;
        }
      }
  }
  std::printf("mean of %d seeds against over, %d stacks: worst %.2f standard errors\n", kSeeds, kStacks, worst);
}

double rmse(const StochasticSettings& given, int stacks, int seeds) {
  StochasticSettings settings = given;
  const MaskTable masks(settings.samples);
  Random random(2);
  double squares = 0;
  for (int k = 0; k < stacks; ++k) {
    const auto layers = randomStack(random, 6);
    const Stack stack(layers);
    const glm::dvec3 truth = sortedOver(layers, kBehind);
    for (int seed = 0; seed < seeds; ++seed) {
      settings.seed = static_cast<std::uint32_t>(seed);
      const glm::dvec3 d = sampled(stack, kBehind, settings, masks, {k, 0}) - truth;
      squares += glm::dot(d, d) / (3.0 * stacks * seeds);
    }
  }
  return std::sqrt(squares);
}

TEST(Stochastic, NaiveErrorFallsAsTheRootOfSamples) {
  double before = 0;
  for (const int samples : {4, 16, 64, 256, 1024}) {
    const double error = rmse(settingsOf(Variant::basic, samples, false, false), 40, 64);
    const double stratified = rmse(settingsOf(Variant::basic, samples, false, true), 40, 64);
    std::printf("S %4d: basic naive RMSE %.5f, stratified %.5f\n", samples, error, stratified);
    // 2560 x 3 values fix a RMSE to about 1%; the layers of a pixel are correlated, so 5%.
    if (before > 0) {
      EXPECT_NEAR(before / error, 2.0, .1);
    }
    EXPECT_LT(stratified, error);
    before = error;
  }
}

TEST(Stochastic, CorrectedDepthIsConsistent) {
  double before = 1;
  for (const int samples : {8, 64, 1024}) {
    const double error = rmse(settingsOf(Variant::depth, samples), 40, 32);
    std::printf("S %4d: depth corrected RMSE %.5f\n", samples, error);
    EXPECT_LT(error, before / 2);
    before = error;
  }
}

// Fig. 3: the spread of estimated visibility about the true curve, on one random set of blockers.
TEST(Stochastic, VisibilityCurvesTighten) {
  Random random(3);
  std::vector<reference::StochasticLayer> layers = randomStack(random, 12);
  for (auto& layer : layers) layer = {.3 * layer.alpha, {1, 1, 1}};
  // The background seen behind the first k blockers is the visibility there.
  double before = 1;
  for (const int samples : {8, 32, 256, 1024}) {
    const MaskTable masks(samples);
    double widest = 0;
    for (std::size_t k = 1; k <= layers.size(); ++k) {
      std::vector<reference::StochasticLayer> front(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(k));
      for (auto& layer : front) layer.colour = {0, 0, 0};
      const Stack stack(front);
      const double truth = sortedOver(front, glm::dvec3(1.0)).r;
      StochasticSettings settings = settingsOf(Variant::basic, samples);
      double squares = 0;
      for (int seed = 0; seed < 300; ++seed) {
        settings.seed = static_cast<std::uint32_t>(seed);
        const double d = sampled(stack, glm::dvec3(1.0), settings, masks).r - truth;
        squares += d * d / 300;
      }
      widest = std::max(widest, std::sqrt(squares));
    }
    std::printf("S %4d: visibility deviates by at most %.4f along the curve\n", samples, widest);
    EXPECT_LT(widest, before);
    EXPECT_LT(widest, .5 / std::sqrt(samples));  // a coin per sample deviates by sqrt(v (1 - v) / S), at most this
    before = widest;
  }
}

TEST(Stochastic, OrderOfLayersChangesNoBit) {
  Random random(4);
  const MaskTable masks(16);
  for (int k = 0; k < 200; ++k) {
    Stack stack(randomStack(random, 2 + random.below(10)));
    for (Fragment& fragment : stack.fragments())
      if (random.below(3) == 0) fragment.z = 2.0f;  // coincident layers too
    for (const Variant variant : {Variant::basic, Variant::alpha, Variant::depth}) {
      const StochasticSettings settings = settingsOf(variant, 16);
      const glm::dvec3 one = sampled(stack, kBehind, settings, masks);
      Stack shuffled = stack;
      for (std::size_t i = shuffled.fragments().size(); i-- > 1;)
        std::swap(shuffled.fragments()[i], shuffled.fragments()[random.below(static_cast<std::uint32_t>(i + 1))]);
      const glm::dvec3 other = sampled(shuffled, kBehind, settings, masks);
      EXPECT_EQ(0, std::memcmp(&one, &other, sizeof one)) << k;
    }
  }
}

TEST(Stochastic, PassesShareOneSetOfMasks) {
  // Eight passes of one sample are the eight samples of one pass.
  Random random(5);
  const MaskTable masks(8);
  for (int k = 0; k < 50; ++k) {
    const Stack stack(randomStack(random, 5));
    for (const Variant variant : {Variant::basic, Variant::alpha, Variant::depth}) {
      const StochasticSettings settings = settingsOf(variant, 8);
      StochasticSums sum;
      sum.empty = glm::dvec3(0.0);
      std::vector<MethodLayer> layers = stack.layers();
      for (int pass = 0; pass < 8; ++pass) {
        const StochasticSums part = samplePixel(layers, {1, 2}, settings, masks, {pass, 8});
        sum.light += part.light / 8.0;
        sum.unit += part.unit / 8.0;
        sum.empty += part.empty / 8.0;
      }
      const StochasticSums whole = samplePixel(layers, {1, 2}, settings, masks, {});
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum.light[c], whole.light[c], 1e-12);
        EXPECT_NEAR(sum.unit[c], whole.unit[c], 1e-12);
        EXPECT_NEAR(sum.empty[c], whole.empty[c], 1e-12);
      }
    }
  }
}

Fragment glass(glm::vec3 transmission, float z, std::uint32_t identity) {
  Fragment fragment{};
  fragment.coverage = 1.0f;
  fragment.transmission = transmission;
  fragment.z = z;
  fragment.identity = shading::hashOf(identity);
  return fragment;
}

TEST(Stochastic, GreyStaysGreyAndColouredGlassNests) {
  const MaskTable masks(8);
  for (std::uint32_t seed = 0; seed < 500; ++seed)
    for (const bool stratified : {false, true}) {
      StochasticSettings settings = settingsOf(Variant::basic, 8, false, stratified);
      settings.seed = seed;
      const Stack grey({glass(glm::vec3(.3f), 1, 1), glass(glm::vec3(.6f), 2, 2)});
      const glm::dvec3 g = sampled(grey, glm::dvec3(1.0), settings, masks);
      EXPECT_EQ(g.r, g.g);
      EXPECT_EQ(g.g, g.b);
      // One xi for three channels: where red is let through least, no other channel is let through less.
      const Stack red({glass({.9f, .5f, .1f}, 1, 1)});
      const glm::dvec3 r = sampled(red, glm::dvec3(1.0), settings, masks);
      EXPECT_GE(r.r, r.g);
      EXPECT_GE(r.g, r.b);
    }
}

TEST(Stochastic, LightThatHidesNothingIsNotLost) {
  // An additive flame behind a pane, and one whose opacity is below any coin.
  const MaskTable masks(8);
  Fragment flame{}, faint{};
  flame.radiance = faint.radiance = glm::vec3(.5f);
  flame.z = faint.z = 2;
  faint.coverage = 1e-12f;
  const Stack stacks[] = {Stack({glass(glm::vec3(.5f), 1, 1), flame}), Stack({glass(glm::vec3(.5f), 1, 1), faint})};
  for (const Stack& stack : stacks)
    for (const Variant variant : {Variant::basic, Variant::alpha, Variant::depth}) {
      StochasticSettings settings = settingsOf(variant, 8);
      glm::dvec3 mean(0);
      for (std::uint32_t seed = 0; seed < 64; ++seed) {
        settings.seed = seed;
        mean += sampled(stack, glm::dvec3(0.0), settings, masks) / 64.0;
      }
      EXPECT_NEAR(mean.r, .25, 1e-6);  // half of 8 samples, always
    }
}

TEST(Stochastic, ExtremesStayFinite) {
  const MaskTable masks(4);
  std::vector<Fragment> fragments;
  for (int i = 0; i < 20000; ++i) {
    Fragment fragment =
        glass(glm::vec3(i % 3 ? .999f : 0.0f), 1.0f + static_cast<float>(i % 7) * 1e-3f, static_cast<std::uint32_t>(i));
    fragment.coverage = i % 5 ? 1e-7f : .9999999f;
    fragment.radiance = glm::vec3(i % 11 ? 1e-20f : 65504.0f);
    fragments.push_back(fragment);
  }
  for (const Variant variant : {Variant::basic, Variant::alpha, Variant::depth}) {
    const glm::dvec3 value = sampled(Stack(fragments), kBehind, settingsOf(variant, 4), masks);
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(value[c]));
      EXPECT_GE(value[c], 0.0);
    }
  }
}

}  // namespace
}  // namespace pellucid
