// pld_resolve(): the picture, or one of the planes it is made of, drawn to the host's target.
#pragma once
#include "engine_bridge/c/caster_maps.h"
#include "engine_bridge/c/host_target.h"
#include "engine_bridge/c/plan_runner.h"

namespace pellucid::c {

class Views {
 public:
  Views(Device& device, const RecipePlan& plan, const PlanTextures& textures, PlanRunner& runner, CasterMaps& casters)
      : device_(device), plan_(plan), runner_(runner), casters_(casters), target_(device, textures) {}

  void create() { target_.create(); }
  void destroy() { target_.destroy(); }

  // Whether this pass has the view that is asked for.
  pld_status check(const pld_target& target, const pld_frame& frame);
  // Of a frame whose stages are drawn. After check().
  //   width  of the largest picture
  pld_status resolve(const pld_target& target, const pld_frame& frame, int width);
  // Of a face of the shadow maps. After check().
  pld_status resolveFace(const pld_target& target);

 private:
  const PlannedPass* passOf(pld_view view) const;
  pld_status failOutput(pld_view view);
  void draw(const PlannedPass& pass, const pld_target& target);

  Device& device_;
  const RecipePlan& plan_;
  PlanRunner& runner_;
  CasterMaps& casters_;
  HostTarget target_;
};

}  // namespace pellucid::c
