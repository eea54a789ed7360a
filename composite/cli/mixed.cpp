#include "composite/cli/mixed.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/low_resolution.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {

void LowResFlags::addTo(CLI::App& verb) {
  option = verb.add_option("--low-res", factor,
                           "Draw materials marked lowResolution at 1/N of the resolution; 1 draws them like the others")
               ->check(CLI::IsMember({1, 2, 4, 8}))
               ->capture_default_str();
}

int LowResFlags::factorFor(const Scene& scene, const std::string& why) const {
  const bool marked = std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
    return material.lowResolution && material.transparent();
  });
  const bool asked = option && option->count() > 0 && factor > 1;
  if (asked && !marked)
    throw UsageError(fmt::format(
        "--low-res: found {}, but no transparent material is marked; expected --set MATERIAL.lowResolution=true",
        factor));
  if (!marked || factor == 1) return 1;
  if (why.empty()) return factor;
  if (asked)
    throw UsageError(fmt::format("--low-res: found {} with {}, expected 1: it draws every fragment", factor, why));
  spdlog::info("{} draws every fragment: materials marked lowResolution are drawn at full resolution", why);
  return 1;
}

OitPlanes accumulateMixed(TransparentPass& pass, const PassSettings& settings, const GBuffer& gbuffer,
                          const Camera& camera, int factor, PassStatistics& statistics) {
  if (factor == 1) {
    OitPlanes planes = pass.accumulate(settings);
    statistics = pass.statistics();
    return planes;
  }
  PassSettings part = settings;
  part.layers = LayerChoice::fullResolution;
  OitPlanes planes = pass.accumulate(part);
  statistics = pass.statistics();
  const LowView view = lowViewOf(gbuffer, planes.solid, camera, factor);
  part.layers = LayerChoice::lowResolution;
  part.fog = nullptr;
  pass.over(view.gbuffer, view.camera);
  OitPlanes low;
  try {
    low = pass.accumulate(part);
  } catch (...) {
    pass.over(gbuffer, camera);
    throw;
  }
  const PassStatistics& added = pass.statistics();
  statistics.chunks += added.chunks;
  statistics.tiles += added.tiles;
  statistics.fragments += added.fragments;
  statistics.seconds += added.seconds;
  statistics.passes += added.passes;
  statistics.bitsPerPixel += added.bitsPerPixel / (factor * factor);
  pass.over(gbuffer, camera);
  addLowResolution(low, view, settings.sample, planes);
  return planes;
}

}  // namespace pellucid::cli
