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
  // Levels as `largestSpread` (pixels) needs them. The arguments must outlive this.
  SpreadPyramid(const Backdrop& backdrop, const OitPlanes& planes, float largestSpread);

  // The level that a spread reads; 0 is the picture itself, which this class does not hold.
  static int levelFor(float spread);

  //   centre      pixels, +0.5 at a pixel's centre
  //   spread      standard deviation, pixels; levelFor(spread) > 0
  //   scattererZ  what stands nearer than this is rejected, planar metres
  Gathered gather(glm::vec2 centre, float spread, float scattererZ) const;

 private:
  // How a property is spread over a texel. Two sorts of pixels (a pane's and those beside it, a lamp and the wall
  // behind) are told apart exactly by these moments, as is what each sort contributes to the colour.
  struct Property {
    float least = 0.0f, most = 0.0f;
    float mass = 0.0f;       // sum of mass times value
    glm::vec4 colour{0.0f};  // sum of colour times value
  };
  // Sums over the diffusing pixels.
  struct Texel {
    glm::vec4 colour{0.0f};
    float mass = 0.0f;  // of their weights, [0,1]
    Property variance;  // s^2, pixels^2
    Property rate;      // 1 / depth, 0 for sky
  };
  struct Part {
    glm::vec4 colour;
    float mass;
  };
  static void addTo(Property& sum, const Property& part, float share);
  // What of the texel has the property above `limit`.
  static Part above(const Texel& texel, const Property& property, float limit);
  // What of the texel is spread far enough, and lies far enough away.
  //   needed     least variance, pixels^2
  //   rateLimit  largest 1 / depth
  static Part passing(const Texel& texel, float needed, float rateLimit);
  // The same of a texel of level `number` on which pixels differ: its parts are asked one by one, at their own
  // distance.
  //   deeper  parts on which pixels differ are asked by theirs
  Part passingParts(int number, int x, int y, glm::vec2 centre, float rateLimit, bool deeper) const;
  Texel pixel(int x, int y) const;
  Texel texelAt(int number, int x, int y) const;
  // Texels lie from -kMargin: beyond, a clamped picture repeats them exactly.
  struct Level {
    int width = 0, height = 0;
    Image<Texel> texels;
    const Texel& clamped(int x, int y) const;
  };
  template <class Fetch>
  static Level halve(int width, int height, const Fetch& fetch);

  const Backdrop& backdrop_;
  const OitPlanes& planes_;
  std::vector<Level> levels_;  // [0] is level 1
};

}  // namespace pellucid
