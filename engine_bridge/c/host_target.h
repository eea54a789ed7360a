// Where a resolve draws to: a texture or a framebuffer of the host's.
#pragma once
#include "engine_bridge/c/plan_textures.h"

namespace pellucid::c {

class HostTarget {
 public:
  HostTarget(Device& device, const PlanTextures& textures) : device_(device), textures_(textures) {}

  void create();
  void destroy();
  //   source  a texture that is read meanwhile; 0 for none of the host's
  pld_status check(const pld_target& target, int width, int height, GLuint source);
  // Binds it as the draw framebuffer, or says why not.
  pld_status bind(const pld_target& target, GLuint source);
  void bindAgain(const pld_target& target) const;
  void unbind(const pld_target& target) const;

 private:
  GLuint frameOf(const pld_target& target) const;
  bool drawsTo(const pld_target& target, GLuint texture) const;

  Device& device_;
  const PlanTextures& textures_;
  GLuint frame_ = 0;  // of texture targets
};

// Views of shadow maps; of what later passes ask for; of rims.
bool isOfShadows(pld_view view);
bool isOutput(pld_view view);  // PLD_FEATURE_OUTPUTS, _DEPTHS, _MOTION, _IDENTITY
bool isOfRims(pld_view view);

}  // namespace pellucid::c
