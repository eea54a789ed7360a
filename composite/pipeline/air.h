// The light in the air of a shot: what surfaces, fog and particles leave of its lamps, for fog and particles to look
// up.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "composite/pipeline/shot.h"
#include "engine_bridge/embree/air_shadows.h"
#include "engine_bridge/scene/blocks.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid {

// Whether a primitive's triangles are particles, which rays do not meet.
bool isParticle(const Primitive& primitive, const Material& material);

// How much of a light of the shot reaches a point: by shadow maps where they were drawn, else by rays, and through the
// particles, which rays do not meet.
class Air {
 public:
  //   maps  null: rays
  // The others must outlive this.
  Air(const Shot& shot, std::shared_ptr<const ShadowMaps> maps, Journal& journal);
  bool hasParticles() const { return particles_.has_value(); }
  const Fog& particles() const { return *particles_; }  // as a medium
  // In the order of lightBlocks().
  PointVisibility surfaces();  // without particles, where they are not in the maps
  PointVisibility surfacesAndParticles();
  const std::vector<std::size_t>& lights() const { return numbers_; }

 private:
  const AirShadows& rays();
  const Shot& shot_;
  Journal& journal_;
  std::shared_ptr<const ShadowMaps> maps_;
  Scene whole_;  // where the shot's own triangles lie in their files
  std::unique_ptr<AirShadows> rays_;
  std::vector<std::size_t> numbers_;  // into Scene::lights
  std::optional<Fog> particles_;
  double step_ = 0.0;
};

// What particles leave of a light on what is opaque, by their density: multiplies. Rays do not meet them.
//   light  index into Scene::lights
class ParticleShadows {
 public:
  explicit ParticleShadows(const Shot& shot);
  void dim(std::size_t light, Image<glm::vec3>& visibility) const;
  // At one point, view space. [0,1]
  float passed(const PunctualLight& light, const glm::dvec3& point) const;

 private:
  const Shot& shot_;
  std::optional<Fog> particles_;
  double step_ = 0.0;
};

// What of the lamps reaches the particles. Null where no particle is lit by a lamp, or texels is 0.
//   texels  along the longest edge
std::shared_ptr<const LightVolume> lightInParticles(const Shot& shot, Air& air, int texels, Journal& journal);

}  // namespace pellucid
