#include "composite/study/fit_weight.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "composite/over.h"
#include "gbuffer/weight_text.h"
#include "shaders/probe.h"

namespace pellucid {
WeightProbes::WeightProbes(const GBuffer& gbuffer, std::size_t most) : gbuffer_(gbuffer), cell_(1) {
  while (gbuffer.beauty.size() / (static_cast<std::size_t>(cell_) * static_cast<std::size_t>(cell_)) > most) ++cell_;
}

void WeightProbes::add(const FragmentLists& tile) {
  for (int y = 0; y < tile.window.height(); ++y)
    for (int x = 0; x < tile.window.width(); ++x) {
      const int px = tile.window.x0 + x - gbuffer_.data.x0, py = tile.window.y0 + y - gbuffer_.data.y0;
      if (!shading::isProbe({px, py}, cell_)) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.window.width()) + static_cast<std::size_t>(x);
      const glm::vec4 behind = gbuffer_.beauty.at(px, py);
      if (tile.offsets[pixel] == tile.offsets[pixel + 1] || !std::isfinite(behind.r + behind.g + behind.b)) continue;
      fragments_.emplace_back(tile.fragments.begin() + static_cast<std::ptrdiff_t>(tile.offsets[pixel]),
                              tile.fragments.begin() + static_cast<std::ptrdiff_t>(tile.offsets[pixel + 1]));
      solids_.push_back(tile.solid.at(x, y));
      backgrounds_.emplace_back(behind);
    }
}

// The probes as a picture, the end of its last row empty, and the truth of them.
struct WeightFitter {
  FragmentLists lists;
  std::vector<glm::dvec3> truth;
  const WeightProbes& probes;
  int normalisation;
  WeightFit& fit;

  WeightFitter(const WeightProbes& from, int rule, WeightFit& result) : probes(from), normalisation(rule), fit(result) {
    constexpr int kWidth = 64;
    lists.window = {0, 0, kWidth, (static_cast<int>(from.count()) + kWidth - 1) / kWidth};
    lists.solid = Image<glm::vec4>(lists.window.width(), lists.window.height(), glm::vec4(0, 0, 0, INFINITY));
    lists.offsets.assign(1, 0);
    for (std::size_t i = 0; i < from.count(); ++i) {
      lists.fragments.insert(lists.fragments.end(), from.fragments_[i].begin(), from.fragments_[i].end());
      lists.offsets.push_back(lists.fragments.size());
      lists.solid[i] = from.solids_[i];
    }
    lists.offsets.resize(lists.solid.size() + 1, lists.fragments.size());
    Veil veil(lists.window.width(), lists.window.height());
    compositeSorted(lists, lists.window, veil);
    truth = shown(veil);
  }
  std::vector<glm::dvec3> shown(const Veil& veil) const {
    std::vector<glm::dvec3> pictures;
    for (std::size_t i = 0; i < probes.count(); ++i)
      pictures.push_back(glm::dvec3(veil.light[i]) +
                         glm::dvec3(veil.transmission[i]) * glm::dvec3(probes.backgrounds_[i]));
    return pictures;
  }
  double attempt(const shading::WeightSettings& weight) {
    Veil veil(lists.window.width(), lists.window.height());
    compositeBy(*chooseMethod("weighted"), {0, weight, normalisation}, lists, lists.window, veil);
    const std::vector<glm::dvec3> got = shown(veil);
    double sum = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      const glm::dvec3 d = glm::abs(got[i] - truth[i]);
      sum += d.r + d.g + d.b;
    }
    const double error = sum / (3.0 * static_cast<double>(got.size()));
    fit.tried.emplace_back(weightText(weight), error);
    if (fit.probes == 0 || error < fit.meanError) {
      fit.meanError = error;
      fit.weight = weight;
    }
    fit.probes = got.size();
    return error;
  }
};

namespace {

// As given, and over ranges that the probes' depths suggest.
//   low, high  nearest and farthest layer, metres
void tryRow(const DepthWeight& row, const shading::WeightSettings& given, float low, float high, WeightFitter& fitter) {
  shading::WeightSettings weight = given;
  weight.kind = row.kind;
  fitter.attempt(weight);
  if (!row.readsRange) return;
  for (const float nearShare : {0.25f, 0.5f, 0.9f})
    for (const float farShare : {1.1f, 4.0f, 100.0f}) {
      weight.rangeNear = low * nearShare;
      weight.rangeFar = high * farShare;
      fitter.attempt(weight);
    }
}

// Steps that are closer where the parameter is small, then closer still around the best of them.
void tryParameters(const DepthWeight& row, const shading::WeightSettings& given, WeightFitter& fitter) {
  shading::WeightSettings weight = given;
  weight.kind = row.kind;
  float best = 1.0f;
  double least = INFINITY;
  const auto tryOne = [&](float parameter) {
    weight.exponent = parameter;
    const double error = fitter.attempt(weight);
    if (error < least) least = error, best = parameter;
  };
  for (const float part : {1.0f, 2.0f, 4.0f, 6.0f, 8.0f, 12.0f, 16.0f, 24.0f, 32.0f, 48.0f, 64.0f})
    tryOne(std::max(row.least, part * row.fitMost / 64.0f));
  for (float step = 0.25f; step > 0.01f; step *= 0.5f) {
    const float centre = best;
    tryOne(std::max(row.least, centre * (1.0f - step)));
    tryOne(centre * (1.0f + step));
  }
}

}  // namespace

WeightFit fitWeight(const WeightProbes& probes, const shading::WeightSettings& given, int normalisation) {
  WeightFit fit;
  fit.weight = given;
  if (probes.count() == 0) return fit;
  WeightFitter fitter(probes, normalisation, fit);
  float low = fitter.lists.fragments[0].z, high = low;
  for (const Fragment& fragment : fitter.lists.fragments) {
    low = std::min(low, fragment.z);
    high = std::max(high, fragment.z);
  }
  for (const DepthWeight& row : kDepthWeights)
    if (row.fitted && !row.parameter) tryRow(row, given, low, high, fitter);
  for (const DepthWeight& row : kDepthWeights)
    if (row.fitted && row.parameter) tryParameters(row, given, fitter);
  std::stable_sort(fit.tried.begin(), fit.tried.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  return fit;
}

}  // namespace pellucid
