// One hair: a curve that grows out of the scalp, falls, and waves with its lock.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pellucid::samples {

// The head that hair grows on and slides over: world, metres.
struct Ball {
  glm::dvec3 centre;
  double radius;
};
inline const Ball kSkull{{0.0, 1.6, -0.008}, 0.098};
inline const Ball kBody[] = {
    kSkull, {{0.0, 1.552, 0.026}, 0.073}, {{0.0, 1.572, 0.097}, 0.01}, {{0.0, 1.48, -0.01}, 0.045}};

// Whether hair grows where the skull looks along this unit direction: above the brow, lower at the back.
bool growsHair(glm::dvec3 direction);

struct Strand {
  std::vector<glm::dvec3> points;  // from root to tip
  double depth = 0.0;              // within its lock and the hair: 0 outside, 1 next to the skin
  double shade = 0.0;              // of its lock, [-1, 1]
};

// The same number grows the same hair, whatever the others.
Strand growStrand(std::uint32_t number, int segments);

}  // namespace pellucid::samples
