#include "composite/pipeline/fog_step.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/pipeline/fog_text.h"
#include "engine_bridge/scene/ambient.h"
#include "engine_bridge/scene/density_grid.h"
#include "engine_bridge/scene/fog_grids.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// All grids of a request as one; what each is taken for, and why, is noted.
std::shared_ptr<const DensityGrid> gridsOf(const std::vector<FogGrid>& asked, const FogText& text, double metresPerUnit,
                                           const Shot& shot, Journal& journal) {
  std::vector<std::string> notes;
  std::vector<RoledGrid> grids;
  for (const FogGrid& each : asked) {
    GridOptions options;
    options.name = each.name;
    options.preferred = nameOf(each.role);
    options.metresPerUnit = metresPerUnit;
    options.zUp = text.zUp;
    grids.push_back({readDensityGrid(each.path, options, notes), each.role});
    if (asked.size() > 1 || each.role != GridRole::density)
      notes.push_back(fmt::format("--fog-grid {}{}{}: as {}; =density, =emission or =temperature says otherwise",
                                  each.path, each.name.empty() ? "" : ":", each.name, nameOf(each.role)));
  }
  GlowSettings glow;
  glow.emission = text.emission.value_or(glow.emission);
  glow.absorption = text.blackbody.value_or(glow.absorption);
  glow.kelvin = text.kelvin.value_or(glow.kelvin);
  glow.fromRec709 = shot.opaque.space.fromRec709;
  auto joined = joinedGrids(grids, glow, notes);
  journal.note(notes);
  return joined;
}

}  // namespace

PlacedFog placeFogOf(const FogRequest& request, const ScatterSettings& scatter, const Shot& shot, double metresPerUnit,
                     Journal& journal) {
  if (!request.on()) return {};
  if (!shot.hasCamera)
    throw MeaningError(
        fmt::format("{}: no camera: found deep files alone and no worldToCamera, expected --camera eye=...: fog is "
                    "marched along rays",
                    shot.opaque.document.path));
  FogText text = request.text ? *request.text : request.file.empty() ? FogText() : readFogFile(request.file);
  checkFog(text, request.grids);
  MediumSettings& medium = text.medium;
  if (!request.grids.empty()) {
    if (!text.hasDensity) medium.density = 1.0;
    medium.grid = journal.time("read grid", [&] { return gridsOf(request.grids, text, metresPerUnit, shot, journal); });
  }
  // Where a grid says what emits, the key is what its values are worth.
  const bool byGrid = std::any_of(request.grids.begin(), request.grids.end(),
                                  [](const FogGrid& grid) { return grid.role == GridRole::emission; });
  if (text.emission && !byGrid) medium.emission = *text.emission;
  AmbientLight ambient{shot.surroundings, {}};
  if (shot.environment) ambient = ambientOf(*shot.environment);
  Fog placed = placeFog(medium, shot.camera, ambient, lightBlocks(shot.scene.lights, shot.camera));
  placed.diffusion = {scatter.k0, scatter.k1, scatter.netCoverage ? 1 : 0,
                      static_cast<float>(focalPixels(shot.camera, shot.opaque.gbuffer.display)),
                      shot.camera.orthographic ? 1 : 0};
  return {std::make_shared<const Fog>(std::move(placed)), medium, text.shafts};
}

std::shared_ptr<const Fog> lightFog(const PlacedFog& placed, const Shot& shot, Air& air, Journal& journal) {
  if (!placed.fog || placed.fog->lights.empty()) return placed.fog;
  // What the grid itself leaves of the lights belongs to the grid, not to shafts.
  constexpr int kGridTexels = 96;
  if (placed.shafts == 0 && !placed.medium.grid) return placed.fog;
  auto lit = std::make_shared<Fog>(*placed.fog);
  const Box bounds = fogBounds(placed.medium, shot.camera, shot.opaque.gbuffer);
  lit->visibility = journal.time("light in fog", [&] {
    return placed.shafts > 0 ? sampleLights(*placed.fog, bounds, placed.shafts, air.surfacesAndParticles())
                             : sampleLights(*placed.fog, bounds, kGridTexels, nullptr);
  });
  return lit;
}

}  // namespace pellucid
