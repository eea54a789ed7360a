// What a plan's images are on the device: textures, and a framebuffer for each pass that draws to some of them.
#pragma once
#include <vector>

#include "engine_bridge/c/pass_device.h"
#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

class PlanTextures {
 public:
  explicit PlanTextures(Device& device) : device_(device) {}

  // `plan` stays where it is.
  void create(const RecipePlan& plan);
  void destroy();
  // False where the device cannot draw to them.
  bool make(int width, int height);
  void release();

  // 0 for the host's and for none.
  GLuint texture(uint32_t image) const { return image < textures_.size() ? textures_[image] : 0; }
  // Draws that list fragments have that of a pass which reads them; 0 where the host's target is drawn to.
  GLuint frame(const PlannedPass& pass) const { return frames_[indexOf(pass)]; }
  std::size_t indexOf(const PlannedPass& pass) const { return static_cast<std::size_t>(&pass - plan_->passes.data()); }
  // Of the planes of PLD_STAGE_LAYERS; 0 for none.
  GLuint layersAt(int location) const;
  bool holds(GLuint texture) const;
  uint64_t bytes() const { return bytes_; }

 private:
  bool isOwn(uint32_t image) const {
    return plan_->images[image].role == PLD_ROLE_OWN || plan_->images[image].isMaps();
  }
  bool drawsToOwn(const PlannedPass& pass) const;
  bool makeFrame(const PlannedPass& pass, GLuint frame) const;

  Device& device_;
  const RecipePlan* plan_ = nullptr;
  std::vector<GLuint> textures_, frames_;
  uint64_t bytes_ = 0;
};

}  // namespace pellucid::c
