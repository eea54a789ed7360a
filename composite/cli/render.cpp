#include "composite/cli/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "composite/antialias.h"
#include "composite/cli/lists.h"
#include "composite/cli/systems.h"
#include "composite/fog.h"
#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/fold_published.h"
#include "composite/over.h"
#include "composite/study/fit_weight.h"

namespace pellucid::cli {

namespace {

// One sample by lists: the sorted truth, a method of the table, or the sums where deep files take part.
class ListPainter {
 public:
  ListPainter(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const RenderSettings& settings,
              const PassSettings& sample, const GBuffer& gbuffer, RenderCounts& counts, StochasticMean* stochastic,
              int index)
      : pass_(pass),
        deep_(deep),
        settings_(settings),
        sample_(sample),
        gbuffer_(gbuffer),
        counts_(counts),
        stochastic_(stochastic),
        index_(index) {
    sums_ = !settings.sortedTruth && !settings.tolerance && !settings.listMethod && !stochastic && !settings.deepOpaque;
    const bool deepScatters =
        std::any_of(deep.begin(), deep.end(), [](const auto& source) { return source->mayScatter(); });
    scatters_ = !sums_ && (deepScatters || (pass && pass->scatters(sample)));
    if (sums_) planes_ = emptySums(gbuffer.display, gbuffer.data);
    if (scatters_) planes_ = emptyPlanes(gbuffer.display, gbuffer.data);
  }

  Veil paint() {
    Veil veil(gbuffer_.data.width(), gbuffer_.data.height());
    if (settings_.deepOpaque) {
      veil.addScatter();
      lookedUp_ = Image<glm::vec3>(gbuffer_.data.width(), gbuffer_.data.height(), glm::vec3(0.0f));
    }
    const bool split = settings_.sortedTruth || settings_.tolerance;
    if (readsDepthAlone()) {
      pass_->leanFragments(sample_, [&](const LeanLists& lists) { compositeSorted(lists, gbuffer_.data, veil); });
      return veil;
    }
    PassSettings listed = sample_;
    if (sums_) listed.fog = nullptr;  // it enters sums as the GL pass has it do
    eachList(pass_, deep_, gbuffer_, listed, split ? VolumeRule::split : VolumeRule::midDepth,
             [&](const FragmentLists& lists) {
               if (!pass_) counts_.fragments += lists.fragments.size();
               tile(lists, veil);
             });
    if (sums_ && sample_.fog) {
      planes_.info.weight = sample_.weight;
      addFog(*sample_.fog, gbuffer_, sample_.sample, planes_);
    }
    if (sums_) return resolveSums(settings_.device, std::move(planes_), settings_.resolve, settings_.lookup, gbuffer_);
    if (!planes_.scatters()) return veil;
    const Backdrop backdrop = backdropOf(gbuffer_, planes_.solid);
    const Lookups lookups(backdrop, planes_, settings_.lookup);
    if (settings_.deepOpaque)
      showThroughHeldOut(lookups, lookedUp_, veil);
    else
      showThrough(lookups, veil);
    return veil;
  }

 private:
  void tile(const FragmentLists& given, Veil& veil) {
    if (sums_) {
      fold(given, planes_);
      return;
    }
    if (!scatters_) {
      composite(given, veil);
      return;
    }
    // Every method shows the same background, which the pixel's scattering layers alone decide. The truth depends on
    // no order either.
    if (settings_.sortedTruth || settings_.exactSums)
      foldExact(given, sample_.weight, sample_.normalisation, planes_);
    else
      foldScattering(given, planes_);
    FragmentLists shown = given;
    hideSolids(shown, planes_);
    composite(shown, veil);
  }

  bool readsDepthAlone() const {
    return settings_.sortedTruth && !settings_.tolerance && !stochastic_ && !scatters_ && !settings_.deepOpaque &&
           pass_ && deep_.empty() && !sample_.fog;
  }

  void composite(const FragmentLists& lists, Veil& veil) {
    const OitPlanes* scatter = scatters_ ? &planes_ : nullptr;
    if (!settings_.deepOpaque) {
      byMethod(lists, gbuffer_.data, &gbuffer_.beauty, scatter, veil);
      return;
    }
    const FragmentLists heldOut = holdOut(lists, *settings_.deepOpaque);
    if (heldOut.window.width() == 0) return;
    Veil row(heldOut.window.width(), 1);
    byMethod(heldOut, heldOut.window, nullptr, nullptr, row);
    addHeldOut(lists, heldOut, row, *settings_.deepOpaque, scatter, veil, lookedUp_);
  }

