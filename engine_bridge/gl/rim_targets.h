// The targets of RimPlanes.
#pragma once
#include "engine_bridge/gl/gl_objects.h"
#include "gbuffer/rim_planes.h"

namespace pellucid::gl {

class RimTargets {
 public:
  // Throws ResourceError when the device has no room.
  RimTargets(int width, int height);

  // Binds and clears, and sets blending, so that the next draws with Output::rims add up.
  void begin();
  // Into the planes, the targets' top left pixel at (x, y).
  void read(RimPlanes& planes, int x, int y) const;

 private:
  int width_, height_;
  Texture averaged_, added_, gradient_;
  Framebuffer frame_;
};

}  // namespace pellucid::gl
