// PLD_FLAG_VALIDATE: what a host has done between a begin and its end, looked at when it ends. Without the flag nothing
// here makes a call of GL.
#pragma once
#include "engine_bridge/c/caster_maps.h"
#include "engine_bridge/c/pass_device.h"
#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

class Validation {
 public:
  Validation(Device& device, const CasterMaps& casters) : device_(device), casters_(casters) {}

  void create();
  void destroy();
  // After pld_fix() too, which changes the texts.
  void nameTexts();

  // Once all is set for the host's draws.
  void beginStage(Storage storage);
  void beginFace();
  // Before anything is put back. PLD_ERROR_MISUSE and a sentence for the first thing that is not as it should be.
  pld_status endStage(pld_stage stage);
  pld_status endFace();

 private:
  // What a program's text is known by, and what pld_connect() connects of it.
  struct Text {
    const char* call;
    const char* block;
    const char* mark;  // a number of the block
    const char* name;
  };

  bool isOn() const { return (device_.info.flags & PLD_FLAG_VALIDATE) != 0; }
  void begin(Units units, Storage storage);
  bool drewSomething();
  pld_status checkState(const char* call);
  pld_status checkProgram(const Text& text);
  pld_status checkMark(GLuint program, const Text& text);
  pld_status checkConnection(GLuint program, const Text& text);
  pld_status checkSamplers(GLuint program, const Text& text);
  pld_status checkLookup(GLuint program, const char* call);
  const char* otherText(GLuint program) const;
  bool holds(GLuint program, const char* mark) const;

  Device& device_;
  const CasterMaps& casters_;
  std::string marks_[kStages], seams_[kStages];  // by which a program is known to hold a seam; as messages call it
  SavedState begun_;                             // as the host's draws found it
  Units units_;
  Storage storage_;
  GLuint drawn_ = 0;  // counts primitives
  bool isCounting_ = false;
};

}  // namespace pellucid::c
