// Layers drawn at a half, a quarter or an eighth of the resolution, and how they enter the sums of full resolution.
// WB13 section 3.4.2, MODEL section 7
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/accum.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// What a low-resolution pass draws against: texel (i, j) stands for factor x factor pixels of the data window, from
// (factor i, factor j) on; its depth is the farthest opaque one of its pixels. The last texels may reach beyond the
// window.
struct LowView {
  int factor = 1;
  GBuffer gbuffer;  // viewZ alone
  Camera camera;
  Image<float> opaqueZ;  // of the pixels: what stands behind all layers, planar metres
};

//   solid   nearest fragments that hide everything among the layers of full resolution: rgb, planar z
//   factor  pixels per texel, >= 1
LowView lowViewOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid, const Camera& camera, int factor);

// Adds the low-resolution sums to those of full resolution, as one layer per pixel.
//   low     accumulated over view.gbuffer and view.camera, with the weight and normalisation of `planes`
//   sample  where in pixels and texels both were sampled
void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, OitPlanes& planes);

}  // namespace pellucid
