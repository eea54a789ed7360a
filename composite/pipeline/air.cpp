#include "composite/pipeline/air.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine_bridge/scene/particle_grid.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {
namespace {

constexpr int kParticleCells = 128;  // of their density, along the longest edge

bool staysInFiles(const Scene& scene) {
  return std::any_of(scene.primitives.begin(), scene.primitives.end(),
                     [](const Primitive& primitive) { return primitive.streamed && !primitive.points; });
}

}  // namespace

bool isParticle(const Primitive& primitive, const Material& material) {
  return material.transparent() && (primitive.points || material.billboard);
}

AirBetween::AirBetween(const Shot& shot, std::shared_ptr<const Fog> fog, bool particles) : shot_(shot) {
  if (fog) fog_.emplace(std::move(fog));
  const auto grid = particles ? particleGrid(shot.scene, kParticleCells) : nullptr;
  if (!grid) return;
  particles_ = particleFog(grid, shot.camera, {});
  step_ = glm::length(glm::dvec3(glm::inverse(grid->boxFromWorld)[0])) / grid->density.size.x;
}

float AirBetween::byGrids(const PunctualLight& light, const glm::dvec3& point) const {
  float passed = fog_ && fog_->marches() ? fog_->passed(light, point) : 1.0f;
  const float depth = particles_ ? gridDepth(*particles_, light, point, step_) : 0.0f;
  if (depth > 0.0f) passed *= std::exp(-depth);
  return passed;
}

float AirBetween::passed(const PunctualLight& light, const glm::dvec3& point) const {
  const float passed = byGrids(light, point);
  return fog_ && !fog_->marches() ? passed * fog_->passed(light, point) : passed;
}

AirPassed AirBetween::bySample(std::size_t light) const {
  if (!fog_ || fog_->marches()) return {};
  const PunctualLight block = lightBlock(shot_.scene.lights[light], shot_.camera);
  return [this, block](const glm::dvec3& point) { return fog_->passed(block, point); };
}

void AirBetween::dimByGrids(std::size_t light, Image<glm::vec3>& visibility) const {
  if (!particles_ && !(fog_ && fog_->marches())) return;
  const GBuffer& gbuffer = shot_.opaque.gbuffer;
  const PunctualLight block = lightBlock(shot_.scene.lights[light], shot_.camera);
  const PixelRays rays = pixelRays(shot_.camera, gbuffer.display, {gbuffer.data.x0, gbuffer.data.y0}, {0.5, 0.5});
  tbb::parallel_for(0, visibility.height(), [&](int y) {
    for (int x = 0; x < visibility.width(); ++x) {
      const double z = static_cast<double>(gbuffer.viewZ.at(x, y));
      if (!std::isfinite(z)) continue;
      const glm::dvec2 at(rays.offset + rays.scale * glm::vec2(static_cast<float>(x), static_cast<float>(y)));
      visibility.at(x, y) *= byGrids(block, glm::dvec3(rays.orthographic ? at : at * z, -z));
    }
  });
}

Air::Air(const Shot& shot, std::shared_ptr<const ShadowMaps> maps, Journal& journal)
    : shot_(shot), journal_(journal), maps_(std::move(maps)) {
  for (std::size_t i = 0; i < shot.scene.lights.size(); ++i)
    if (shines(shot.scene.lights[i])) numbers_.push_back(i);
  if (const auto grid = particleGrid(shot.scene, kParticleCells)) {
    particles_ = particleFog(grid, shot.camera, lightBlocks(shot.scene.lights, shot.camera));
    const glm::dmat4 worldFromBox = glm::inverse(grid->boxFromWorld);
    step_ = glm::length(glm::dvec3(worldFromBox[0])) / grid->density.size.x;
  }
}

const AirShadows& Air::rays() {
  if (!rays_) {
    const bool decodes = staysInFiles(shot_.scene);
    if (decodes) whole_ = decodedScene(shot_.scene);
    rays_ = std::make_unique<AirShadows>(decodes ? whole_ : shot_.scene, shot_.camera);
    if (!rays_->hasOpaque())
      journal_.note("light in the air: the glTF holds nothing opaque, so nothing opaque casts shadows there");
  }
  return *rays_;
}

PointVisibility Air::surfaces() {
  if (maps_)
    return [this](std::size_t light, const glm::dvec3& point) {
      return maps_->visibility(numbers_[light], glm::vec3(point));
    };
  const AirShadows& shadows = rays();
  return [&shadows](std::size_t light, const glm::dvec3& point) { return shadows.visible(light, point); };
}

PointVisibility Air::surfacesAndParticles() {
  PointVisibility surfaces = this->surfaces();
  if (maps_ || !particles_) return surfaces;  // particles cast into maps as everything does
  return [this, surfaces](std::size_t light, const glm::dvec3& point) {
    const glm::vec3 passed = surfaces(light, point);
    if (passed == glm::vec3(0.0f)) return passed;
    return passed * std::exp(-gridDepth(*particles_, particles_->lights[light], point, step_));
  };
}

std::shared_ptr<const LightVolume> lightInParticles(const Shot& shot, Air& air, std::shared_ptr<const Fog> fog,
                                                    int texels, Journal& journal) {
  const bool lit = std::any_of(shot.scene.primitives.begin(), shot.scene.primitives.end(), [&](const Primitive& each) {
    const Material& material = shot.scene.materials[static_cast<std::size_t>(each.material)];
    return isParticle(each, material) && !material.unlit && !material.additive;
  });
  if (!lit || texels == 0 || air.lights().empty() || !air.hasParticles()) return nullptr;
  return journal.time("light in particles", [&] {
    MediumSettings bounds;
    bounds.grid = air.particles().grid;
    Fog clear = air.particles();
    clear.grid = nullptr;  // what stands in the way is all in the visibility
    PointVisibility visible = air.surfacesAndParticles();
    if (fog)
      visible = [&, nearer = visible, between = FogLight(fog)](std::size_t light, const glm::dvec3& point) {
        const glm::vec3 passed = nearer(light, point);
        return passed == glm::vec3(0.0f) ? passed : passed * between.passed(clear.lights[light], point);
      };
    return sampleLights(clear, fogBounds(bounds, shot.camera, shot.opaque.gbuffer), texels, visible);
  });
}

}  // namespace pellucid
