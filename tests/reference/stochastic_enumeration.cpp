#include "tests/reference/stochastic_enumeration.h"

#include <bit>
#include <cmath>

namespace pellucid::reference {
namespace {

double choose(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

double maskProbability(unsigned mask, double alpha, int samples, bool stratified) {
  const int covered = std::popcount(mask);
  if (!stratified) return std::pow(alpha, covered) * std::pow(1 - alpha, samples - covered);
  const int least = static_cast<int>(std::floor(alpha * samples));
  const double more = alpha * samples - least;
  const double p = covered == least ? 1 - more : covered == least + 1 ? more : 0;
  return p / choose(samples, covered);
}

Rgb estimate(const std::vector<StochasticLayer>& layers, const std::vector<unsigned>& masks, const Rgb& background,
             int samples, Estimator estimator) {
  const bool byDepth = estimator == Estimator::depth || estimator == Estimator::depthCorrected;
  Rgb light{};
  double unit = 0, empty = 0, passed = 1;
  for (const StochasticLayer& layer : layers) passed *= 1 - layer.alpha;
  for (int s = 0; s < samples; ++s) {
    bool open = true;
    for (std::size_t i = 0; i < layers.size() && open; ++i) {
      const bool covers = (masks[i] >> s & 1u) != 0;
      const double share = byDepth ? layers[i].alpha : covers ? 1.0 : 0.0;
      for (std::size_t c = 0; c < 3; ++c) light[c] += share * layers[i].colour[c] / samples;
      unit += share / samples;
      open = !covers;
    }
    if (open) empty += 1.0 / samples;
  }
  const bool corrected = estimator == Estimator::alpha || estimator == Estimator::depthCorrected;
  Rgb result{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double shown = corrected ? (unit > 0 ? (1 - passed) * light[c] / unit : 0.0) : light[c];
    result[c] = shown + (corrected ? passed : empty) * background[c];
  }
  return result;
}

}  // namespace

Moments enumerate(const std::vector<StochasticLayer>& layers, const Rgb& background, int samples, bool stratified,
                  Estimator estimator) {
  Rgb first{}, second{};
  std::vector<unsigned> masks(layers.size(), 0);
  const unsigned all = 1u << samples;
  for (bool done = false; !done;) {
    double p = 1;
    for (std::size_t i = 0; i < layers.size(); ++i)
      p *= maskProbability(masks[i], layers[i].alpha, samples, stratified);
    if (p > 0) {
      const Rgb value = estimate(layers, masks, background, samples, estimator);
      for (std::size_t c = 0; c < 3; ++c) {
        first[c] += p * value[c];
        second[c] += p * value[c] * value[c];
      }
    }
    std::size_t i = 0;
    while (i < masks.size() && ++masks[i] == all) masks[i++] = 0;
    done = i == masks.size();
  }
  Moments moments;
  moments.mean = first;
  for (std::size_t c = 0; c < 3; ++c) moments.deviation[c] = std::sqrt(std::max(0.0, second[c] - first[c] * first[c]));
  return moments;
}

}  // namespace pellucid::reference
