// What a mixer makes of the materials that are drawn at low resolution: a layer for each pixel.
#pragma once
#include "composite/low_resolution.h"
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {

// Of the picture and of the solids among the layers of full resolution: what stands behind either at low resolution is
// hidden.
Image<float> opaqueDepth(TransparentPass& pass, const PassSettings& full, const GBuffer& gbuffer);

// Draws them over a view of the picture, composites each texel by the mixer, and brings the result to full resolution.
//   statistics  of that pass
LowResolutionFragments lowLayersOf(const PaintContext& context, const PassSettings& sample, int pass, Mixer& mixer,
                                   PassStatistics& statistics);

}  // namespace pellucid
