// Stochastic transparency by enumeration of every mask of every layer: exact mean and deviation of the estimators of
// ST10 sections 3.1, 3.3 and 3.4. Doubles, and nothing shared with the code under test.
#pragma once
#include <array>
#include <vector>

namespace pellucid::reference {

using Rgb = std::array<double, 3>;

struct StochasticLayer {
  double alpha;
  Rgb colour;  // not premultiplied
};

enum class Estimator { basic, alpha, depth, depthCorrected };

struct Moments {
  Rgb mean{}, deviation{};
};

// Layers nearest first, no two at one depth. Cost grows as 2^(samples * layers).
//   stratified  every layer covers floor(alpha S + xi) samples, all subsets alike; otherwise a coin per sample
Moments enumerate(const std::vector<StochasticLayer>& layers, const Rgb& background, int samples, bool stratified,
                  Estimator estimator);

}  // namespace pellucid::reference
