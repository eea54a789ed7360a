// Sets of stochastic samples of one pixel, averaged until their standard error is low enough.
#pragma once
#include "composite/methods/stochastic.h"

namespace pellucid {

// As StochasticSettings::adaptive says; whoever draws the sets gives each a seed of its own, see seedOfSet().
class AdaptiveSamples {
 public:
  //   first  set, and what all sets share: the exact net transmission
  //   step   passes whose mean is taken
  AdaptiveSamples(const StochasticSums& first, const StochasticSettings& settings, int step);
  // Whether another set is needed.
  bool wantsMore() const;
  void add(const StochasticSums& next);
  int taken() const { return taken_; }
  StochasticSums mean() const;

 private:
  void noisy(const StochasticSums& sums, glm::dvec3 (&values)[2]) const;

  const StochasticSettings* settings_;
  int step_, taken_ = 1;
  glm::dvec3 hidden_;
  StochasticSums sum_;
  glm::dvec3 first_[2], sums_[2] = {glm::dvec3(0.0), glm::dvec3(0.0)}, squares_[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
};

//   number  of the set, from 0, which keeps the seed
std::uint32_t seedOfSet(std::uint32_t seed, int number);

}  // namespace pellucid
