// Whether what a host asks of shadow maps can be kept on its device: numbers, textures and places.
#pragma once
#include "engine_bridge/c/caster_judge.h"
#include "engine_bridge/c/pass_device.h"

namespace pellucid::c {

pld_status checkMaps(Device& device, const pld_shadow_info& info);
//   room        of the maps
//   attachment  where the view's depth texture goes, 0 for none
pld_status checkView(Device& device, const pld_shadow_info& room, const pld_shadow_view& view, GLenum& attachment);

}  // namespace pellucid::c
