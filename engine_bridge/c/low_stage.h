// PLD_STAGE_LOW: layers that are drawn at a part of the resolution, and how they enter the sums of the whole.
#pragma once
#include "engine_bridge/c/plane_set.h"

namespace pellucid::c {

class LowStage {
 public:
  LowStage(Device& device, const PlaneSet& planes) : device_(device), planes_(planes) {}

  void create();
  std::string build();      // empty, else the driver's words
  std::string buildView();  // for drawView()
  void destroy();
  // After the planes. For factor 2, so that every factor has room; nothing without the feature. False where the device
  // cannot draw to it.
  bool make(int width, int height);
  void release();

  GLuint frame() const { return frame_; }
  const std::vector<Plane>& planes() const { return sums_; }
  GLuint farZ() const { return farZ_; }
  // The farthest opaque depth of each texel's pixels.
  void drawFarthestDepth(const pld_frame& frame) const;
  // Resolves each texel, upsamples it by depth and adds it to the layers of its pixels.
  void addToLayers(const pld_frame& frame) const;
  // With PLD_METHOD_FRONT_TAIL: what lies before the nearest layer, where shaders/gl/resolve_here.glsl reads it.
  void bindOver() const;
  // PLD_VIEW_LOW_*.
  void drawView(pld_view view, const pld_frame& frame) const;
  uint64_t bytes() const { return bytes_; }

 private:
  static constexpr int kTexels = 3;
  void resolveTexels(int wide, int high) const;
  void makeOver(int width, int height);

  Device& device_;
  const PlaneSet& planes_;
  Program depth_, texel_, upsample_, view_;
  GLuint frame_ = 0, depthFrame_ = 0, texelFrame_ = 0, overFrame_ = 0;
  std::vector<Plane> sums_, over_;
  GLuint farZ_ = 0, texels_[kTexels] = {};
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
