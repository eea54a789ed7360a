// --weight auto: the weight that errs least against the sorted truth, found on probe pixels.
#pragma once
#include <string>
#include <vector>

#include "composite/methods/method.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// Pixels spread evenly over the picture, one from each cell of a grid: their lists and what lies behind them.
class WeightProbes {
 public:
  //   most  probes kept, about
  WeightProbes(const GBuffer& gbuffer, std::size_t most);
  void add(const FragmentLists& tile);
  std::size_t count() const { return backgrounds_.size(); }
  int cell() const { return cell_; }  // edge in pixels; see shaders/shared/probe.glsl

 private:
  friend struct WeightFitter;
  const GBuffer& gbuffer_;
  int cell_;
  std::vector<std::vector<Fragment>> fragments_;
  std::vector<glm::vec4> solids_;
  std::vector<glm::vec3> backgrounds_;
};

struct WeightFit {
  shading::WeightSettings weight;
  double meanError = 0;  // on the probes, of the chosen weight
  std::size_t probes = 0;
  std::vector<std::pair<std::string, double>> tried;  // weight and mean error on the probes, the best first
};

// Tries every listed weight, powers of depth, and for eqs. 5 and 10 ranges that the probes' depths suggest; then
// refines the power. No probe with layers: the weight given.
//   given  range and kind that count when nothing can be learnt
WeightFit fitWeight(const WeightProbes& probes, const shading::WeightSettings& given, int normalisation);

}  // namespace pellucid
