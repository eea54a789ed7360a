// What is done with a face of a shadow map: images, the draws of its casters and the passes that filter it.
#pragma once
#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

// Of an info that judgeMaps() lets through. The draws come first.
//   depth  which way casters are tested against what is opaque, where a view has a depth
RecipePlan casterPlan(const pld_shadow_info& info, pld_depth depth);

}  // namespace pellucid::c
