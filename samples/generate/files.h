// What a sample leaves on disk.
#pragma once
#include <string>
#include <vector>

#include "gbuffer/image.h"
#include "samples/generate/studio.h"
#include "samples/generate/view.h"

namespace pellucid::samples {

// Half R G B A (A = 1), float Z, N.X N.Y N.Z and AO, light.sun.* where the picture has it, ZIP, worldToCamera and
// worldToNDC. Written with OpenEXR alone, as
// another renderer would, so that our reader meets a file that our writer had no part in.
void writeOpaque(const std::string& path, const OpaquePicture& picture, const View& view);

// 8-bit PNG of straight-alpha values in [0,1], stored as they are. Row 0 is the top.
std::vector<unsigned char> encodePng(const Image<glm::vec4>& pixels);

void writeBytes(const std::string& path, const std::vector<unsigned char>& bytes);

}  // namespace pellucid::samples
