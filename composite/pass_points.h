// When within the shutter, and where on the lens, the N passes of --aa N stand.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace pellucid {

struct PassPoint {
  double time = 0.5;          // between the shutter's opening and its closing, (0,1)
  glm::dvec2 lens{0.5, 0.5};  // (0,1) in both, uniform: lensPoint() has it on an aperture
};

// One for each pass. Times are the middles of N equal parts, places on the lens a Hammersley set; both are dealt to the
// passes so that those whose places in the pixel (samplePosition()) are close are far apart in time and on the lens:
// of some permutations, made by an integer hash, the one with the largest least distance. A single pass stands in the
// middle of both.
std::vector<PassPoint> passPoints(int count);

// The same area of a disc of radius 1, or of a regular polygon in it whose first corner lies on +x.
//   blades  3 and more; below it the aperture is round
glm::dvec2 lensPoint(glm::dvec2 unitSquare, int blades);

}  // namespace pellucid
