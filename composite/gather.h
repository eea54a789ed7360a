// What the layers of a pixel show of the background: refracted to another place, spread by diffusion. MODEL sections 4,
// 5
#pragma once
#include <glm/glm.hpp>
#include <memory>

#include "gbuffer/accum.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// What stands behind all layers: the opaque picture, and in front of it the nearest solid fragment.
struct Backdrop {
  Image<glm::vec4> colour;  // scene-linear, premultiplied, and alpha
  Image<float> z;           // planar metres, > 0, +inf for nothing
};
Backdrop backdropOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid);

struct LookupSettings {
  int kernel = shading::PLD_DIFFUSE_GAUSSIAN;
  // Every tap of the kernel: cost grows as D^2. Else the Gaussian reads a pyramid, at a cost that no D changes.
  bool exact = false;
};

// Whether the pixel's layers show another part of the backdrop than its own.
inline bool scattersAt(const OitPlanes& planes, int x, int y) {
  return planes.scatters() && (planes.refraction.at(x, y).z > 0.0f || planes.refraction.at(x, y).w > 0.0f);
}

// Looks the backdrop up along a pixel's path. Taps outside the data window read its edge; taps that are not finite or
// stand in front of the scattering layer count nothing. A pixel that neither refracts nor diffuses gives its own bits.
class Lookups {
 public:
  // Both must outlive this. `planes` has the backdrop's size and scatters().
  Lookups(const Backdrop& backdrop, const OitPlanes& planes, const LookupSettings& settings);
  ~Lookups();

  bool scattersAt(int x, int y) const;
  glm::vec4 at(int x, int y) const;

 private:
  struct Text;
  std::unique_ptr<Text> text_;
};

}  // namespace pellucid
