// Textures that layers are blended into, as shaders/plane_layout.h lays them out, and their way back into planes.
#pragma once
#include <functional>
#include <vector>

#include "engine_bridge/gl/gl_objects.h"
#include "gbuffer/plane_values.h"

namespace pellucid::gl {

class PlaneTargets {
 public:
  PlaneTargets(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // From now on planes are cleared and read in this part alone, in pixels of the targets.
  void setPart(const Window& part) { part_ = part; }

  // Binds a framebuffer of these planes, clears it and sets blending, so that the next draws add up. Planes that are
  // needed for the first time are made. Throws ResourceError when the device has no room or cannot draw to them at
  // once.
  void begin(const std::vector<PlaneSpec>& planes);
  // Those of begin(), into planes in memory, the part's top left pixel at (x, y). Sums that are packed for scenes
  // without coloured transmission are unpacked.
  void read(OitPlanes& planes, int x, int y) const;
  void read(RimPlanes& planes, int x, int y) const;
  // The texels of one of them, row by row.
  //   type  GL_FLOAT, or GL_UNSIGNED_BYTE, GL_BYTE as the format stores them
  void readTexels(PlaneSum sum, GLenum type, void* first, std::size_t bytes) const;

 private:
  struct Target {
    int place;
    PlaneFormat format;
    Texture texture;
  };
  const Texture& textureOf(const PlaneSpec& plane);
  const PlaneSpec& specOf(PlaneSum sum) const;
  const Texture& textureOf(PlaneSum sum) const;
  void readGrey(OitPlanes& planes, int x, int y) const;
  using ValuesOf = std::function<PlaneValues(PlaneSum sum, int component)>;
  void readPlane(const PlaneSpec& plane, const ValuesOf& valuesOf, int x, int y, int rowLength) const;

  int width_, height_;
  Window part_;
  std::vector<Target> targets_;
  std::vector<PlaneSpec> planes_;  // of begin()
  Framebuffer frame_;
};

}  // namespace pellucid::gl
