#include "composite/methods/stochastic.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pellucid {
namespace {

using glm::dvec3;
using Variant = StochasticSettings::Variant;

constexpr int kLeastSets = 4;  // that a variance is estimated from

bool before(const MethodLayer& a, const MethodLayer& b) {
  if (a.record->z != b.record->z) return a.record->z < b.record->z;
  if (a.record->identity != b.record->identity) return a.record->identity < b.record->identity;
  return std::memcmp(a.record, b.record, sizeof(Fragment)) < 0;
}

// How far each sample sees: counts[c][i] samples whose nearest cover in channel c is layer i, of n layers; [n] is none.
class Winners {
 public:
  Winners(const std::vector<MethodLayer>& layers, glm::ivec2 pixel, const StochasticSettings& settings,
          const MaskTable& masks, const StochasticShare& share)
      : layers_(layers), settings_(settings), masks_(masks) {
    keys_.reserve(layers.size());
    for (const MethodLayer& layer : layers)
      keys_.push_back(shading::coinKeyOf(glm::uvec2(pixel), layer.record->identity, settings.seed));
    for (int c = 0; c < 3; ++c) {
      const bool same = c > 0 && sameOpacity(c, c - 1);
      if (same)
        counts[c] = counts[c - 1];
      else
        count(c, share);
    }
  }
  std::vector<double> counts[3];  // as shares of the samples

 private:
  bool sameOpacity(int a, int b) const {
    return std::all_of(layers_.begin(), layers_.end(),
                       [&](const MethodLayer& layer) { return layer.opacity[a] == layer.opacity[b]; });
  }
  void count(int c, const StochasticShare& share) {
    const std::size_t n = layers_.size();
    const auto samples = static_cast<std::uint32_t>(settings_.samples);
    std::vector<float> opacity(n);
    covered_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      opacity[i] = static_cast<float>(layers_[i].opacity[c]);
      if (settings_.stratified) covered_[i] = shading::coveredCount(opacity[i], samples, keys_[i]);
    }
    counts[c].assign(n + 1, 0.0);
    int taken = 0;
    for (auto s = static_cast<std::uint32_t>(share.first); s < samples; s += static_cast<std::uint32_t>(share.step)) {
      std::size_t i = 0;
      if (settings_.stratified)
        while (i < n && (covered_[i] == 0 || masks_.rank(keys_[i], s) >= covered_[i])) ++i;
      else
        while (i < n && !shading::coinCovers(opacity[i], keys_[i], s)) ++i;
      counts[c][i] += 1.0;
      ++taken;
    }
    for (double& share_ : counts[c]) share_ /= std::max(taken, 1);
  }

  const std::vector<MethodLayer>& layers_;
  const StochasticSettings& settings_;
  const MaskTable& masks_;
  std::vector<std::uint32_t> keys_, covered_;
};

}  // namespace

int stochasticBits(const StochasticSettings& settings) {
  // basic and alpha keep the winners' colour beside their depth; depth sums light and opacity.
  const int sample = settings.variant == Variant::depth ? 3 : 6;
  return 32 * (settings.samples * sample + 12);
}

int stochasticPasses(const StochasticSettings& settings) {
  // ST10 section 3.5: net opacity, masks, and the sum of what they let through.
  const bool corrected =
      settings.variant == Variant::alpha || (settings.variant == Variant::depth && settings.corrected);
  return 1 + (corrected ? 1 : 0) + (settings.variant == Variant::depth ? 1 : 0);
}

