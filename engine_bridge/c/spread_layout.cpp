#include "engine_bridge/c/spread_layout.h"

#include <algorithm>
#include <cmath>

#include "shaders/spread_pyramid_text.h"

namespace pellucid::c {

SpreadLayout spreadLayout(int width, int height, int layers) {
  constexpr int margins = 2 * pellucid::shading::PLD_SPREAD_MARGIN;
  SpreadLayout layout;
  layout.count = pellucid::shading::spreadLevel(std::hypot(static_cast<float>(width), static_cast<float>(height)));
  for (auto& level : layout.levels) level[0] = level[1] = 1, level[2] = level[3] = 0;
  int rows[2] = {};
  for (int k = 1; k <= layout.count; ++k) {
    std::int32_t* level = layout.levels[k];
    int& row = rows[(k - 1) % layers];
    level[0] = ((width + (1 << k) - 1) >> k) + margins;
    level[1] = ((height + (1 << k) - 1) >> k) + margins;
    level[2] = row;
    row += level[1];
    layout.width = std::max(layout.width, static_cast<int>(level[0]));
    layout.height = std::max(layout.height, row);
  }
  return layout;
}

}  // namespace pellucid::c
