// Layers of an EXR as pictures of a page.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"
#include "gbuffer/image.h"

namespace pellucid {

// R, G and B of a layer, else three times its first channel, for grey; empty where the part has no such layer.
std::vector<const ExrChannel*> shownChannels(const ExrPart& part, const std::string& layer);

// Whether those are colours, which a display transform is for, rather than depth, normals or one channel.
bool areColours(const std::vector<const ExrChannel*>& channels);

// Those channels, of the data window.
//   step  takes every so many-th pixel of both axes
Image<glm::vec3> layerPicture(const ExrPart& part, const std::vector<const ExrChannel*>& channels, int step = 1);

}  // namespace pellucid
