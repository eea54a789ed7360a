#include "engine_bridge/c/plan_sizes.h"

#include "engine_bridge/c/spread_layout.h"

namespace pellucid::c {

PixelSize sizeOf(const RecipePlan& plan, const PlannedImage& image, int width, int height) {
  switch (image.part) {
    case PartOfFrame::low:  // for factor 2, so that every factor has room
      return {(width + 1) / 2, (height + 1) / 2};
    case PartOfFrame::pyramid: {
      const SpreadLayout layout = spreadLayout(width, height, plan.atlasLayers);
      return {layout.width, layout.height};
    }
    default:
      return {width, height};
  }
}

uint32_t repeatsOf(const RecipePlan& plan, const PlannedPass& pass, const pld_frame& frame) {
  if (pass.part != PartOfFrame::pyramid) return 1;
  return static_cast<uint32_t>(spreadLayout(frame.width, frame.height, plan.atlasLayers).count);
}

PassArea areaOf(const RecipePlan& plan, const PlannedPass& pass, uint32_t repeat, const pld_frame& frame) {
  switch (pass.part) {
    case PartOfFrame::low:
      return {0, 0, frame.width / frame.low_factor, frame.height / frame.low_factor};
    case PartOfFrame::pyramid: {
      const SpreadLayout layout = spreadLayout(frame.width, frame.height, plan.atlasLayers);
      const int32_t* level = layout.levels[repeat + 1];
      return {0, level[2], level[0], level[1]};
    }
    default:
      return {0, 0, frame.width, frame.height};
  }
}

}  // namespace pellucid::c
