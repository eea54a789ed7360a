// The light in the air of a shot: what surfaces, fog and particles leave of its lamps, for fog and particles to look
// up.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "composite/pipeline/shot.h"
#include "engine_bridge/embree/air_shadows.h"
#include "engine_bridge/scene/blocks.h"
#include "engine_bridge/scene/fog_light.h"
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

// What the air leaves of a light on surfaces: fog, and particles where shadow maps do not hold them. Neither rays nor
// maps meet either of them, so what they say of surfaces is multiplied by this wherever a surface asks for a light.
class AirBetween {
 public:
  //   fog        null: none
  //   particles  whether they count here
  // The shot must outlive this.
  AirBetween(const Shot& shot, std::shared_ptr<const Fog> fog, bool particles);

  bool clear() const { return !fog_ && !particles_; }
  // At one point, view space. [0,1]
  float passed(const PunctualLight& light, const glm::dvec3& point) const;

  // The same for all pixels of a picture, in two parts. Closed forms cost little and are asked for every sample of a
  // pixel, so that the edges of a box are as smooth as those of glass; grids are marched once, to the pixel's centre.
  //   light  index into Scene::lights
  AirPassed bySample(std::size_t light) const;
  void dimByGrids(std::size_t light, Image<glm::vec3>& visibility) const;

 private:
  float byGrids(const PunctualLight& light, const glm::dvec3& point) const;

  const Shot& shot_;
  std::optional<FogLight> fog_;
  std::optional<Fog> particles_;
  double step_ = 0.0;
};

// What of the lamps reaches the particles. Null where no particle is lit by a lamp, or texels is 0.
//   fog     which they lie in, or behind; null: none
//   texels  along the longest edge
std::shared_ptr<const LightVolume> lightInParticles(const Shot& shot, Air& air, std::shared_ptr<const Fog> fog,
                                                    int texels, Journal& journal);

}  // namespace pellucid
