#include "gbuffer/camera_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {

bool sameView(const Camera& a, const Camera& b) {
  // Attributes are floats: 6e-8 of every entry, and some products of them.
  constexpr double kSlack = 1e-5;
  if (a.orthographic != b.orthographic) return false;
  const glm::dmat4 worldA = glm::inverse(a.viewFromWorld), worldB = glm::inverse(b.viewFromWorld);
  for (int axis = 0; axis < 3; ++axis)
    if (!(glm::length(worldA[axis] - worldB[axis]) <= kSlack)) return false;
  const double reach = std::max(1.0, glm::length(glm::dvec3(worldA[3])));
  if (!(glm::length(worldA[3] - worldB[3]) <= kSlack * reach)) return false;
  for (int i = 0; i < 2; ++i) {
    const double focal = std::abs(a.focal[i]);
    if (!(std::abs(a.focal[i] - b.focal[i]) <= kSlack * focal)) return false;
    // Of an orthographic camera the centre moves with its place.
    const double centre = a.orthographic ? std::max(1.0, focal * reach) : 1.0;
    if (!(std::abs(a.centre[i] - b.centre[i]) <= kSlack * centre)) return false;
  }
  return true;
}

std::string viewText(const Camera& camera) {
  const glm::dmat4 world = glm::inverse(camera.viewFromWorld);
  const auto clean = [](double value) { return std::abs(value) < 1e-9 ? 0.0 : value; };  // no "-0"
  return fmt::format(
      "{}at ({:.6g}, {:.6g}, {:.6g}) along ({:.4g}, {:.4g}, {:.4g}), focal ({:.6g}, {:.6g}), centre "
      "({:.4g}, {:.4g})",
      camera.orthographic ? "orthographic " : "", clean(world[3].x), clean(world[3].y), clean(world[3].z),
      clean(-world[2].x), clean(-world[2].y), clean(-world[2].z), camera.focal.x, camera.focal.y,
      clean(camera.centre.x), clean(camera.centre.y));
}

}  // namespace pellucid
