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

std::vector<Plane> planesFrom(const std::vector<PlaneSpec>& specs);
// Makes the textures and draws to them by `frame`. False where the device cannot draw to all of them at once.
bool makePlanes(const Device& device, GLuint frame, std::vector<Plane>& planes, int width, int height, uint64_t& bytes);
void releasePlanes(const Device& device, std::vector<Plane>& planes);
// Of the bound framebuffer.
void clearPlanes(const GlFunctions& gl, const std::vector<Plane>& planes);
void setBlending(const GlFunctions& gl, const std::vector<Plane>& planes);
// Where shaders/gl/resolve_here.glsl reads them.
void bindPlanes(const Device& device, const std::vector<Plane>& planes);
// 0 for none.
GLuint textureOf(const std::vector<Plane>& planes, PlaneSum sum);

class PlaneSet {
 public:
  explicit PlaneSet(Device& device) : device_(device) {}

  void create();
  void destroy();
  // Makes what the permutation keeps. False where the device cannot draw to it.
  bool make(int width, int height);
  void release();

  const std::vector<Plane>& layers() const { return layers_; }
  const std::vector<Plane>& front() const { return front_; }
  const std::vector<Plane>& solids() const { return solids_; }
  // 0 for what is not kept.
  GLuint planarZ() const { return planarZ_; }
  GLuint frontZ() const { return textureOf(front_, PlaneSum::frontZ); }
  GLuint solid() const { return textureOf(solids_, PlaneSum::solid); }
  GLuint layersFrame() const { return layersFrame_; }
  GLuint planarFrame() const { return planarFrame_; }
  GLuint frontFrame() const { return frontFrame_; }
  GLuint solidFrame() const { return solidFrame_; }
  uint64_t bytes() const { return bytes_; }

 private:
  Device& device_;
  std::vector<Plane> layers_, front_, solids_;
  GLuint planarZ_ = 0, solidDepth_ = 0;
  GLuint layersFrame_ = 0, planarFrame_ = 0, frontFrame_ = 0, solidFrame_ = 0;
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
