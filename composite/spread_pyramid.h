// The backdrop at coarser and coarser resolution, so that a wide Gaussian reads few texels. Each level halves the last
// with the mask (1 3 3 1)/8 in both axes: its texels' footprints tend to quadratic B-splines, of which a Gaussian's
// samples one standard deviation apart make a Gaussian again. Texels hold sums over the diffusing pixels alone, so what
// is not seen through the glass does not leak into it.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "composite/gather.h"

namespace pellucid {

class SpreadPyramid {
 public:
  // Levels as `largestSpread` (pixels) needs them.
  SpreadPyramid(const Backdrop& backdrop, const OitPlanes& planes, float largestSpread);

  // The level that a spread reads; 0 is the picture itself, which this class does not hold.
  static int levelFor(float spread);

  //   centre      pixels, +0.5 at a pixel's centre
  //   spread      standard deviation, pixels; levelFor(spread) > 0
  //   scattererZ  what stands nearer than this is rejected, planar metres
  Gathered gather(glm::vec2 centre, float spread, float scattererZ) const;

 private:
  // Means are over mass. `rate` is 1 / depth, 0 for sky.
  struct Texel {
    glm::vec4 colour{0.0f};  // sum of colour over diffusing pixels, of which `mass` is the sum of weights
    float mass = 0.0f;       // [0,1]
    float leastVariance = 0.0f, meanVariance = 0.0f, mostVariance = 0.0f;
    float leastRate = 0.0f, meanRate = 0.0f, mostRate = 0.0f;
    float spare = 0.0f;
  };
  // Texels lie from -kMargin: beyond, a clamped picture repeats them exactly.
  struct Level {
    int width = 0, height = 0;
    Image<Texel> texels;
    const Texel& clamped(int x, int y) const;
  };
  template <class Fetch>
  static Level halve(int width, int height, const Fetch& fetch);

  std::vector<Level> levels_;  // [0] is level 1
};

}  // namespace pellucid
