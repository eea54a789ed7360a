// ST10's own examples against exact enumeration, the paper's figures beside them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/stochastic/stacks.h"

namespace pellucid {
namespace {

using namespace test;
using reference::Estimator;
using reference::Moments;
using Variant = StochasticSettings::Variant;

constexpr int kSamples = 4, kSeeds = 40000;

struct Row {
  const char* label;
  int example;
  bool stratified;
  Estimator estimator;
  const char* paper;
  const char* reason;  // why the paper's figure differs from enumeration, empty where it does not
};

const char* const kNaiveOne = "the paper's .35 is the deviation of one sample; of four it is half";
const char* const kEqual = "corrected shares of two layers sum to a constant: their errors are equal";
const char* const kRounded = "enumeration gives .155, .158";
const Row kRows[] = {
    {"1 basic naive", 1, false, Estimator::basic, "(.25, .21, .23)", ""},
    {"1 basic stratified", 1, true, Estimator::basic, "(.10, .17, .18)", kRounded},
    {"1 alpha stratified", 1, true, Estimator::alpha, "(.17, .14, .0)", kEqual},
    {"1 depth", 1, true, Estimator::depth, "(.0, .05, .18)", kRounded},
    {"1 depth corrected", 1, true, Estimator::depthCorrected, "(.14, .12, .0)", kEqual},
    {"2 basic naive", 2, false, Estimator::basic, ".35", kNaiveOne},
    {"2 basic stratified", 2, true, Estimator::basic, ".12", ""},
    {"2 alpha stratified", 2, true, Estimator::alpha, ".0", ""},
    {"2 depth", 2, true, Estimator::depth, ".08", ""},
    {"2 depth corrected", 2, true, Estimator::depthCorrected, ".0", ""},
};

std::vector<reference::StochasticLayer> exampleLayers(int example) {
  if (example == 1) return {{.45f, {1, 0, 0}}, {.45f, {0, 1, 0}}};
  return std::vector<reference::StochasticLayer>(4, {.25, {1, 1, 1}});
}

StochasticSettings settingsOf(Estimator estimator, bool stratified) {
  StochasticSettings settings;
  settings.samples = kSamples;
  settings.stratified = stratified;
  settings.variant = estimator == Estimator::basic   ? Variant::basic
                     : estimator == Estimator::alpha ? Variant::alpha
                                                     : Variant::depth;
  settings.corrected = estimator != Estimator::depth;
  return settings;
}

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
    const reference::Rgb behind = row.example == 1 ? reference::Rgb{0, 0, 1} : reference::Rgb{.25, .25, .25};
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
