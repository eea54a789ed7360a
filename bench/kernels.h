// Loops of the library beside copies of as much memory, in this process.
#pragma once
#include <vector>

#include "bench/ratios.h"

namespace pellucid::bench {

// Resolving planes that hold layers everywhere, 1920 x 1080, without diffusion, against a copy of the bytes that it
// reads and writes; lookups through glass of several spreads against a copy of the pixels.
std::vector<Ratio> kernelRatios();

}  // namespace pellucid::bench
