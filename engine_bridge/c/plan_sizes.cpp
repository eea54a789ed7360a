#include "engine_bridge/c/plan_sizes.h"

#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/spread_layout.h"

namespace pellucid::c {

namespace {

PixelSize sizeOfFace(const pld_shadow_info& maps, PartOfFrame part) {
  const int kept = edgeOf(maps);
  return {part == PartOfFrame::drawnFace ? maps.size : kept, part == PartOfFrame::keptFace ? kept : maps.size};
}

}  // namespace

PixelSize sizeOf(const RecipePlan& plan, const PlannedImage& image, int width, int height) {
  if (plan.isOfMaps()) return sizeOfFace(plan.maps, image.part);
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

uint64_t bytesOfMaps(const RecipePlan& plan) {
  uint64_t bytes = 0;
  for (const PlannedImage& image : plan.images) {
    const PixelSize size = sizeOfFace(plan.maps, image.part);
    bytes += static_cast<uint64_t>(bitsOf(image.format)) / 8 * static_cast<uint64_t>(size.width) *
             static_cast<uint64_t>(size.height) * image.layers;
  }
  return bytes;
}

uint32_t repeatsOf(const RecipePlan& plan, const PlannedPass& pass, const pld_frame& frame) {
  if (pass.part != PartOfFrame::pyramid) return 1;
  return static_cast<uint32_t>(spreadLayout(frame.width, frame.height, plan.atlasLayers).count);
}

PassArea areaOf(const RecipePlan& plan, const PlannedPass& pass, uint32_t repeat, const pld_frame& frame) {
  if (plan.isOfMaps()) {
    const PixelSize face = sizeOfFace(plan.maps, pass.part);
    return {0, 0, face.width, face.height};
  }
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
