#include "composite/pipeline/fit.h"

#include <fmt/format.h>

#include "composite/pipeline/drawn_probes.h"
#include "composite/study/fit_weight.h"
#include "gbuffer/weight_text.h"

namespace pellucid {

std::string weightFlags(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  std::string flags = "--weight " + weightName(weight);
  if (row && row->readsRange) flags += fmt::format(" --weight-range {}:{}", weight.rangeNear, weight.rangeFar);
  if (row && row->reference == WeightReference::unit && weight.reference != 1.0f)
    flags += fmt::format(" --weight-reference {}", weight.reference);
  return flags;
}

shading::WeightSettings fittedWeight(const PaintContext& context, PassPicture& moving, const PassSettings& sample,
                                     const std::string& flag) {
  std::size_t count = 0;
  const WeightFit fit = context.journal.time(kFitStage, [&] {
    DrawnProbes probes(context, moving, sample);
    count = probes.count();
    return fitWeight(
        sample.weight, probes.depths(),
        [&](const shading::WeightSettings& weight) { return probes.roughError(weight); },
        [&](const shading::WeightSettings& weight) { return probes.error(weight); }, probes.rounding());
  });
  context.journal.note(fmt::format("{}{}: mean error {:.4g} on {} probes with layers; the same again: {}", flag,
                                   context.plan.weightReason.empty() ? "" : ", " + context.plan.weightReason,
                                   fit.meanError, count, weightFlags(fit.weight)));
  return fit.weight;
}

}  // namespace pellucid
