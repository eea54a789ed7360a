// Two hundred random stacks of layers, side by side, as a scene: what sums find hardest.
#pragma once
#include "tests/gl/builder.h"

namespace pellucid::test {

// A picture of 160 x 90, 20 x 10 cells of one stack each: up to 60 layers over four decades of depth, which |z|^-3
// makes twelve of weight; among them coplanar and duplicated layers, additive light, glass that bends and spreads, and
// solids that tie.
Stage stacksScene(std::uint64_t seed);

}  // namespace pellucid::test
