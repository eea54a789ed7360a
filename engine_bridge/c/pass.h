// One view's pass: its parts over one device, and in which order they may be called. What crosses the C boundary is
// pellucid.cpp's.
#pragma once
#include <atomic>

#include "engine_bridge/c/host_texts.h"
#include "engine_bridge/c/stages.h"
#include "engine_bridge/c/validation.h"
#include "engine_bridge/c/views.h"

struct pld_pass {
  std::atomic_flag busy = ATOMIC_FLAG_INIT;
  pellucid::c::Device device;

  // Each leaves GL as it was unless it returns PLD_OK, and begin() until end().
  pld_status create(const pld_create_info& info);
  pld_status resize(int width, int height);
  pld_status fix(const pld_frame& frame, uint32_t fields);
  pld_status begin(pld_stage stage, const pld_frame& frame);
  pld_status end();
  pld_status resolve(const pld_target& target);
  pld_status query(pld_value what, uint64_t& value);
  pld_status shadowResize(const pld_shadow_info* info);
  pld_status shadowBegin(const pld_shadow_view& view);
  pld_status shadowEnd();
  void destroyObjects();

  pellucid::c::HostTexts& texts() { return texts_; }

 private:
  enum class Step { sizeless, between, open, drawn };  // of a frame; drawn: a stage ended, no resolve yet

  pld_status checkFeatures();
  pld_status checkDevice();
  std::string makeParts();
  pld_status makeTextures(int width, int height);
  void releaseTextures();
  pld_status checkOrder(pld_stage stage);
  pld_status beginStage(pld_stage stage, const pld_frame& frame);
  pld_status queryTimes(pld_value what, uint64_t& value);
  pld_status queryPlane(pld_value what, uint64_t& value);

  pellucid::c::RecipePlan plan_;  // of device.permutation
  pellucid::c::PlanTextures textures_{device};
  pellucid::c::PlanRunner runner_{device, plan_, textures_};
  pellucid::c::FragmentRoom room_{device, plan_};
  pellucid::c::CasterMaps casters_{device};
  pellucid::c::Stages stages_{device, plan_, textures_, runner_, room_};
  pellucid::c::Views views_{device, plan_, textures_, runner_, casters_};
  pellucid::c::HostTexts texts_{device, casters_};
  pellucid::c::Validation validation_{device, casters_};

  Step step_ = Step::sizeless;
  bool beginFailed_ = false;    // the last pld_begin
  int width_ = 0, height_ = 0;  // of pld_resize()
  uint32_t stagesDone_ = 0;     // bits of the frame's
};
