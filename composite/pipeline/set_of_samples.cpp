#include "composite/pipeline/set_of_samples.h"

#include <cmath>
#include <utility>
#include <vector>

#include "composite/methods/adaptive_samples.h"

namespace pellucid {
namespace {

StochasticSums sumsAt(const StochasticPlanes& planes, std::size_t i) {
  StochasticSums sums;
  sums.light = planes.light[i];
  sums.unit = planes.unit[i];
  sums.added = planes.added[i];
  sums.empty = planes.empty[i];
  sums.beta = planes.beta[i];
  return sums;
}

void count(const StochasticPassStatistics& done, PassStatistics& statistics) {
  statistics.fragments += done.fragments;
  statistics.tiles += done.bands;
  statistics.passes += done.passes;
  statistics.shadowRays += done.shadowRays;
  statistics.shadowSeconds += done.shadowSeconds;
}

}  // namespace

StochasticPlanes drawSamples(StochasticPass& sampler, const PassSettings& sample, const StochasticSettings& settings,
                             int pass, int passes, PassStatistics& statistics) {
  StochasticPassSettings drawn;
  drawn.samples = settings.samples;
  drawn.first = pass;
  drawn.step = passes;
  drawn.stratified = settings.stratified;
  drawn.winnersOnly = settings.variant != StochasticSettings::Variant::depth;
  drawn.seed = settings.seed;
  StochasticPlanes planes = sampler.sample(sample, drawn);
  count(sampler.statistics(), statistics);
  if (settings.adaptive <= 0.0) return planes;
  // Every pixel with layers takes sets until its own error is low; the device draws them for all.
  std::vector<std::pair<std::size_t, AdaptiveSamples>> pixels;
  for (std::size_t i = 0; i < planes.solid.size(); ++i)
    if (std::isfinite(planes.frontZ[i])) pixels.emplace_back(i, AdaptiveSamples(sumsAt(planes, i), settings, passes));
  for (int set = 1;; ++set) {
    bool more = false;
    for (const auto& [i, sets] : pixels) more = more || sets.wantsMore();
    if (!more) break;
    drawn.seed = seedOfSet(settings.seed, set);
    const StochasticPlanes next = sampler.sample(sample, drawn);
    count(sampler.statistics(), statistics);
    for (auto& [i, sets] : pixels)
      if (sets.wantsMore()) sets.add(sumsAt(next, i));
  }
  for (const auto& [i, sets] : pixels) {
    const StochasticSums mean = sets.mean();
    planes.light[i] = glm::vec3(mean.light);
    planes.unit[i] = glm::vec3(mean.unit);
    planes.added[i] = glm::vec3(mean.added);
    planes.empty[i] = glm::vec3(mean.empty);
  }
  return planes;
}

}  // namespace pellucid
