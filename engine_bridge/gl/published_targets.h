// The targets of the `published` tier, PT17 table 2: RGBA16F, RGBA8 and RG8_SNORM, 112 bits a pixel.
#pragma once
#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::gl {

class PublishedTargets {
 public:
  // Throws ResourceError when the device has no room.
  PublishedTargets(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Binds and clears, and sets the blending of table 2, so that the next draws with Output::published add up.
  //   scatter  spread and offset take part; else they stay 0 and are not written
  void begin(bool scatter);
  // Decoded into the planes, the targets' top left pixel at (x, y); what did not fit is counted.
  void read(OitPlanes& planes, int x, int y, PublishedClamps& clamps) const;

 private:
  int width_, height_;
  Texture radiance_, beta_, delta_;
  Buffer clamped_;
  Framebuffer frame_;
};

}  // namespace pellucid::gl
