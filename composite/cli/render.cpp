#include "composite/cli/render.h"

#include "composite/antialias.h"
#include "composite/cli/lists.h"
#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/over.h"
#include "composite/study/fit_weight.h"

namespace pellucid::cli {

namespace {

// One sample by lists: the sorted truth, a method of the table, or the sums where deep files take part.
Veil veilFromLists(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep,
                   const RenderSettings& settings, const PassSettings& sample, const GBuffer& gbuffer,
                   RenderCounts& counts) {
  Veil veil(gbuffer.data.width(), gbuffer.data.height());
  const bool exact = settings.sortedTruth || settings.tolerance;
  const MethodChoice choice{0, sample.weight, sample.normalisation};
  OitPlanes planes;
  const bool sums = !exact && !settings.listMethod;
  // Every method shows the same background, which the pixel's scattering layers alone decide.
  const bool scatters = !sums && pass && pass->scatters(sample);
  if (sums || scatters) planes = emptyPlanes(gbuffer.display, gbuffer.data);
  eachList(pass, deep, gbuffer, sample, exact ? VolumeRule::split : VolumeRule::midDepth,
           [&](const FragmentLists& given) {
             if (!pass) counts.fragments += given.fragments.size();
             FragmentLists shown;
             if (scatters) {
               // The truth depends on no order either.
               if (settings.sortedTruth || settings.exactSums)
                 foldExact(given, sample.weight, sample.normalisation, planes);
               else
                 foldScattering(given, planes);
               shown = given;
               hideSolids(shown);
             }
             const FragmentLists& tile = scatters ? shown : given;
             if (settings.tolerance)
               compositeWithin(tile, choice, gbuffer, *settings.tolerance, veil, counts.tolerance);
             else if (settings.sortedTruth)
               compositeSorted(tile, gbuffer.data, veil);
             else if (settings.listMethod)
               compositeBy(*settings.listMethod, choice, tile, gbuffer.data, veil);
             else if (settings.exactSums)
               foldExact(tile, sample.weight, sample.normalisation, planes);
             else
               foldFragments(tile, sample.weight, sample.normalisation, planes);
           });
  if (sums) return resolveOver(std::move(planes), settings.resolve, settings.lookup, gbuffer);
  if (planes.scatters()) {
    const Backdrop backdrop = backdropOf(gbuffer, planes.solid);
    showThrough(Lookups(backdrop, planes, settings.lookup), veil);
  }
  return veil;
}

}  // namespace

Veil renderVeil(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const RenderSettings& settings,
                const GBuffer& gbuffer, Stages& stages, RenderCounts& counts) {
  VeilMean mean;
  for (int i = 0; i < settings.samples; ++i) {
    PassSettings sample = settings.pass;
    sample.sample = samplePosition(i, settings.samples);
    if (settings.sortedTruth || settings.listMethod || settings.tolerance || settings.exactSums || !deep.empty() ||
        !pass) {
      const Veil veil = stages.time(settings.sortedTruth ? "lists and sort" : "lists and method",
                                    [&] { return veilFromLists(pass, deep, settings, sample, gbuffer, counts); });
      stages.time("average", [&] { mean.add(veil); });
    } else {
      OitPlanes planes = stages.time("transparent pass", [&] { return pass->accumulate(sample); });
      const Veil veil = stages.time(
          "resolve", [&] { return resolveOver(std::move(planes), settings.resolve, settings.lookup, gbuffer); });
      stages.time("average", [&] { mean.add(veil); });
    }
    if (!pass) continue;
    const PassStatistics& statistics = pass->statistics();
    counts.triangles = statistics.triangles;
    counts.chunks += statistics.chunks;
    counts.tiles += statistics.tiles;
    counts.fragments += statistics.fragments;
    counts.bitsPerPixel = statistics.bitsPerPixel;
    counts.passes = statistics.passes;
    counts.pruned = statistics.pruned;
  }
  return stages.time("average", [&] { return mean.finish(); });
}

void fitShotWeight(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const GBuffer& gbuffer,
                   PassSettings& settings, Stages& stages) {
  // Some thousand probes fix a mean error to about a percent.
  constexpr std::size_t kProbes = 16384;
  const WeightFit fit = stages.time("fit weight", [&] {
    WeightProbes probes(gbuffer, kProbes);
    PassSettings centre = settings;
    centre.sample = {0.5, 0.5};
    eachList(pass, deep, gbuffer, centre, VolumeRule::midDepth, [&](const FragmentLists& tile) { probes.add(tile); });
    return fitWeight(probes, settings.weight, settings.normalisation);
  });
  settings.weight = fit.weight;
  spdlog::info("--weight auto: {} (name, near, far, exponent), mean error {:.4g} on {} probes", weightText(fit.weight),
               fit.meanError, fit.probes);
}

}  // namespace pellucid::cli
