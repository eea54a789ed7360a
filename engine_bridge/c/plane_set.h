// Textures of the picture's size that stages draw to and that later stages and the resolve read, with the framebuffers
// to draw to them. What rims, layers of low resolution and diffusion keep besides is theirs.
#pragma once
#include <vector>

#include "engine_bridge/c/pass_device.h"

namespace pellucid::c {

struct Plane {
  PlaneSpec spec;
  GLuint texture = 0;
};

// Blends what is drawn to draw buffer `attachment`.
void setBlending(const GlFunctions& gl, GLuint attachment, BlendKind kind);

class PlaneSet {
 public:
  explicit PlaneSet(Device& device) : device_(device) {}

  void create();
  void destroy();
  // Makes what the permutation keeps. False where the device cannot draw to it.
  bool make(int width, int height);
  void release();

  const std::vector<Plane>& layers() const { return layers_; }
  // 0 for what is not kept.
  GLuint planarZ() const { return planarZ_; }
  GLuint frontZ() const { return frontZ_; }
  GLuint solid() const { return solid_; }
  GLuint layersFrame() const { return layersFrame_; }
  GLuint planarFrame() const { return planarFrame_; }
  GLuint frontFrame() const { return frontFrame_; }
  GLuint solidFrame() const { return solidFrame_; }
  uint64_t bytes() const { return bytes_; }

 private:
  Device& device_;
  std::vector<Plane> layers_;
  GLuint planarZ_ = 0, frontZ_ = 0, solid_ = 0, solidDepth_ = 0;
  GLuint layersFrame_ = 0, planarFrame_ = 0, frontFrame_ = 0, solidFrame_ = 0;
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
