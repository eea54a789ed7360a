#include "composite/pipeline/painter.h"

namespace pellucid {

std::unique_ptr<Painter> makePainter(const PaintContext& context) {
  const Plan& plan = context.plan;
  if (plan.route == Route::samplesOnDevice) return deviceSamplesPainter(context);
  if (plan.as<PaintSystems>()) return systemsPainter(context);
  if (plan.as<PaintSorted>()) return sortedPainter(context);
  if (plan.as<PaintListed>()) return listedPainter(context);
  if (plan.as<PaintSamples>()) return samplesPainter(context);
  if (plan.as<PaintWithin>()) return withinPainter(context);
  return sumsPainter(context);
}

}  // namespace pellucid
