// PLD_STAGE_RIMS: the light that antialiased rims get from around, and what occlusion takes of it from the layers'
// sums.
#pragma once
#include "engine_bridge/c/plane_set.h"

namespace pellucid::c {

class RimStage {
 public:
  RimStage(Device& device, const PlaneSet& planes) : device_(device), planes_(planes) {}

  void create();
  std::string build();      // empty, else the driver's words
  std::string buildView();  // for drawView()
  void destroy();
  bool make(int width, int height);  // nothing without a stage of rims; false where the device cannot draw to it
  void release();

  GLuint frame() const { return frame_; }
  const std::vector<Plane>& planes() const { return rims_; }
  // Takes what the opaque pixels beside rims hide from the sums that the layers have left.
  pld_status darken(const pld_frame& frame);
  // PLD_VIEW_RIM_*, with the sums bound.
  void drawView(pld_view view, const pld_frame& frame) const;
  uint64_t bytes() const { return bytes_; }

 private:
  Device& device_;
  const PlaneSet& planes_;
  Program apply_, view_;
  GLuint frame_ = 0;
  std::vector<Plane> rims_;
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