  void byMethod(const FragmentLists& lists, const Window& data, const Image<glm::vec4>* background,
                const OitPlanes* scatter, Veil& veil) {
    const MethodChoice choice{0, sample_.weight, sample_.normalisation};
    if (settings_.tolerance) {
      compositeWithin(lists, choice, data, background, scatter, *settings_.tolerance, veil, counts_.tolerance);
    } else if (stochastic_) {
      stochastic_->add(index_, lists, data, veil);
    } else if (settings_.sortedTruth) {
      compositeSorted(lists, data, veil);
    } else if (settings_.listMethod) {
      compositeBy(*settings_.listMethod, choice, lists, data, veil);
    } else {
      OitPlanes planes = emptySums(data, data);
      fold(lists, planes);
      veil = resolve(planes, settings_.resolve);
    }
  }

  OitPlanes emptySums(const Window& display, const Window& data) const {
    return sample_.tier == SumsTier::published ? emptyPublishedPlanes(display, data) : emptyPlanes(display, data);
  }

  void fold(const FragmentLists& lists, OitPlanes& planes) const {
    if (planes.published())
      foldPublished(lists, sample_.weight, planes, counts_.clamps);
    else if (settings_.exactSums)
      foldExact(lists, sample_.weight, sample_.normalisation, planes);
    else
      foldFragments(lists, sample_.weight, sample_.normalisation, planes);
  }

