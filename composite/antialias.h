// Where the N passes of --aa N sample the pixel.
#pragma once
#include <glm/glm.hpp>

namespace pellucid {

// Position of sample `index` of `count` in the pixel, (0..1, y down); (0.5, 0.5) for a single one. 4, 8 and 16 samples
// are sets searched for the least error of a straight edge over all slopes and places (for 16: at most 1.64/16 of a
// pixel, 0.4/16 in the mean; no set of 16 points keeps every slope within 1/16); other counts are Hammersley's.
glm::dvec2 samplePosition(int index, int count);

}  // namespace pellucid
