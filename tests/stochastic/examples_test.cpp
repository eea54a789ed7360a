// ST10's own examples against exact enumeration, the paper's figures beside them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/stochastic/examples.h"

namespace pellucid {
namespace {

using namespace test;

// Moments of our sampler over kSeeds seeds.
Moments measured(const Stack& stack, const glm::dvec3& background, StochasticSettings settings, double fourth[3]) {
  const MaskTable masks(settings.samples);
  glm::dvec3 first(0), second(0);
  std::vector<glm::dvec3> values;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint32_t>(seed);
    values.push_back(sampled(stack, background, settings, masks));
    first += values.back();
  }
  first /= kSeeds;
  Moments moments;
  for (int c = 0; c < 3; ++c) {
    fourth[c] = 0;
    for (const glm::dvec3& value : values) {
      const double d = value[c] - first[c];
      second[c] += d * d / kSeeds;
      fourth[c] += d * d * d * d / kSeeds;
    }
    moments.mean[static_cast<std::size_t>(c)] = first[c];
    moments.deviation[static_cast<std::size_t>(c)] = std::sqrt(second[c]);
  }
  return moments;
}

TEST(Examples, DeviationsMatchEnumerationWithinThreeStandardErrors) {
  std::printf("S = %d, %d seeds\n%-20s %-20s %-20s %s\n", kSamples, kSeeds, "example", "enumerated", "ours", "paper");
  for (const Row& row : kRows) {
    const auto layers = exampleLayers(row.example);
    const reference::Rgb behind = behindExample(row.example);
    const Moments exact = reference::enumerate(layers, behind, kSamples, row.stratified, row.estimator);
    double fourth[3];
    const Moments ours =
        measured(Stack(layers), {behind[0], behind[1], behind[2]}, settingsOf(row.estimator, row.stratified), fourth);
    std::printf("%-20s (%.3f, %.3f, %.3f) (%.3f, %.3f, %.3f) %s %s\n", row.label, exact.deviation[0],
                exact.deviation[1], exact.deviation[2], ours.deviation[0], ours.deviation[1], ours.deviation[2],
                row.paper, row.reason);
    for (std::size_t c = 0; c < 3; ++c) {
      const double variance = exact.deviation[c] * exact.deviation[c];
      // Standard errors of a mean and of a variance; 1e-7 is float rounding of the records.
      EXPECT_NEAR(ours.mean[c], exact.mean[c], 3 * exact.deviation[c] / std::sqrt(kSeeds) + 1e-7) << row.label << c;
      const double error = std::sqrt(std::max(0.0, fourth[c] - variance * variance) / kSeeds);
      EXPECT_NEAR(ours.deviation[c] * ours.deviation[c], variance, 3 * error + 1e-7) << row.label << c;
    }
  }
}

TEST(Examples, BiasOfAlphaCorrection) {
  // Section 4.1: two layers of 1/S.
  const std::vector<reference::StochasticLayer> two{{.25, {1, 0, 0}}, {.25, {0, 1, 0}}};
  const Moments exact = reference::enumerate(two, {0, 0, 0}, kSamples, true, Estimator::alpha);
  EXPECT_NEAR(exact.mean[0], .273, .0005);
  EXPECT_NEAR(exact.mean[1], .164, .0005);
  double fourth[3];
  const Moments ours = measured(Stack(two), glm::dvec3(0.0), settingsOf(Estimator::alpha, true), fourth);
  std::printf(
      "bias: E(A) = (%.4f, %.4f, %.4f), enumerated (%.4f, %.4f, 0), paper (.273, .164, 0), true (.25, .1875, 0)\n",
      ours.mean[0], ours.mean[1], ours.mean[2], exact.mean[0], exact.mean[1]);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(ours.mean[c], exact.mean[c], 3 * exact.deviation[c] / std::sqrt(kSeeds) + 1e-7);

  // One layer of 1/(2S): half the pixels are empty, and nothing is there to scale.
  const std::vector<reference::StochasticLayer> thin{{.125, {1, 1, 1}}};
  const Moments half = measured(Stack(thin), glm::dvec3(0.0), settingsOf(Estimator::alpha, true), fourth);
  std::printf("bias: alpha = 1/(2S) = .125: E(A) = %.4f, paper alpha / 2 = .0625\n", half.mean[0]);
  EXPECT_NEAR(half.mean[0], .0625, 3 * .0625 / std::sqrt(kSeeds) + 1e-7);
}

}  // namespace
}  // namespace pellucid
