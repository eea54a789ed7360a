#pragma once
// The scene's lights, in view space. Mirrored by engine_bridge/scene/blocks.h.
#include "shared/lights.glsl"

layout(std430, binding = 1) readonly buffer Lights { PunctualLight lights[]; };
