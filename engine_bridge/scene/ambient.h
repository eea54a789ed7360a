// Surroundings as fog sees them: their mean and their slope.
#pragma once
#include "engine_bridge/scene/surroundings.h"
#include "gbuffer/medium.h"

namespace pellucid {

AmbientLight ambientOf(const Surroundings& surroundings);

}  // namespace pellucid
