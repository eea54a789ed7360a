// A stage between pld_begin() and pld_end(): what the plan draws before the host, what the host draws to and by which
// state, and what the plan makes of it.
#pragma once
#include "engine_bridge/c/fragment_room.h"
#include "engine_bridge/c/plan_runner.h"

namespace pellucid::c {

class Stages {
 public:
  Stages(Device& device, const RecipePlan& plan, const PlanTextures& textures, PlanRunner& runner, FragmentRoom& room)
      : device_(device), plan_(plan), textures_(textures), runner_(runner), room_(room) {}

  void create();
  std::string build();  // empty, else the driver's words
  void destroy();

  // Leaves GL as it was unless it returns PLD_OK.
  //   width       of the largest picture
  //   attachment  of the frame's depth texture, 0 where it does not test
  //   isFirst     of its frame
  pld_status open(pld_stage stage, const pld_frame& frame, int width, GLenum attachment, bool isFirst);
  //   whole  false where fragments had no room: the stage counts as not drawn
  pld_status close(bool& whole);
  pld_stage stage() const { return stage_; }
  const pld_frame& frame() const { return frame_; }  // of the newest stage

 private:
  Units units() const;
  bool attachDepth(GLuint texture) const;
  void prepare(const PlannedPass& draws);
  void setFrame() const;
  void drawEmptyPlanes(const PlannedPass& draws) const;
  pld_status finish(bool& whole);
  pld_status checkOcclusion(const PlannedPass& pass);

  Device& device_;
  const RecipePlan& plan_;
  const PlanTextures& textures_;
  PlanRunner& runner_;
  FragmentRoom& room_;
  Program emptyPlanes_;
  GLuint uniforms_ = 0;
  pld_stage stage_ = PLD_STAGE_LAYERS;
  pld_frame frame_{};
  int width_ = 0;
  GLenum depthAttachment_ = 0;
};

}  // namespace pellucid::c
