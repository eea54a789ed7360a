#include "composite/methods/adaptive_samples.h"

#include <algorithm>
#include <cmath>

#include "shaders/stochastic_mask.h"

namespace pellucid {
namespace {

using glm::dvec3;

constexpr int kLeastSets = 4;  // that a variance is estimated from

}  // namespace

AdaptiveSamples::AdaptiveSamples(const StochasticSums& first, const StochasticSettings& settings, int step)
    : settings_(&settings), step_(step), hidden_(dvec3(1.0) - first.beta), sum_(first) {
  noisy(first, first_);
}

// The light, and where nothing scales it the share of the background that shows.
void AdaptiveSamples::noisy(const StochasticSums& sums, dvec3 (&values)[2]) const {
  values[0] = stochasticLight(sums, hidden_, *settings_);
  const bool scaled = isCorrected(*settings_) || settings_->variant == StochasticSettings::Variant::depth;
  values[1] = scaled ? dvec3(0.0) : sums.empty;
}

bool AdaptiveSamples::wantsMore() const {
  if (taken_ >= StochasticSettings::kMostSamples / settings_->samples) return false;
  if (taken_ < kLeastSets) return true;
  for (int v = 0; v < 2; ++v)
    for (int c = 0; c < 3; ++c) {
      const double variance = std::max(squares_[v][c] - sums_[v][c] * sums_[v][c] / taken_, 0.0) / (taken_ - 1);
      const double wanted = settings_->adaptive * std::max(1.0, std::abs(first_[v][c] + sums_[v][c] / taken_));
      // Of the mean of `step_` passes.
      if (!(variance <= wanted * wanted * taken_ * step_)) return true;
    }
  return false;
}

void AdaptiveSamples::add(const StochasticSums& next) {
  dvec3 value[2];
  noisy(next, value);
  for (int v = 0; v < 2; ++v) {
    const dvec3 apart = value[v] - first_[v];  // so that nothing cancels
    sums_[v] += apart;
    squares_[v] += apart * apart;
  }
  sum_.light += next.light;
  sum_.unit += next.unit;
  sum_.added += next.added;
  sum_.empty += next.empty;
  ++taken_;
}

StochasticSums AdaptiveSamples::mean() const {
  StochasticSums mean = sum_;
  const double part = 1.0 / taken_;
  mean.light *= part;
  mean.unit *= part;
  mean.added *= part;
  mean.empty *= part;
  return mean;
}

std::uint32_t seedOfSet(std::uint32_t seed, int number) {
  return number == 0 ? seed : shading::hashOf(seed ^ shading::hashOf(static_cast<std::uint32_t>(number)));
}

}  // namespace pellucid
