// Extra layers of a result, for the output file.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "composite/edges.h"
#include "composite/pipeline/request.h"
#include "composite/resolve.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"

namespace pellucid {

ExtraLayer beautyLayer(const Image<glm::vec4>& rgba);  // R, G, B, A without a layer's name
// transparent, transmission and depth, of those that were asked for.
std::vector<ExtraLayer> veilLayers(const std::vector<LayerName>& layers, const Veil& veil);
bool asks(const std::vector<LayerName>& layers, LayerName name);
// Where pixels were taken apart: the nearer surface's share and both depths at the pixel's centre. Elsewhere the share
// is 0 and both depths are the pixel's.
//   edges  null: nowhere
ExtraLayer edgesLayer(const GBuffer& gbuffer, const std::vector<EdgePixel>* edges);
// What the beauty is multiplied by where transparent things and fog shadow it.
ExtraLayer shadowLayer(const Image<glm::vec3>& multiplier);
// The share of the passes in which a pixel's opaque depth was taken from beside what the picture shows.
ExtraLayer unseenLayer(Image<float> share);
// The others show planes of the transparent pass, at pixel centres.
bool wantsPlanes(const std::vector<LayerName>& layers);
// The opaque picture with another beauty in it and more layers: a flat one keeps what is not touched, of a deep one
// what it flattens to is written, with its header.
//   camera  of a deep picture, to be stated; null: the header's own
// Returns the notes.
std::vector<std::string> writeOver(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                   const Picture& picture, const std::vector<ExtraLayer>& layers,
                                   const std::map<std::string, std::string>& attributes);
ExtraLayer planeLayer(const std::vector<LayerName>& layers, const OitPlanes& planes);

}  // namespace pellucid
