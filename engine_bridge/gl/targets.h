// The render targets of one super-tile, and their way back into planes. GL's row 0 is the top row here: the clip
// origin is the upper left.
#pragma once
#include "engine_bridge/gl/plane_targets.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::gl {

// GL 4.5 promises textures and viewports of 16384, of which one RGBA32F plane would take 4 GiB. Above this edge the
// window is drawn as super-tiles at multiples of it, the same on every device and whatever the flags.
constexpr int kSuperTile = 8192;

class Targets {
 public:
  Targets(int width, int height) : width_(width), height_(height), part_{0, 0, width, height}, planes_(width, height) {}

  int width() const { return width_; }
  int height() const { return height_; }

  // From now on counts and solids are cleared and read in this part alone, in pixels of the targets.
  void setPart(const Window& part) { part_ = part; }
  const Window& part() const { return part_; }

  PlaneTargets& planes() { return planes_; }
  // Binds and clears its framebuffer and sets blending, so that the next draws add up.
  void beginCount();
  // First the depth of the nearest solid, then per channel the largest radiance among those at that depth.
  void beginSolidDepth();
  void beginSolidTies();
  void beginNothing();  // draws leave no pixels, only buffers

  void bindSolid() const;  // to texture unit 6; after beginSolidDepth()
  // Into planes in memory, the part's top left pixel at (x, y).
  void readSolid(Image<glm::vec4>& solid, int x, int y) const;
  // After beginSolidDepth() and its draws: planar metres, +inf for none.
  void readSolidDepth(Image<float>& z, int x, int y) const;
  Image<float> readCount() const;  // of all pixels, 0 beyond the part

 private:
  Texture add(GLenum format) const;
  void scissorPart() const;
  int width_, height_;
  Window part_;
  PlaneTargets planes_;
  Texture solid_, solidDepth_, count_;
  Framebuffer solidFrame_, countFrame_, emptyFrame_;
};

// `part` (in pixels of the plane) as an R32F texture that is read texel by texel.
Texture uploadPlane(const Image<float>& plane, const Window& part);
// Puts it into a texture that uploadPlane() has made of a part of the same size.
void updatePlane(const Texture& texture, const Image<float>& plane, const Window& part);
// The same of two planes, as RG32F.
Texture uploadPlanes(const Image<float>& red, const Image<float>& green, const Window& part);

}  // namespace pellucid::gl
