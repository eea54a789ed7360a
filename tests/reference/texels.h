// Textures at a point, as glTF's samplers magnify them, in double precision.
#pragma once
#include "tests/reference/picture_scene.h"

namespace pellucid::reference {

// Linear light and straight alpha. Between texels colours count as much as their alpha does: clear ones have none.
Vec4 texelAt(const Texels& texels, Vec2 uv);

// Light of an 8-bit sRGB value (IEC 61966-2-1).
double lightOf(int stored);

}  // namespace pellucid::reference
