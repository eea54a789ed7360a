#include "composite/cli/render.h"

#include "composite/antialias.h"
#include "composite/over.h"

namespace pellucid::cli {

Veil renderVeil(TransparentPass& pass, const RenderSettings& settings, const GBuffer& gbuffer, Stages& stages,
                RenderCounts& counts) {
  VeilMean mean;
  for (int i = 0; i < settings.samples; ++i) {
    PassSettings sample = settings.pass;
    sample.sample = samplePosition(i, settings.samples);
    if (settings.sortedTruth) {
      Veil veil(gbuffer.data.width(), gbuffer.data.height());
      stages.time("lists and sort", [&] {
        pass.fragments(sample, [&](const FragmentLists& tile) { compositeSorted(tile, gbuffer.data, veil); });
      });
      stages.time("average", [&] { mean.add(veil); });
    } else {
      const OitPlanes planes = stages.time("transparent pass", [&] { return pass.accumulate(sample); });
      const Veil veil = stages.time("resolve", [&] { return resolve(planes, settings.resolve); });
      stages.time("average", [&] { mean.add(veil); });
    }
    const PassStatistics& statistics = pass.statistics();
    counts.triangles = statistics.triangles;
    counts.chunks += statistics.chunks;
    counts.tiles += statistics.tiles;
    counts.fragments += statistics.fragments;
  }
  return stages.time("average", [&] { return mean.finish(); });
}

}  // namespace pellucid::cli
