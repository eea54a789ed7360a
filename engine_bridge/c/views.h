// pld_resolve(): the picture, or one of the planes it is made of, drawn to the host's target.
#pragma once
#include "engine_bridge/c/caster_maps.h"
#include "engine_bridge/c/host_target.h"
#include "engine_bridge/c/low_stage.h"
#include "engine_bridge/c/plane_set.h"
#include "engine_bridge/c/rim_stage.h"
#include "engine_bridge/c/spread_levels.h"

namespace pellucid::c {

class Views {
 public:
  Views(Device& device, const PlaneSet& planes, RimStage& rims, LowStage& low, SpreadLevels& spread,
        CasterMaps& casters)
      : device_(device),
        planes_(planes),
        rims_(rims),
        low_(low),
        spread_(spread),
        casters_(casters),
        target_(device, planes) {}

  void create() { target_.create(); }
  std::string build();  // empty, else the driver's words
  void destroy();

  // Whether this pass has the view that is asked for.
  pld_status check(const pld_target& target, const pld_frame& frame);
  // Of a frame whose stages are drawn. After check().
  pld_status resolve(const pld_target& target, const pld_frame& frame);
  // Of a face of the shadow maps. After check().
  pld_status resolveFace(const pld_target& target);

 private:
  Units units() const;
  void bindPlanes(GLuint background) const;
  void drawSpread(const pld_target& target, const pld_frame& frame);
  void drawSums(pld_view view, const pld_frame& frame) const;

  Device& device_;
  const PlaneSet& planes_;
  RimStage& rims_;
  LowStage& low_;
  SpreadLevels& spread_;
  CasterMaps& casters_;
  HostTarget target_;
  Program picture_, view_, outputs_;
};

}  // namespace pellucid::c
