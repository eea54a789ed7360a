#include "composite/methods/stochastic.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "composite/methods/adaptive_samples.h"

namespace pellucid {
namespace {

using glm::dvec3;
using Variant = StochasticSettings::Variant;

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
    const glm::uvec2 where = settings.onObjects ? glm::uvec2(0u) : glm::uvec2(pixel);
    keys_.reserve(layers.size());
    for (const MethodLayer& layer : layers)
      keys_.push_back(shading::coinKeyOf(where, layer.record->identity, settings.seed));
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

bool isCorrected(const StochasticSettings& settings) {
  return settings.variant == Variant::alpha || (settings.variant == Variant::depth && settings.corrected);
}

int stochasticPasses(const StochasticSettings& settings) {
  // ST10 section 3.5: net opacity, masks, and the sum of what they let through.
  return 1 + (isCorrected(settings) ? 1 : 0) + (settings.variant == Variant::depth ? 1 : 0);
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
  const StochasticSums first = samplePixel(layers, pixel, settings, masks, share);
  taken = 1;
  // A lone layer has no noise where its sums are scaled to the exact opacity.
  if (layers.size() < (isCorrected(settings) ? 2u : 1u)) return first;
  AdaptiveSamples sets(first, settings, share.step);
  StochasticSettings other = settings;
  while (sets.wantsMore()) {
    other.seed = seedOfSet(settings.seed, sets.taken());
    sets.add(samplePixel(layers, pixel, other, masks, share));
  }
  taken = sets.taken();
  return sets.mean();
}

glm::dvec3 stochasticLight(const StochasticSums& sums, const glm::dvec3& hidden, const StochasticSettings& settings) {
  const bool corrected = isCorrected(settings);
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

StochasticMean::StochasticMean(const DeepOpaque& opaque, const StochasticSettings& settings, int passes)
    : StochasticMean(static_cast<int>(placesOf(opaque)), 1, settings, passes) {
  opaque_ = &opaque;
}

bool StochasticMean::exactBackground() const {
  return isCorrected(settings_);
}

StochasticSums StochasticMean::sampled(int pass, glm::ivec2 pixel, std::vector<MethodLayer>& layers) {
  int sets = 1;
  const StochasticSums sums = settings_.adaptive > 0.0
                                  ? samplePixelAdaptively(layers, pixel, settings_, *masks_, {pass, passes_}, sets)
                                  : samplePixel(layers, pixel, settings_, *masks_, {pass, passes_});
  if (!layers.empty()) {
    samplesTaken_ += static_cast<std::uint64_t>(sets) * static_cast<std::uint64_t>(settings_.samples / passes_);
    ++pixelsSampled_;
  }
  return sums;
}

void StochasticMean::put(std::size_t place, const StochasticSums& sums, const glm::vec4& solid, float frontZ,
                         float weight, std::size_t at, Veil& veil) {
  const float share = static_cast<float>(1.0 / passes_) * weight;
  const bool hasSolid = std::isfinite(solid.a);
  light_[place] += share * glm::vec3(sums.light);
  unit_[place] += share * glm::vec3(sums.unit);
  added_[place] += share * glm::vec3(sums.added);
  hidden_[place] += share * glm::vec3(dvec3(1.0) - sums.beta);
  const glm::vec3 shows = glm::vec3(exactBackground() ? sums.beta : sums.empty);
  veil.light[at] = hasSolid ? shows * glm::vec3(solid) : glm::vec3(0.0f);
  veil.transmission[at] = hasSolid ? glm::vec3(0.0f) : shows;
  veil.frontZ[at] = std::min(frontZ, solid.a);
  veil.touched[at] = 1;
}

void StochasticMean::add(int pass, const FragmentLists& lists, const Window& data, Veil& veil,
                         const Image<float>* weights) {
  const int left = lists.window.x0 - data.x0, top = lists.window.y0 - data.y0, width = lists.window.width();
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    std::vector<MethodLayer> layers;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const glm::vec4 solid = lists.solid.at(x, y);
        layersOf(lists, pixel, solid.a, layers);
        if (layers.empty() && !std::isfinite(solid.a)) continue;
        const StochasticSums sums = sampled(pass, {lists.window.x0 + x, lists.window.y0 + y}, layers);
        const std::size_t at = static_cast<std::size_t>(top + y) * static_cast<std::size_t>(light_.width()) +
                               static_cast<std::size_t>(left + x);
        put(at, sums, solid, layers.empty() ? solid.a : layers.front().record->z, weights ? (*weights)[at] : 1.0f, at,
            veil);
      }
  });
}

void StochasticMean::add(int pass, const HeldOutRow& row, Veil& veil) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, row.z.size(), 256), [&](const auto& entries) {
    std::vector<MethodLayer> layers;
    for (std::size_t entry = entries.begin(); entry != entries.end(); ++entry) {
      const glm::vec4 solid = row.lists.solid[entry];
      layersOf(row.lists, entry, solid.a, layers);
      if (layers.empty() && !std::isfinite(solid.a)) continue;
      const StochasticSums sums = sampled(pass, row.pixel[entry], layers);
      put(row.place[entry], sums, solid, layers.empty() ? solid.a : layers.front().record->z, 1.0f, entry, veil);
    }
  });
}

void StochasticMean::add(const StochasticPlanes& planes, Veil& veil, const Image<float>* weights) {
  for (std::size_t i = 0; i < planes.solid.size(); ++i) {
    const glm::vec4& solid = planes.solid[i];
    const float frontZ = planes.frontZ[i];
    if (!std::isfinite(frontZ) && !std::isfinite(solid.a)) continue;
    StochasticSums sums;
    sums.light = planes.light[i];
    sums.unit = planes.unit[i];
    sums.added = planes.added[i];
    sums.empty = planes.empty[i];
    sums.beta = planes.beta[i];
    put(i, sums, solid, frontZ, weights ? (*weights)[i] : 1.0f, i, veil);
  }
}

void StochasticMean::finish(Veil& mean) const {
  const auto lightAt = [this](std::size_t i) {
    StochasticSums sums;
    sums.light = light_[i];
    sums.unit = unit_[i];
    sums.added = added_[i];
    return glm::vec3(stochasticLight(sums, dvec3(hidden_[i]), settings_));
  };
  if (!opaque_) {
    for (std::size_t i = 0; i < mean.touched.size(); ++i)
      if (mean.touched[i]) mean.light[i] += lightAt(i);
    return;
  }
  Image<glm::vec3> places(light_.width(), 1);
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = lightAt(i);
  for (std::size_t i = 0; i < mean.touched.size(); ++i)
    if (mean.touched[i]) mean.light[i] += sumOfPlaces(*opaque_, i, places);
}

}  // namespace pellucid
