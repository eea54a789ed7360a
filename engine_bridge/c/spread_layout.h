// How the levels of the spread pyramid lie in their atlas.
#pragma once
#include <cstdint>

namespace pellucid::c {

struct SpreadLayout {
  static constexpr int kLevels = 25;     // of spreadLevels in shaders/gl/spread_texels.glsl
  int count = 0;                         // levels above the picture
  std::int32_t levels[kLevels][4] = {};  // width and height with its margins, its first row
  int width = 1, height = 1;             // of the atlas
};

//   layers  of the atlas: level k lies in layer (k - 1) modulo layers
SpreadLayout spreadLayout(int width, int height, int layers);

}  // namespace pellucid::c
