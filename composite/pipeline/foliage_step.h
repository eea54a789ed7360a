// Ambient occlusion of cut-out leaves: what the passes infer it from.
#pragma once
#include "composite/pipeline/journal.h"
#include "composite/pipeline/request.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

// Throws UsageError for details that the rule has no use for.
void checkFoliage(const FoliageRequest& request);

// Sets how leaves are occluded, but not yet by what.
void applyFoliage(const FoliageRequest& request, OcclusionSettings& settings);

// Gives the settings occluders when the scene has leaves that want some: surroundings and masks must be settled.
void placeOccluders(const FoliageRequest& request, PassSettings& settings, TransparentPass& pass,
                    const GBuffer& gbuffer, const Camera& camera, Journal& journal);

}  // namespace pellucid
