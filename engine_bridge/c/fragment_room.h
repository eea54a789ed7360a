// The exact tier: buffers in which a stage's fragments are listed while the host draws, for the passes that sum them
// when it ends.
#pragma once
#include "engine_bridge/c/pass_device.h"
#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

class FragmentRoom {
 public:
  FragmentRoom(Device& device, const RecipePlan& plan) : device_(device), plan_(plan) {}

  // Each does nothing in other tiers.
  pld_status check() const;  // of pld_create_info and the plan, against the device
  pld_status make(int width, int height);
  void release();

  Storage storage() const;  // the bindings that stages take
  void beginFrame() { fragments_ = 0; }
  // Empty lists, and nothing but them to draw to.
  void open() const;
  // The lists as the host's draws left them, for the pass that sums them.
  void show() const;
  // After it. Waits for the device, and refuses lists that are not whole.
  pld_status count();

  uint64_t room() const { return room_; }            // in fragments
  uint64_t fragments() const { return fragments_; }  // in the fullest stage of the newest frame
  uint64_t bytes() const { return bytes_; }

 private:
  void bind() const;

  Device& device_;
  const RecipePlan& plan_;
  GLuint lists_[kMostStorage] = {};  // blocks of shaders/gl/exact_lists.glsl
  uint64_t room_ = 0, fragments_ = 0, bytes_ = 0;
  int width_ = 0, height_ = 0;  // of the largest picture
};

}  // namespace pellucid::c
