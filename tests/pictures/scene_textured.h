// Sheets with textures before a wall, of a few large texels.
#pragma once
#include "tests/pictures/scene_parts.h"

namespace pellucid::test {

//   cut  by the alpha of their textures, as leaves are
void textured(SceneMaker& maker, Random& random, bool cut);

}  // namespace pellucid::test
