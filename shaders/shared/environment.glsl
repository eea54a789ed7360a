#pragma once
// Where a lat-long map shows a direction: as Blender and the common glTF viewers lay it out, so that a map lines up with
// renders. Its middle is +x, a quarter to the right +z, its top row +y.
#include "shared/surface.glsl"

//   direction  world, y up, unit
// u in [0,1] to the right, v in [0,1] downwards
PLD_FN vec2 latLongOf(vec3 direction) {
  float u = 0.5f + atan(direction.z, direction.x) * (0.5f / PLD_PI);
  float v = acos(clamp(direction.y, -1.0f, 1.0f)) * (1.0f / PLD_PI);
  return vec2(u, v);
}

PLD_FN vec3 directionOfLatLong(vec2 uv) {
  float azimuth = (uv.x - 0.5f) * (2.0f * PLD_PI), polar = uv.y * PLD_PI;
  float across = sin(polar);
  return vec3(across * cos(azimuth), cos(polar), across * sin(azimuth));
}
