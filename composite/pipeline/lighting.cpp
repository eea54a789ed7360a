#include "composite/pipeline/lighting.h"

#include <utility>

#include "composite/pipeline/fog_step.h"
#include "composite/pipeline/surface_light.h"

namespace pellucid {

bool meetsRays(const Request& request) {
  return request.shadows.byRays();
}

void Lighting::applyTo(ShadingSettings& settings, const Shot& shot) const {
  settings.surroundings = shot.surroundings;
  settings.environment = shot.environment;
  settings.shadows = shadows.maps;
  settings.shadowRays = surfaces;
  settings.particleLight = particles;
  settings.fog = fog;
}

namespace {

// The picture with another beauty. Its other planes show those of the shot, which outlives them.
GBuffer relitOf(const GBuffer& picture, Image<glm::vec4> beauty) {
  GBuffer relit;
  relit.display = picture.display;
  relit.data = picture.data;
  relit.pixelAspect = picture.pixelAspect;
  relit.beauty = std::move(beauty);
  relit.hasAlpha = picture.hasAlpha;
  relit.viewZ = picture.viewZ.shown(nullptr);
  relit.depthPrecision = picture.depthPrecision;
  relit.occlusion = picture.occlusion.shown(nullptr);
  relit.camera = picture.camera;
  return relit;
}

}  // namespace

std::unique_ptr<Lighting> lightShot(const Request& request, const Shot& shot, Device& device, Journal& journal) {
  auto lighting = std::make_unique<Lighting>();
  const PlacedFog placed = placeFogOf(request.fog, request.scatter, shot, request.shot.scene.metresPerUnit, journal);
  lighting->shadows = journal.time(
      "shadows", [&] { return castShadows(request.shadows, shot, placed.fog, request.passes, device, journal); });
  lighting->picture = {&shot.opaque.gbuffer, &shot.opaque.gbuffer, shot.deepOpaque.get()};
  if (!lighting->shadows.beauty.empty()) {
    lighting->relit = relitOf(shot.opaque.gbuffer, std::move(lighting->shadows.beauty));
    lighting->picture.gbuffer = lighting->picture.centres = &lighting->relit;
  }
  if (lighting->shadows.deepOpaque) lighting->picture.deepOpaque = lighting->shadows.deepOpaque.get();
  Air air(shot, lighting->shadows.maps, journal);
  lighting->fog = lightFog(placed, shot, air, journal);
  if (shot.hasScene) lighting->particles = lightInParticles(shot, air, placed.fog, request.particleLight, journal);
  lighting->surfaces = journal.time("shadows", [&] { return surfaceLight(lighting->shadows, shot, placed.fog); });
  return lighting;
}

}  // namespace pellucid
