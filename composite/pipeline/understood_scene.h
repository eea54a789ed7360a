// What a shot's scene came to in its picture, told to a user: where it lies, and what speaks against its unit, its
// camera or its picture.
#pragma once
#include <string>
#include <vector>

#include "composite/pipeline/shot.h"

namespace pellucid {

// "scene: ...", and a sentence for each doubt, with the flag to give. Nothing of a scene without transparent triangles.
std::vector<std::string> sceneLines(const Shot& shot);

// A note where the picture's header says that this program has composited it already; "" elsewhere.
std::string compositedBefore(const OpaqueFile& picture);

// The file's camera against those of the glTF, where neither was chosen. Throws MeaningError, naming both, where none
// of the glTF's sees the picture as the file's does.
void expectOneCamera(const Shot& shot, const std::string& path);

}  // namespace pellucid
