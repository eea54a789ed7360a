#include "engine_bridge/scene/ambient.h"

#include <cmath>

namespace pellucid {

// The diffuse level is the mean by the cosine, D(n) = L0 + 2/3 L1 n + ..., so the first moment of D is 2/9 of L1.
AmbientLight ambientOf(const Surroundings& surroundings) {
  constexpr int kDirections = 4096;
  const double golden = 3.883222077450933;  // of Fibonacci's sphere, radians
  glm::dvec3 mean(0.0), moments[3] = {};
  for (int i = 0; i < kDirections; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / kDirections, across = std::sqrt(1.0 - y * y), turn = golden * i;
    const glm::dvec3 direction(across * std::cos(turn), y, across * std::sin(turn));
    const glm::dvec3 light(glm::vec3(
        surroundings.at(shading::directionTaps(glm::vec3(direction), shading::PLD_DIFFUSE_LEVEL, surroundings.edge))));
    mean += light / static_cast<double>(kDirections);
    for (int c = 0; c < 3; ++c) moments[c] += direction * (light[c] / kDirections);
  }
  AmbientLight ambient;
  ambient.mean = glm::vec3(mean);
  for (int c = 0; c < 3; ++c) ambient.slope[c] = 4.5 * moments[c];
  return ambient;
}

}  // namespace pellucid