  TransparentPass* pass_;
  std::vector<std::unique_ptr<DeepSource>>& deep_;
  const RenderSettings& settings_;
  const PassSettings& sample_;
  const GBuffer& gbuffer_;
  RenderCounts& counts_;
  StochasticMean* stochastic_;  // null for other methods
  int index_;                   // of this pass
  bool sums_, scatters_;
  OitPlanes planes_;           // the sums, or what scatters
  Image<glm::vec3> lookedUp_;  // with a deep picture behind
};

// The flags that ask for this weight, with every bit of it.
std::string weightFlags(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  const std::string range =
      row && row->readsRange ? fmt::format(" --weight-range {}:{}", weight.rangeNear, weight.rangeFar) : "";
  return "--weight " + weightName(weight) + range;
}

// One pass of samples drawn on the device. What they show of the background is looked up by the sums' scattering
// planes: the pixel's scattering layers alone decide, under every method.
Veil sampleOnDevice(const RenderSettings& settings, TransparentPass& sums, const PassSettings& sample, int pass,
                    const GBuffer& gbuffer, StochasticMean& mean, PassStatistics& statistics) {
  const StochasticSettings& chosen = *settings.stochastic;
  StochasticPassSettings samples;
  samples.samples = chosen.samples;
  samples.first = pass;
  samples.step = settings.samples;
  samples.stratified = chosen.stratified;
  samples.winnersOnly = chosen.variant != StochasticSettings::Variant::depth;
  samples.seed = chosen.seed;
  Veil veil(gbuffer.data.width(), gbuffer.data.height());
  StochasticPlanes planes = settings.sampler->sample(sample, samples);
  if (sums.scatters(sample)) {
    PassSettings unlit = sample;  // of these sums only where they bend and spread is read
    unlit.shadows = nullptr;
    unlit.shadowRays = nullptr;
    unlit.occlusion.occluders = nullptr;
    OitPlanes scattering = sums.accumulate(unlit);
    const Backdrop backdrop = backdropOf(gbuffer, planes.solid);
    scattering.solid = planes.solid;
    hideSolids(scattering);
    planes.solid = scattering.solid;
    mean.add(planes, veil);
    showThrough(Lookups(backdrop, scattering, settings.lookup), veil);
  } else {
    mean.add(planes, veil);
  }
  const StochasticPassStatistics& done = settings.sampler->statistics();
  statistics.fragments = done.fragments;
  statistics.tiles = done.bands;
  statistics.passes = done.passes;
  statistics.bitsPerPixel = stochasticBits(chosen);
  statistics.shadowRays = done.shadowRays;
  statistics.shadowSeconds = done.shadowSeconds;
  return veil;
}

}  // namespace

void useMethod(const std::optional<ChosenMethod>& chosen, RenderSettings& settings) {
  settings.listMethod.reset();
  if (!chosen || chosen->name == "weighted") return;
  if (chosen->name == "blended") {
    settings.pass.weight.kind = shading::PLD_WEIGHT_UNIFORM;
    settings.pass.normalisation = shading::PLD_NORMALISE_SPECTRAL;
    return;
  }
  settings.listMethod = chosen;
}

void addStatistics(const PassStatistics& statistics, RenderCounts& counts) {
  counts.triangles = statistics.triangles;
  counts.chunks += statistics.chunks;
  counts.tiles += statistics.tiles;
  counts.fragments += statistics.fragments;
  counts.bitsPerPixel = statistics.bitsPerPixel;
  counts.solidBits = statistics.solidBits;
  counts.passes = statistics.passes;
  counts.pruned = statistics.pruned;
  counts.clamps += statistics.clamps;
  counts.shadowRays += statistics.shadowRays;
  counts.shadowSeconds += statistics.shadowSeconds;
}

Veil renderVeil(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const RenderSettings& settings,
                const GBuffer& gbuffer, const Camera& camera, Stages& stages, RenderCounts& counts) {
  VeilMean mean;
  std::optional<StochasticMean> stochastic;
  if (settings.stochastic && !settings.sortedTruth)
    stochastic.emplace(gbuffer.data.width(), gbuffer.data.height(), *settings.stochastic, settings.samples);
  PassStatistics statistics;
  for (int i = 0; i < settings.samples; ++i) {
    PassSettings sample = settings.pass;
    sample.sample = samplePosition(i, settings.samples);
    sample.footprint = 1.0f / std::sqrt(static_cast<float>(settings.samples));
    if (settings.systems && !settings.sortedTruth) {
      Veil veil = stages.time("passes of systems", [&] {
        return veilFromSystems(*pass, *settings.systems, settings, sample, gbuffer, counts);
      });
      statistics = pass->statistics();
      stages.time("average", [&] { mean.add(std::move(veil)); });
    } else if (stochastic && settings.sampler) {
      Veil veil = stages.time(
          "sample", [&] { return sampleOnDevice(settings, *pass, sample, i, gbuffer, *stochastic, statistics); });
      stages.time("average", [&] { mean.add(std::move(veil)); });
    } else if (settings.sortedTruth || settings.listMethod || stochastic || settings.tolerance || settings.exactSums ||
               settings.deepOpaque || !deep.empty() || !pass) {
      Veil veil = stages.time(settings.sortedTruth ? "lists and sort" : "lists and method", [&] {
        return ListPainter(pass, deep, settings, sample, gbuffer, counts, stochastic ? &*stochastic : nullptr, i)
            .paint();
      });
      if (pass) statistics = pass->statistics();
      stages.time("average", [&] { mean.add(std::move(veil)); });
    } else {
      OitPlanes planes = stages.time("transparent pass", [&] {
        return accumulateMixed(*pass, sample, gbuffer, camera, settings.lowResolution, statistics);
      });
      Veil veil = stages.time("resolve", [&] {
        return resolveSums(settings.device, std::move(planes), settings.resolve, settings.lookup, gbuffer);
      });
      stages.time("average", [&] { mean.add(std::move(veil)); });
    }
    if (!pass) continue;
    const int systemPasses = counts.passes;
    addStatistics(statistics, counts);
    if (settings.systems) counts.passes = systemPasses;
  }
  return stages.time("average", [&] {
    Veil veil = mean.finish();
    if (stochastic) stochastic->finish(veil);
    if (stochastic && settings.stochastic->adaptive > 0.0 && stochastic->pixelsSampled() > 0)
      spdlog::info("samples: {:.1f} a pixel on the average of those that hold a layer",
                   static_cast<double>(stochastic->samplesTaken()) * settings.samples /
                       static_cast<double>(stochastic->pixelsSampled()));
    return veil;
  });
}

void fitShotWeight(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const GBuffer& gbuffer,
                   PassSettings& settings, Stages& stages) {
  // Some thousand probes fix a mean error to about a percent.
  constexpr std::size_t kProbes = 16384;
  const WeightFit fit = stages.time("fit weight", [&] {
    WeightProbes probes(gbuffer, kProbes);
    PassSettings centre = settings;
    centre.sample = {0.5, 0.5};
    centre.probeCell = probes.cell();
    eachList(pass, deep, gbuffer, centre, VolumeRule::midDepth, [&](const FragmentLists& tile) { probes.add(tile); });
    return fitWeight(probes, settings.weight, settings.normalisation);
  });
  settings.weight = fit.weight;
  spdlog::info("--weight auto: mean error {:.4g} on {} probes; the same again: {}", fit.meanError, fit.probes,
               weightFlags(fit.weight));
}

}  // namespace pellucid::cli
