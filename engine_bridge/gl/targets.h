// The render targets of one super-tile, and their way back into planes. GL's row 0 is the top row here: the clip
// origin is the upper left.
#pragma once
#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::gl {

// GL 4.5 promises textures and viewports of 16384, of which one RGBA32F plane would take 4 GiB. Above this edge the
// window is drawn as super-tiles at multiples of it, the same on every device and whatever the flags.
constexpr int kSuperTile = 8192;

// Which planes take part, and how they lie; see shaders/gl/sums_output.glsl.
struct SumsLayout {
  bool light = true;      // plane E; without it, it stays 0
  bool scatter = false;   // refraction and diffusion
  bool grey = false;      // one opacity for all channels
  bool disperse = false;  // refraction per channel
};

class Targets {
 public:
  // Throws ResourceError when the device has no room.
  Targets(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Each binds and clears its framebuffer and sets blending, so that the next draws add up.
  void beginSums(const SumsLayout& layout);
  void beginCount();
  // First the depth of the nearest solid, then per channel the largest radiance among those at that depth.
  void beginSolidDepth();
  void beginSolidTies();
  void beginNothing();  // draws leave no pixels, only buffers

  void bindSolid() const;  // to texture unit 6; after beginSolidDepth()
  // Into the planes as beginSums() laid them out, the targets' top left pixel at (x, y).
  void readSums(OitPlanes& planes, int x, int y) const;
  void readSolid(Image<glm::vec4>& solid, int x, int y) const;
  // After beginSolidDepth() and its draws: planar metres, +inf for none.
  void readSolidDepth(Image<float>& z, int x, int y) const;
  Image<float> readCount() const;

 private:
  Texture add(GLenum format) const;
  void attach(GLuint attachment, Texture& texture, GLenum format);
  void readGrey(OitPlanes& planes, int x, int y) const;
  int width_, height_;
  SumsLayout layout_;
  Texture sums_[5], greyDepth_, frontZ_, refraction_, nearestZ_, dispersion_, solid_, solidDepth_, count_;
  Framebuffer sumsFrame_, solidFrame_, countFrame_, emptyFrame_;
};

// `part` (in pixels of the plane) as an R32F texture that is read texel by texel.
Texture uploadPlane(const Image<float>& plane, const Window& part);
// The same of two planes, as RG32F.
Texture uploadPlanes(const Image<float>& red, const Image<float>& green, const Window& part);

}  // namespace pellucid::gl
