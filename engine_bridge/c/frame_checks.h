// Whether a frame of the host's can be drawn: one sentence for each thing that cannot.
#pragma once
#include "engine_bridge/c/pass_device.h"

namespace pellucid::c {

// All of pld_fixed.
constexpr uint32_t kEveryField = PLD_FIXED_UNITS | PLD_FIXED_EXPOSURE | PLD_FIXED_WEIGHT | PLD_FIXED_REFRACTION |
                                 PLD_FIXED_DIFFUSION | PLD_FIXED_PROJECTION | PLD_FIXED_LENS;

// The numbers of a frame; of those that `fields` (pld_fixed) names.
pld_status checkNumbers(Device& device, const char* call, const pld_frame& frame, uint32_t fields);
// Numbers, what pld_fix() fixed, and textures.
//   width, height  of pld_resize()
//   attachment     where the depth texture goes, 0 where it does not test
pld_status checkFrame(Device& device, const pld_frame& frame, int width, int height, GLenum& attachment);

}  // namespace pellucid::c
