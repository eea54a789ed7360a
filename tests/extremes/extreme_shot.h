// A picture whose pixels hold the worst that layers may be: each quantity of the model over all its range, and with
// every other one.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tests/reference/sorted_over.h"

namespace pellucid::test {

enum class Quantity { opacity, colouredOpacity, radiance, background, depth };
inline constexpr int kQuantities = 5;

// From one end of its range to the other: opacities of [0,1], linear radiance, metres.
const std::vector<double>& rangeOf(Quantity quantity);

struct ExtremePixel {
  std::vector<reference::Layer> layers;  // as the file has them: floats, front to back
  reference::Rgb background{};
};

// Pixels that follow one another in rising order of one quantity, all else being equal: the picture may not fall, or of
// black layers whose opacity rises may not rise.
struct Ladder {
  Quantity varied = Quantity::radiance;
  std::size_t first = 0, count = 0;
};

struct ExtremeShot {
  int width = 0, height = 0;
  std::vector<ExtremePixel> pixels;
  std::vector<Ladder> ladders;
  std::string picture, layers;  // the files
};

// Writes the shot into the folder. Other seeds put other layers behind the ones that vary, and another order.
ExtremeShot writeExtremeShot(const std::string& folder, std::uint64_t seed);

}  // namespace pellucid::test