StochasticSums samplePixel(std::vector<MethodLayer>& layers, glm::ivec2 pixel, const StochasticSettings& settings,
                           const MaskTable& masks, const StochasticShare& share) {
  StochasticSums sums;
  if (layers.empty()) return sums;
  std::sort(layers.begin(), layers.end(), before);
  const Winners winners(layers, pixel, settings, masks, share);
  const std::size_t n = layers.size();
  sums.beta = productOfPassed(layers);
  for (int c = 0; c < 3; ++c) {
    const std::vector<double>& won = winners.counts[c];
    sums.empty[c] = won[n];
    double visible = won[n], from = won[n];  // share of samples that see layer i: those won by it or behind it
    for (std::size_t i = n; i-- > 0;) {
      from += won[i];
      // ST10 eq. 4 compares z <= z_i: coincident layers do not hide each other.
      if (i + 1 == n || layers[i].z != layers[i + 1].z) {
        visible = from;
        for (std::size_t k = i; k-- > 0 && layers[k].z == layers[i].z;) visible += won[k];
      }
      const MethodLayer& layer = layers[i];
      // Light whose opacity is too small for a coin would never be seen.
      if (layer.adds(c) || shading::coinWeight(static_cast<float>(layer.opacity[c])) == 0u) {
        sums.added[c] += visible * layer.light[c];
      } else if (settings.variant == Variant::depth) {
        sums.light[c] += visible * layer.light[c];
        sums.unit[c] += visible * layer.opacity[c];
      } else if (won[i] > 0.0) {
        sums.light[c] += won[i] * layer.light[c] / layer.opacity[c];
        sums.unit[c] += won[i];
      }
    }
  }
  return sums;
}

StochasticSums samplePixelAdaptively(std::vector<MethodLayer>& layers, glm::ivec2 pixel,
                                     const StochasticSettings& settings, const MaskTable& masks,
                                     const StochasticShare& share, int& taken) {
  StochasticSums mean = samplePixel(layers, pixel, settings, masks, share);
  taken = 1;
  // A lone layer has no noise where its sums are scaled to the exact opacity.
  const bool corrected =
      settings.variant == Variant::alpha || (settings.variant == Variant::depth && settings.corrected);
  if (layers.size() < (corrected ? 2u : 1u)) return mean;
  const dvec3 hidden = dvec3(1.0) - mean.beta;
  // What is noisy: the light, and where nothing scales it the share of the background that shows.
  const auto noisy = [&](const StochasticSums& sums, dvec3(&values)[2]) {
    values[0] = stochasticLight(sums, hidden, settings);
    values[1] = corrected || settings.variant == Variant::depth ? dvec3(0.0) : sums.empty;
  };
  dvec3 value[2], first[2], sum[2] = {dvec3(0.0), dvec3(0.0)}, square[2] = {dvec3(0.0), dvec3(0.0)};
  noisy(mean, first);
  StochasticSettings other = settings;
  const int most = StochasticSettings::kMostSamples / settings.samples;
  for (; taken < most; ++taken) {
    if (taken >= kLeastSets) {
      bool enough = true;
      for (int v = 0; v < 2; ++v)
        for (int c = 0; c < 3; ++c) {
          const double variance = std::max(square[v][c] - sum[v][c] * sum[v][c] / taken, 0.0) / (taken - 1);
          const double wanted = settings.adaptive * std::max(1.0, std::abs(first[v][c] + sum[v][c] / taken));
          // Of the mean of `share.step` passes.
          enough = enough && variance <= wanted * wanted * taken * share.step;
        }
      if (enough) break;
    }
    other.seed = shading::hashOf(settings.seed ^ shading::hashOf(static_cast<std::uint32_t>(taken)));
    const StochasticSums next = samplePixel(layers, pixel, other, masks, share);
    noisy(next, value);
    for (int v = 0; v < 2; ++v) {
      const dvec3 apart = value[v] - first[v];  // so that nothing cancels
      sum[v] += apart;
      square[v] += apart * apart;
    }
    mean.light += next.light;
    mean.unit += next.unit;
    mean.added += next.added;
    mean.empty += next.empty;
  }
  const double part = 1.0 / taken;
  mean.light *= part;
  mean.unit *= part;
  mean.added *= part;
  mean.empty *= part;
  return mean;
}

glm::dvec3 stochasticLight(const StochasticSums& sums, const glm::dvec3& hidden, const StochasticSettings& settings) {
  const bool corrected =
      settings.variant == Variant::alpha || (settings.variant == Variant::depth && settings.corrected);
  dvec3 light = sums.added;
  for (int c = 0; c < 3; ++c) {
    if (!corrected)
      light[c] += sums.light[c];
    else if (sums.unit[c] > 0.0)
      light[c] += hidden[c] * sums.light[c] / sums.unit[c];
  }
  return light;
}

