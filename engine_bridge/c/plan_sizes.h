// How many pixels the images and passes of a plan have, and how often a pass runs.
#pragma once
#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

struct PixelSize {
  int width, height;
};
// For pictures up to width x height; of shadow maps for any.
PixelSize sizeOf(const RecipePlan& plan, const PlannedImage& image, int width, int height);

// Of all images of a plan of shadow maps that are not the host's.
uint64_t bytesOfMaps(const RecipePlan& plan);

// Of a frame.
uint32_t repeatsOf(const RecipePlan& plan, const PlannedPass& pass, const pld_frame& frame);
struct PassArea {
  int x, y, width, height;
};
// Of shadow maps the frame is not looked at.
PassArea areaOf(const RecipePlan& plan, const PlannedPass& pass, uint32_t repeat, const pld_frame& frame);

}  // namespace pellucid::c
