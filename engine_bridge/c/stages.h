// A stage between pld_begin() and pld_end(): what it is drawn to and by which state, and what its end makes of it.
#pragma once
#include "engine_bridge/c/fragment_room.h"
#include "engine_bridge/c/low_stage.h"
#include "engine_bridge/c/plane_set.h"
#include "engine_bridge/c/rim_stage.h"

namespace pellucid::c {

class Stages {
 public:
  Stages(Device& device, PlaneSet& planes, RimStage& rims, LowStage& low, FragmentRoom& room)
      : device_(device), planes_(planes), rims_(rims), low_(low), room_(room) {}

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
  GLuint frameOf(pld_stage stage) const;
  const std::vector<Plane>& planesOf(pld_stage stage) const;
  Units unitsOf(pld_stage stage) const;
  bool attachDepth(const pld_frame& frame) const;
  bool prepare(const pld_frame& frame, bool isFirst);
  void setFrame(const pld_frame& frame, int width, int pixelsATexel) const;
  void drawPlanarDepth(const pld_frame& frame) const;
  void drawEmptyPlanes(const pld_frame& frame) const;
  void clear() const;
  void setBlends() const;
  void setTests() const;
  void bindSeam(GLuint occlusion) const;

  Device& device_;
  PlaneSet& planes_;
  RimStage& rims_;
  LowStage& low_;
  FragmentRoom& room_;
  Program emptyPlanes_, planarDepth_;
  GLuint uniforms_ = 0;
  pld_stage stage_ = PLD_STAGE_LAYERS;
  pld_frame frame_{};
  GLenum depthAttachment_ = 0;
};

}  // namespace pellucid::c