StochasticMean::StochasticMean(int width, int height, const StochasticSettings& settings, int passes)
    : settings_(settings),
      passes_(passes),
      masks_(std::make_shared<MaskTable>(settings.samples)),
      light_(width, height, glm::vec3(0.0f)),
      unit_(light_),
      added_(light_),
      hidden_(light_) {}

bool StochasticMean::exactBackground() const {
  return settings_.variant == Variant::alpha || (settings_.variant == Variant::depth && settings_.corrected);
}

void StochasticMean::put(int x, int y, const StochasticSums& sums, const glm::vec4& solid, float frontZ, Veil& veil) {
  const auto share = static_cast<float>(1.0 / passes_);
  const bool hasSolid = std::isfinite(solid.a);
  light_.at(x, y) += share * glm::vec3(sums.light);
  unit_.at(x, y) += share * glm::vec3(sums.unit);
  added_.at(x, y) += share * glm::vec3(sums.added);
  hidden_.at(x, y) += share * glm::vec3(dvec3(1.0) - sums.beta);
  const glm::vec3 shows = glm::vec3(exactBackground() ? sums.beta : sums.empty);
  veil.light.at(x, y) = hasSolid ? shows * glm::vec3(solid) : glm::vec3(0.0f);
  veil.transmission.at(x, y) = hasSolid ? glm::vec3(0.0f) : shows;
  veil.frontZ.at(x, y) = std::min(frontZ, solid.a);
  veil.touched.at(x, y) = 1;
}

void StochasticMean::add(int pass, const FragmentLists& lists, const Window& data, Veil& veil) {
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    std::vector<MethodLayer> layers;
    std::uint64_t samples = 0, pixels = 0;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        const glm::vec4 solid = lists.solid.at(x, y);
        layersOf(lists, pixel, solid.a, layers);
        if (layers.empty() && !std::isfinite(solid.a)) continue;
        const glm::ivec2 at(lists.window.x0 + x, lists.window.y0 + y);
        int sets = 1;
        const StochasticSums sums = settings_.adaptive > 0.0
                                        ? samplePixelAdaptively(layers, at, settings_, *masks_, {pass, passes_}, sets)
                                        : samplePixel(layers, at, settings_, *masks_, {pass, passes_});
        if (!layers.empty()) {
          samples += static_cast<std::uint64_t>(sets) * static_cast<std::uint64_t>(settings_.samples / passes_);
          ++pixels;
        }
        put(left + x, top + y, sums, solid, layers.empty() ? solid.a : layers.front().record->z, veil);
      }
    samplesTaken_ += samples;
    pixelsSampled_ += pixels;
  });
}

void StochasticMean::add(const StochasticPlanes& planes, Veil& veil) {
  for (int y = 0; y < planes.data.height(); ++y)
    for (int x = 0; x < planes.data.width(); ++x) {
      const glm::vec4& solid = planes.solid.at(x, y);
      const float frontZ = planes.frontZ.at(x, y);
      if (!std::isfinite(frontZ) && !std::isfinite(solid.a)) continue;
      StochasticSums sums;
      sums.light = planes.light.at(x, y);
      sums.unit = planes.unit.at(x, y);
      sums.added = planes.added.at(x, y);
      sums.empty = planes.empty.at(x, y);
      sums.beta = planes.beta.at(x, y);
      put(x, y, sums, solid, frontZ, veil);
    }
}

void StochasticMean::finish(Veil& mean) const {
  for (std::size_t i = 0; i < mean.touched.size(); ++i) {
    if (!mean.touched[i]) continue;
    StochasticSums sums;
    sums.light = light_[i];
    sums.unit = unit_[i];
    sums.added = added_[i];
    mean.light[i] += glm::vec3(stochasticLight(sums, dvec3(hidden_[i]), settings_));
  }
}

}  // namespace pellucid
