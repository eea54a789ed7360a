// Where a light looks from and at: the faces of its shadow map.
#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

struct LightView {
  Camera camera;       // looks along the light's way
  double inner = 0.0;  // part of the edge, on every side, that belongs to the faces beside this one. [0, 1/2)
  double back = 0.0;   // directional: metres that the camera stands behind the origin of lightFromWorld()
};

struct LightViews {
  std::vector<LightView> faces;  // empty: nothing there to cast
  bool radial = false;           // depth is the distance to the light, else along its direction
  // depth = -z in lightFromWorld(), or distance, metres, times scale plus offset: about -1 to 1, or 0 to 1, over the
  // casters.
  double scale = 1.0, offset = 0.0;
};

// An axis-parallel box, empty until something is added.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  bool empty() const { return !(low.x <= high.x); }
  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

enum class Casters { transparent, opaque };
// Whether a material's shadow is in a map of that kind.
bool castsInto(Casters kind, const Material& material);
// Of all that casts, in the space that `toSpace` maps the world to; `farthest` is its greatest distance from there.
Bounds casterBounds(const Scene& scene, Casters kind, const glm::dmat4& toSpace, double& farthest);
// The same of the G-buffer's points, and of the eye.
Bounds pictureBounds(const GBuffer& gbuffer, const Camera& camera, const glm::dmat4& toSpace, double& farthest);

// The space of a light that looks down -z, from its position or, when it has only a direction, from the origin.
glm::dmat4 lightFromWorld(const Light& light);

// Views that hold everything in `casters`, of which `needed` may cut away what lies to the side of it.
//   casters, farthest  in lightFromWorld()
//   margin             part of a face's edge that stays free on every side, for filters
LightViews lightViews(const Light& light, const Bounds& casters, double farthest, const Bounds& needed, double margin);

}  // namespace pellucid
