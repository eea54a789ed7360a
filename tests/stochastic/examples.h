// ST10's examples, and what its authors measured.
#pragma once
#include "tests/stochastic/sampled_stacks.h"

namespace pellucid::test {

using reference::Estimator;
using reference::Moments;
using Variant = StochasticSettings::Variant;

inline constexpr int kSamples = 4, kSeeds = 40000;

struct Row {
  const char* label;
  int example;
  bool stratified;
  Estimator estimator;
  const char* paper;
  const char* reason;  // why the paper's figure differs from enumeration, empty where it does not
};

inline const char* const kNaiveOne = "the paper's .35 is the deviation of one sample; of four it is half";
inline const char* const kEqual = "corrected shares of two layers sum to a constant: their errors are equal";
inline const char* const kRounded = "enumeration gives .155, .158";
inline const Row kRows[] = {
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

inline std::vector<reference::StochasticLayer> exampleLayers(int example) {
  if (example == 1) return {{.45f, {1, 0, 0}}, {.45f, {0, 1, 0}}};
  return std::vector<reference::StochasticLayer>(4, {.25, {1, 1, 1}});
}

inline StochasticSettings settingsOf(Estimator estimator, bool stratified) {
  StochasticSettings settings;
  settings.samples = kSamples;
  settings.stratified = stratified;
  settings.variant = estimator == Estimator::basic   ? Variant::basic
                     : estimator == Estimator::alpha ? Variant::alpha
                                                     : Variant::depth;
  settings.corrected = estimator != Estimator::depth;
  return settings;
}

inline reference::Rgb behindExample(int example) {
  return example == 1 ? reference::Rgb{0, 0, 1} : reference::Rgb{.25, .25, .25};
}

}  // namespace pellucid::test
