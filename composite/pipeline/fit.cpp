#include "composite/pipeline/fit.h"

#include <fmt/format.h>

#include "composite/study/fit_weight.h"
#include "gbuffer/weight_text.h"

namespace pellucid {

std::string weightFlags(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  const std::string range =
      row && row->readsRange ? fmt::format(" --weight-range {}:{}", weight.rangeNear, weight.rangeFar) : "";
  return "--weight " + weightName(weight) + range;
}

shading::WeightSettings fittedWeight(const PaintContext& context, const PassSettings& sample) {
  // Some thousand probes fix a mean error to about a percent.
  constexpr std::size_t kProbes = 16384;
  const WeightFit fit = context.journal.time("fit weight", [&] {
    WeightProbes probes(*context.picture.gbuffer, kProbes);
    PassSettings centre = sample;
    centre.sample = {0.5, 0.5};
    centre.probeCell = probes.cell();
    context.sources.each({centre, context.picture, VolumeRule::midDepth},
                         [&](const FragmentLists& lists) { probes.add(lists); });
    return fitWeight(probes, sample.weight, sample.normalisation);
  });
  context.journal.note(fmt::format("--weight auto: mean error {:.4g} on {} probes; the same again: {}", fit.meanError,
                                   fit.probes, weightFlags(fit.weight)));
  return fit.weight;
}

}  // namespace pellucid
