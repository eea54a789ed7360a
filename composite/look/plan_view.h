// A shot from above: what the camera sees, where it stands, and where the parts of a scene lie.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gbuffer/gbuffer.h"

namespace pellucid {

struct ScenePart {
  std::string name;
  glm::dvec3 least, most;  // world, metres
  bool transparent = true;
};

// x to the right, z downwards, seen from +y. Opaque surfaces are dots of their colour. What lies far outside of the
// rest is cut off.
std::string planSvg(const GBuffer& gbuffer, const Camera& camera, const std::vector<ScenePart>& parts);

}  // namespace pellucid
