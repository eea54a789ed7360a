// The exact tier: buffers in which a stage's fragments are listed while the host draws, and the programs that sum them
// when it ends.
#pragma once
#include "engine_bridge/c/pass_device.h"
#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

class FragmentRoom {
 public:
  explicit FragmentRoom(Device& device) : device_(device) {}

  // Each does nothing in other tiers.
  pld_status check() const;  // of pld_create_info, against the device
  std::string build();       // empty, else the driver's words
  void destroy();
  pld_status make(int width, int height);
  void release();

  Storage storage() const;  // the bindings that stages take
  void beginFrame() { fragments_ = 0; }
  // Empty lists, and nothing but them to draw to.
  void open() const;
  // Draws the stage's planes, of width x height, from its lists to `frame`. Waits for the device, and refuses lists
  // that are not whole.
  //   solid  the plane of what is solid, 0 for none
  pld_status fold(pld_stage stage, GLuint frame, int width, int height, const pld_frame& numbers, GLuint solid);

  uint64_t room() const { return room_; }            // in fragments
  uint64_t fragments() const { return fragments_; }  // in the fullest stage of the newest frame
  uint64_t bytes() const { return bytes_; }

 private:
  void bind() const;

  Device& device_;
  GLuint lists_[kMostStorage] = {};  // blocks of shaders/gl/exact_lists.glsl
  Program folds_[kStages];
  uint64_t room_ = 0, fragments_ = 0, bytes_ = 0;
  int width_ = 0, height_ = 0;  // of the largest picture
};

}  // namespace pellucid::c
