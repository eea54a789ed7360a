// Which files an input is made of.
#pragma once
#include <string>
#include <vector>

namespace pellucid {

// The file itself and, of a .gltf or .glb, the buffers and images that it names and that are there, each once. Nothing
// is checked: what is damaged has no files besides itself. Throws InputError for a glTF that cannot be read.
//   assetRoot  --asset-root, or ""
std::vector<std::string> filesReadWith(const std::string& path, const std::string& assetRoot);

}  // namespace pellucid
