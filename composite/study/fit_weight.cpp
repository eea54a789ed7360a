#include "composite/study/fit_weight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

constexpr std::size_t kKept = 6;     // of the rough tries
constexpr std::size_t kRefined = 3;  // of those, one of a kind

struct Try {
  shading::WeightSettings weight;
  double error = 0.0;
};

bool isBetter(const Try& a, const Try& b) {
  return a.error < b.error;
}

// As --weight asks for it.
shading::WeightSettings listed(const DepthWeight& row, const shading::WeightSettings& given, float parameter) {
  shading::WeightSettings weight = given;
  weight.kind = row.kind;
  weight.exponent = row.parameter ? parameter : given.exponent;
  if (row.reference != WeightReference::depth) weight.reference = 1.0f;
  return weight;
}

// The listed weights; of those with a parameter the whole numbers that a user would name.
void listRow(const DepthWeight& row, const shading::WeightSettings& given, std::vector<shading::WeightSettings>& all) {
  if (!row.parameter || row.perMetre) {
    all.push_back(listed(row, given, 0.01f));  // of WB13 figure 11
    return;
  }
  for (const float parameter : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 8.0f, 10.0f, 12.0f, 16.0f, 24.0f, 32.0f})
    if (parameter >= row.least && parameter <= row.fitMost) all.push_back(listed(row, given, parameter));
}

// Ranges, parameters and units as far as the depths reach.
void varyRow(const DepthWeight& row, const shading::WeightSettings& given, const WeighedDepths& depths,
             std::vector<shading::WeightSettings>& all) {
  shading::WeightSettings weight = listed(row, given, 1.0f);
  if (row.readsRange)
    for (const float nearShare : {0.25f, 0.5f, 0.9f})
      for (const float farShare : {1.1f, 4.0f, 100.0f}) {
        weight.rangeNear = depths.nearest * nearShare;
        weight.rangeFar = depths.farthest * farShare;
        all.push_back(weight);
      }
  if (row.perMetre)
    for (const float knee : {0.25f, 0.5f, 0.7f, 1.0f, 1.4f, 2.0f, 4.0f}) {
      weight.exponent = knee / depths.middle;
      all.push_back(weight);
    }
  else if (row.reference == WeightReference::unit)
    for (const float units : {0.5f, 4.0f, 30.0f, 100.0f, 200.0f}) {
      weight.reference = depths.middle / units;
      all.push_back(weight);
    }
  else if (row.parameter)
    for (const float parameter : {0.25f, 0.5f, 1.5f, 7.0f, 20.0f, 28.0f}) {
      weight.exponent = std::clamp(parameter, row.least, row.fitMost);
      all.push_back(weight);
    }
}

// The number of a weight that is fitted closely; null where it has none.
float* numberOf(shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  if (row->parameter) return &weight.exponent;
  if (row->readsRange) return &weight.rangeFar;
  return row->reference == WeightReference::unit ? &weight.reference : nullptr;
}

class Fitter {
 public:
  explicit Fitter(const WeightError& whole, WeightFit& fit) : whole_(whole), fit_(fit) {}

  Try attempt(const shading::WeightSettings& weight) {
    const Try made{weight, whole_(weight)};
    fit_.tried.emplace_back(weightText(weight), made.error);
    if (fit_.tried.size() == 1 || made.error < fit_.meanError) {
      fit_.meanError = made.error;
      fit_.weight = weight;
    }
    return made;
  }

  // Steps around the number on some probes, each half as long as the one before; where they end is tried on all.
  void refine(const shading::WeightSettings& from, const WeightError& rough) {
    Try best{from, 0.0};
    if (!numberOf(best.weight)) return;
    const DepthWeight* row = depthWeightOf(best.weight.kind);
    best.error = rough(best.weight);
    bool moved = false;
    for (float step = 0.32f; step > 0.005f; step *= 0.5f) {
      const Try centre = best;
      for (const float factor : {1.0f / (1.0f + step), 1.0f + step}) {
        Try other = centre;
        float& number = *numberOf(other.weight);
        number *= factor;
        if (row->parameter && !row->perMetre) number = std::clamp(number, row->least, row->fitMost);
        if (row->readsRange && !(other.weight.rangeFar > other.weight.rangeNear)) continue;
        other.error = rough(other.weight);
        if (!isBetter(other, best)) continue;
        best = other;
        moved = true;
      }
    }
    if (moved) attempt(best.weight);
  }

 private:
  const WeightError& whole_;
  WeightFit& fit_;
};

std::vector<Try> tried(const std::vector<shading::WeightSettings>& weights, const WeightError& error) {
  std::vector<Try> all;
  for (const shading::WeightSettings& weight : weights) all.push_back({weight, error(weight)});
  std::stable_sort(all.begin(), all.end(), isBetter);
  return all;
}

}  // namespace

WeighedDepths depthsOf(const FragmentLists& lists) {
  std::vector<float> all;
  for (const Fragment& fragment : lists.fragments) all.push_back(fragment.z);
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  return {all.front(), all[all.size() / 2], all.back()};
}

WeightFit fitWeight(const shading::WeightSettings& given, const WeighedDepths& depths, const WeightError& rough,
                    const WeightError& whole, double least) {
  WeightFit fit;
  fit.weight = given;
  if (!(depths.nearest > 0.0f)) return fit;
  Fitter fitter(whole, fit);
  std::vector<shading::WeightSettings> asListed, varied;
  for (const DepthWeight& row : kDepthWeights) {
    if (!row.fitted) continue;
    listRow(row, given, asListed);
    varyRow(row, given, depths, varied);
  }
  std::vector<Try> best{fitter.attempt(asListed[0])};
  const Try first = best[0];
  if (first.error <= least) return fit;  // nothing can be gained
  for (std::size_t i = 1; i < asListed.size(); ++i) best.push_back(fitter.attempt(asListed[i]));
  const std::vector<Try> likely = tried(varied, rough);
  for (std::size_t i = 0; i < std::min(kKept, likely.size()); ++i) best.push_back(fitter.attempt(likely[i].weight));
  std::stable_sort(best.begin(), best.end(), isBetter);
  std::vector<int> refined;
  for (const Try& one : best) {
    if (refined.size() == kRefined) break;
    if (std::find(refined.begin(), refined.end(), one.weight.kind) != refined.end()) continue;
    refined.push_back(one.weight.kind);
    fitter.refine(one.weight, rough);
  }
  if (!(fit.meanError < first.error - least)) {
    fit.weight = first.weight;
    fit.meanError = first.error;
  }
  std::stable_sort(fit.tried.begin(), fit.tried.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  return fit;
}

}  // namespace pellucid
