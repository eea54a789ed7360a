// The texts that hosts hold in their shaders, kept for them, and their connection to what the pass binds.
#pragma once
#include "engine_bridge/c/caster_maps.h"
#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

class HostTexts {
 public:
  HostTexts(Device& device, const CasterMaps& casters) : device_(device), casters_(casters) {}

  // A text lives until it is asked for again.
  pld_status seam(pld_stage stage, int version, const char*& text);
  pld_status shadows(pld_shadow_text which, int version, const char*& text);
  bool hasSeams() const;  // whether one has been given out
  pld_status connect(GLuint program);

 private:
  pld_status checkVersion(const char* call, int version);
  pld_status failWithoutText(GLuint program);

  Device& device_;
  const CasterMaps& casters_;
  std::string seams_[kStages], shadows_[2];
};

}  // namespace pellucid::c
