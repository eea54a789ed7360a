// glTF 2.0 and GLB files to a Scene.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

struct SceneOptions {
  double metresPerUnit = 1.0;          // --unit
  double lumensPerWatt = 683.0;        // --lumens-per-watt: glTF lights are photometric, renders are not
  std::vector<std::string> overrides;  // --set MATERIAL.key=value
  std::string assetRoot;               // --asset-root: files may lie here besides under their scene's folder
  // Not 0: triangles stay in their files until they are drawn, which only the transparent GL pass can do, and about so
  // many bytes of the files are in memory at once.
  std::size_t streamBytes = 0;
};

// Appends the files' contents in the order given. Throws InputError (missing file, missing texture, damaged buffer),
// MeaningError (a required extension we do not know, by name), UsageError (--set names no material or key).
Scene loadScene(const std::vector<std::string>& paths, const SceneOptions& options);

}  // namespace pellucid
