// The files that a scene names: found as exporters write their names, and opened only where a scene may reach.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine_bridge/scene/mapped_file.h"

namespace pellucid::gltf {

// A scene names files of its own folder and of the folders below it, after links are followed; and of one more folder
// that the user allows.
class AssetFiles {
 public:
  //   scenePath  of the .gltf or .glb
  //   assetRoot  --asset-root; empty for none. Throws InputError when it is not a folder
  AssetFiles(const std::string& scenePath, const std::string& assetRoot);

  // Opens what a URI without a scheme names, relative to the scene: percent escapes decoded, else as it is written, and
  // a backslash for a slash where no file has that name. The file that is open is the one that was checked, whatever
  // happens to its folders meanwhile.
  // Throws InputError when there is no such file, or it lies outside of those folders.
  //   whose  begins the sentence: "scene.gltf: buffers[0]"
  OpenFile open(const std::string& uri, const std::string& whose) const;

 private:
  const std::filesystem::path* allowing(const std::filesystem::path& real) const;
  [[noreturn]] void refuseOutside(const std::string& name, const std::filesystem::path& real,
                                  const std::string& whose) const;

  std::filesystem::path folder_;              // as the scene's path has it
  std::vector<std::filesystem::path> roots_;  // real paths; the scene's folder first
};

}  // namespace pellucid::gltf
