// Whether a frame of the host's can be drawn: one sentence for each thing that cannot.
#pragma once
#include "engine_bridge/c/frame_numbers.h"
#include "engine_bridge/c/pass_device.h"

namespace pellucid::c {

// The numbers of a frame; of those that `fields` (pld_fixed) names.
pld_status checkNumbers(Device& device, const char* call, const pld_frame& frame, uint32_t fields);
// Numbers, what pld_fix() fixed, and textures.
//   width, height  of pld_resize()
//   attachment     where the depth texture goes, 0 where it does not test
pld_status checkFrame(Device& device, const pld_frame& frame, int width, int height, GLenum& attachment);

}  // namespace pellucid::c
