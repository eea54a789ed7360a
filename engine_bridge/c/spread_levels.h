// The pyramid by which diffusion spreads the background: one atlas whose levels are drawn one from another.
#pragma once
#include "engine_bridge/c/pass_device.h"
#include "engine_bridge/c/spread_layout.h"

namespace pellucid::c {

class SpreadLevels {
 public:
  explicit SpreadLevels(Device& device) : device_(device) {}

  void create();
  std::string build();  // empty, else the driver's words
  void destroy();
  bool make(int width, int height);  // nothing without diffusion; false where the device cannot draw to it
  void release();

  bool exist() const { return layout_.count > 0; }
  // From the sums and the background that are bound, for a picture of this size. A texel of one level reads those of
  // the one below it, of the same textures: a barrier lies between the draws.
  void draw(int width, int height);
  // From unit 11 on, where shaders/gl/spread_texels.glsl reads them.
  void bind() const;
  // What a program that reads them asks for: how many levels there are, where they lie, and how far they reach.
  void setUniforms(const Program& program, int width, int height) const;
  uint64_t bytes() const { return bytes_; }

 private:
  static constexpr int kPlanes = 5;
  void layOut(int width, int height);

  Device& device_;
  Program program_;
  GLuint frame_ = 0, planes_[kPlanes] = {};
  SpreadLayout layout_;
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
