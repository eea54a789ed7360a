// What a mixer makes of the materials that are drawn at low resolution: a layer for each pixel.
#pragma once
#include "composite/low_resolution.h"
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {

// Solids of the layers of full resolution, planar z alone: what stands behind them at low resolution is hidden.
Image<glm::vec4> solidsOf(TransparentPass& pass, const PassSettings& full);

// Draws them over a view of the picture, composites each texel by the mixer, and brings the result to full resolution.
//   statistics  of that pass
LowResolutionFragments lowLayersOf(const PaintContext& context, const PassSettings& sample, int pass, Mixer& mixer,
                                   PassStatistics& statistics);

}  // namespace pellucid
