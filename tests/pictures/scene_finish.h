// What surfaces of a drawn scene are made of, what lights them, and what fills the air.
#pragma once
#include "tests/pictures/scene_parts.h"

namespace pellucid::test {

// Most of the sheets become glass, coloured and glowing.
void makeGlass(SceneMaker& maker, Random& random);
// Glass that bends what stands behind it, by depth, thickness or a distance, and mirrors even surroundings, if any.
// Wants a maker that keeps proportions.
void makeRefracting(SceneMaker& maker, Random& random);
// Fog, of a few depths of the scene, everywhere or in a box that may hold the eye.
void fillAir(SceneMaker& maker, Random& random);
// Lamps before and beside the scene, and surfaces that they light: glass and sheets, matt and glossy.
void lightUp(SceneMaker& maker, Random& random);

}  // namespace pellucid::test
