#include "composite/study/fit_weight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

constexpr std::size_t kKept = 6;                      // of the rough tries
constexpr std::size_t kRefined = 3;                   // of those, one of a kind
constexpr float kNearShares[] = {0.25f, 0.5f, 0.9f};  // where a range begins, of where the layers do

struct Try {
  shading::WeightSettings weight;
  double error = 0.0;
};

// Of errors that differ by less, none is better: the scene's unit and roundings move them as far.
constexpr double kTie = 1e-3;

bool isBetter(const Try& a, const Try& b) {
  return a.error < (1.0 - kTie) * b.error;
}

// The first of those that no other is better than: of equals the order chooses.
std::size_t firstOfBest(const std::vector<Try>& all) {
  std::size_t least = 0, first = 0;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].error < all[least].error) least = i;
  while (isBetter(all[least], all[first])) ++first;
  return first;
}

std::vector<Try> bestFirst(std::vector<Try> all, std::size_t most) {
  std::vector<Try> sorted;
  while (!all.empty() && sorted.size() < most) {
    const std::size_t next = firstOfBest(all);
    sorted.push_back(all[next]);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(next));
  }
  return sorted;
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
    for (const float nearShare : kNearShares)
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

// Where steps begin: how a range begins matters most where it ends, so each of its beginnings is gone from.
std::vector<shading::WeightSettings> beginningsOf(const shading::WeightSettings& weight, const WeighedDepths& depths) {
  std::vector<shading::WeightSettings> all{weight};
  if (depthWeightOf(weight.kind)->readsRange)
    for (const float share : kNearShares) {
      all.push_back(weight);
      all.back().rangeNear = depths.nearest * share;
    }
  return all;
}

class Fitter {
 public:
  Fitter(const WeightError& rough, const WeightError& whole) : rough_(rough), whole_(whole) {}

  void attempt(const shading::WeightSettings& weight) { tried_.push_back({weight, whole_(weight)}); }
  const std::vector<Try>& tried() const { return tried_; }

  // On some probes; where the steps end is tried on all.
  void refine(const shading::WeightSettings& from, const WeighedDepths& depths) {
    Try best{from, 0.0};
    if (!numberOf(best.weight)) return;
    best.error = rough_(from);
    bool moved = false;
    for (const shading::WeightSettings& weight : beginningsOf(from, depths)) {
      const Try reached = stepped(weight);
      if (!isBetter(reached, best)) continue;
      best = reached;
      moved = true;
    }
    if (moved) attempt(best.weight);
  }

 private:
  // Steps around the number, each half as long as the one before.
  Try stepped(const shading::WeightSettings& from) const {
    const DepthWeight* row = depthWeightOf(from.kind);
    Try best{from, rough_(from)};
    for (float step = 0.32f; step > 0.005f; step *= 0.5f) {
      const Try centre = best;
      for (const float factor : {1.0f / (1.0f + step), 1.0f + step}) {
        Try other = centre;
        float& number = *numberOf(other.weight);
        number *= factor;
        if (row->parameter && !row->perMetre) number = std::clamp(number, row->least, row->fitMost);
        if (row->readsRange && !(other.weight.rangeFar > other.weight.rangeNear)) continue;
        other.error = rough_(other.weight);
        if (isBetter(other, best)) best = other;
      }
    }
    return best;
  }

  const WeightError& rough_;
  const WeightError& whole_;
  std::vector<Try> tried_;
};

std::vector<Try> bestOfKinds(const std::vector<Try>& tried) {
  std::vector<Try> kinds;
  for (const Try& one : bestFirst(tried, tried.size())) {
    const bool known =
        std::any_of(kinds.begin(), kinds.end(), [&](const Try& k) { return k.weight.kind == one.weight.kind; });
    if (!known) kinds.push_back(one);
    if (kinds.size() == kRefined) break;
  }
  return kinds;
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
  Fitter fitter(rough, whole);
  std::vector<shading::WeightSettings> asListed;
  std::vector<Try> varied;
  for (const DepthWeight& row : kDepthWeights) {
    if (!row.fitted) continue;
    listRow(row, given, asListed);
    std::vector<shading::WeightSettings> ofRow;
    varyRow(row, given, depths, ofRow);
    for (const shading::WeightSettings& weight : ofRow) varied.push_back({weight, 0.0});
  }
  fitter.attempt(asListed[0]);
  const Try first = fitter.tried()[0];
  std::size_t chosen = 0;
  if (first.error > least) {  // else nothing can be gained
    for (std::size_t i = 1; i < asListed.size(); ++i) fitter.attempt(asListed[i]);
    for (Try& one : varied) one.error = rough(one.weight);
    for (const Try& likely : bestFirst(varied, kKept)) fitter.attempt(likely.weight);
    for (const Try& one : bestOfKinds(fitter.tried())) fitter.refine(one.weight, depths);
    chosen = firstOfBest(fitter.tried());
    if (!(fitter.tried()[chosen].error < first.error - least)) chosen = 0;
  }
  fit.weight = fitter.tried()[chosen].weight;
  fit.meanError = fitter.tried()[chosen].error;
  for (const Try& one : fitter.tried()) fit.tried.emplace_back(weightText(one.weight), one.error);
  std::stable_sort(fit.tried.begin(), fit.tried.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  return fit;
}

}  // namespace pellucid
