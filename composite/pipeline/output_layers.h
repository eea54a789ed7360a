// Extra layers of a result, for the output file.
#pragma once
#include <vector>

#include "composite/pipeline/request.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"

namespace pellucid {

ExtraLayer beautyLayer(const Image<glm::vec4>& rgba);  // R, G, B, A without a layer's name
// transparent, transmission and depth, of those that were asked for.
std::vector<ExtraLayer> veilLayers(const std::vector<LayerName>& layers, const Veil& veil);
// The others show planes of the transparent pass, at pixel centres.
bool wantsPlanes(const std::vector<LayerName>& layers);
ExtraLayer planeLayer(const std::vector<LayerName>& layers, const OitPlanes& planes);

}  // namespace pellucid
