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

// A pixel whose colour is filtered over an edge. Its own layers show the surface that the pass sees. Layers of other
// pixels show the farther surface alone where they see the pixel's centre, and the nearer one stands before them.
// Colours are scene-linear, premultiplied, and alpha.
struct EdgeTexel {
  int x, y;           // of the picture
  glm::vec4 whole;    // the pixel's colour in the picture
  glm::vec4 seen;     // of the surface that the pass sees
  glm::vec4 farther;  // of the farther surface
  float nearerZ;
};

class EdgeTexels {
 public:
  EdgeTexels() = default;
  //   texels  row by row
  EdgeTexels(std::vector<EdgeTexel> texels, int width, int height);
  bool empty() const { return texels_.empty(); }
  bool at(const glm::ivec2& pixel) const {
    return known_[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(pixel.x)];
  }
  // Of a pixel that has one.
  const EdgeTexel& find(const glm::ivec2& pixel) const;

 private:
  std::vector<EdgeTexel> texels_;
  std::vector<bool> known_;  // by pixel
  int width_ = 0;
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
  //   edges  of the backdrop's picture; null: none are known
  Lookups(const BackdropView& backdrop, const OitPlanes& planes, const LookupSettings& settings,
          glm::ivec2 place = glm::ivec2(0), const EdgeTexels* edges = nullptr);
  ~Lookups();

  bool scattersAt(int x, int y) const;
  // Whether some edge lies where the pixel's rays are bent to.
  bool meetsEdges(int x, int y) const;
  glm::vec4 at(int x, int y) const;

 private:
  struct Text;
  std::unique_ptr<Text> text_;
};

}  // namespace pellucid
