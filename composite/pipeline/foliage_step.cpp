#include "composite/pipeline/foliage_step.h"

#include <fmt/format.h>

#include "composite/picture_occluders.h"
#include "gbuffer/errors.h"

namespace pellucid {

void checkFoliage(const FoliageRequest& request) {
  if (request.rule == FoliageRule::off) {
    const std::pair<bool, const char*> details[] = {{request.form.has_value(), "--occlusion-inference"},
                                                    {request.directShare.has_value(), "--occlusion-direct"},
                                                    {request.fromFile.has_value(), "--occlusion-source"},
                                                    {request.radius.has_value(), "--occlusion-radius"}};
    for (const auto& [given, flag] : details)
      if (given) throw UsageError(fmt::format("{}: found it with --occlusion off, expected inferred or solid", flag));
  }
  if (!request.form) return;
  if (request.rule == FoliageRule::solid)
    throw UsageError("--occlusion-inference: found it with --occlusion solid, expected inferred");
  if (request.rule == FoliageRule::apart)
    throw UsageError("--occlusion-inference: found it with --occlusion apart, expected it of resolve");
}

void applyFoliage(const FoliageRequest& request, OcclusionSettings& settings) {
  if (request.rule == FoliageRule::off) return;
  settings.rims = request.rule == FoliageRule::inferred;
  settings.form = request.form.value_or(shading::PLD_OCCLUSION_RELATIVE);
  settings.directShare = static_cast<float>(request.directShare.value_or(0.0));
}

void placeOccluders(const FoliageRequest& request, PassSettings& settings, TransparentPass& pass,
                    const GBuffer& gbuffer, const Camera& camera, Journal& journal) {
  if (request.rule == FoliageRule::off || !pass.wantsOccluders(settings)) return;
  const Image<float> solidZ = journal.time("depth of leaves", [&] { return pass.solidDepth(settings); });
  OccluderSettings how;
  how.fromFile = request.fromFile.value_or(true);
  how.screen.radius = request.radius.value_or(0.0);
  std::size_t pixels = 0;
  settings.occlusion.occluders = journal.time("occlusion of leaves", [&] {
    return std::make_shared<OccluderPlanes>(
        occludersOf(gbuffer, camera, nearestSolids(gbuffer, solidZ), how, nullptr, pixels));
  });
  if (pixels > 0)
    journal.note(
        fmt::format("leaves: occlusion of {} pixels from depth alone{}", pixels,
                    gbuffer.occlusion.empty() || !how.fromFile ? "" : ", where leaves stand that the picture lacks"));
}

}  // namespace pellucid
