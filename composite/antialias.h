// Where the N passes of --aa N sample the pixel.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/pixel_filter.h"

namespace pellucid {

// Position of sample `index` of `count` in the pixel, (0..1, y down); (0.5, 0.5) for a single one. 4, 8 and 16 samples
// are sets searched for the least error of a straight edge over all slopes and places (for 16: at most 1.64/16 of a
// pixel, 0.4/16 in the mean; no set of 16 points keeps every slope within 1/16); other counts are Hammersley's.
glm::dvec2 samplePosition(int index, int count);
// The same drawn from a pixel filter, so that the plain mean of all is filtered by it: beyond (0..1) for filters wider
// than the pixel. The pixel's square changes no bit, and a single sample is at the centre under any.
glm::dvec2 samplePosition(int index, int count, const PixelFilter& filter);

}  // namespace pellucid
