// What the layers of a pixel show of the background: refracted to another place, spread by diffusion. MODEL sections 4,
// 5
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "gbuffer/accum.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// What stands behind all layers: the opaque picture, and in front of it the nearest solid fragment.
struct Backdrop {
  Image<glm::vec4> colour;  // scene-linear, premultiplied, and alpha
  Image<float> z;           // planar metres, > 0, +inf for nothing
};
Backdrop backdropOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid);

// The same, wherever its planes lie.
struct BackdropView {
  const Image<glm::vec4>* colour = nullptr;
  const Image<float>* z = nullptr;
  BackdropView() = default;
  BackdropView(const Image<glm::vec4>& colours, const Image<float>& depth) : colour(&colours), z(&depth) {}
  BackdropView(const Backdrop& backdrop) : colour(&backdrop.colour), z(&backdrop.z) {}  // NOLINT: it is one
};

// The backdrops of one pass after another before the same picture: that is copied where a pass has solids, once.
class PassBackdrop {
 public:
  // Holds until the next call.
  //   solid  of a part of the picture
  //   place  of its first pixel, in pixels of the data window
  BackdropView of(const GBuffer& gbuffer, const Image<glm::vec4>& solid, glm::ivec2 place);

 private:
  Backdrop own_;
  std::vector<std::size_t> covered_;  // pixels of it
};

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
  // All must outlive this. `planes` scatters() and lies in the backdrop; beyond it nothing scatters.
  //   place  of the planes' first pixel, in pixels of the backdrop
  Lookups(const BackdropView& backdrop, const OitPlanes& planes, const LookupSettings& settings,
          glm::ivec2 place = glm::ivec2(0));
  ~Lookups();

  bool scattersAt(int x, int y) const;
  glm::vec4 at(int x, int y) const;

 private:
  struct Text;
  std::unique_ptr<Text> text_;
};

}  // namespace pellucid
