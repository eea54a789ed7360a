// --weight auto: the weight that errs least against the sorted truth, found on probe pixels.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gbuffer/fragments.h"
#include "shaders/weights.h"

namespace pellucid {

// Of the layers that are weighed, planar metres: what the fit tries is told by them alone, so that it finds the same in
// any unit.
struct WeighedDepths {
  float nearest = 0.0f, middle = 0.0f, farthest = 0.0f;
};
// Nothing where there is no layer.
WeighedDepths depthsOf(const FragmentLists& lists);

// Mean error of the picture that a weight draws.
using WeightError = std::function<double(const shading::WeightSettings& weight)>;

struct WeightFit {
  shading::WeightSettings weight{};
  double meanError = 0;                               // on the probes, of the chosen weight
  std::vector<std::pair<std::string, double>> tried;  // weight and mean error on all probes, the best first
};

// Tries every weight of the table as --weight asks for it; then ranges, parameters and units that the depths suggest,
// on some probes; then the best of those on all, and what lies around them. No layer: the weight given.
//   given   the range, and the reference of powers
//   rough   error on some probes
//   whole   error on all of them
//   least   what the picture's roundings are: a weight that gains no more over the table's first one is not taken, so
//           that roundings choose nothing
WeightFit fitWeight(const shading::WeightSettings& given, const WeighedDepths& depths, const WeightError& rough,
                    const WeightError& whole, double least = 0.0);

}  // namespace pellucid
