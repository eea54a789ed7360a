// Closed meshes of glass in files whose exporter never says that they are solid.
#pragma once
#include <map>
#include <optional>
#include <set>

#include "engine_bridge/scene/closed_body.h"
#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

// Blender's exporter writes transmission and an index, but no KHR_materials_volume, so that a ball of glass would stay
// a flat tint. Where a file is of that kind, and all that has a material are balls and boxes, these are bent as solid
// bodies, both where light enters and where it leaves. Other closed meshes stay thin: bent by their front faces alone,
// a pane would be farther off than it is without.
class ClosedGlass {
 public:
  //   asked  SceneOptions::closedGlass
  ClosedGlass(const GltfFile& file, bool asked);
  // Of the file's materials [first, end), once they and all that has them are in the scene.
  //   readNow  primitives that were read since the last call
  void apply(Scene& scene, std::size_t first, std::size_t end, const std::set<int>& readNow, Notes& notes);

 private:
  bool asked_;
  std::map<int, std::optional<SolidBody>> bodies_;  // by primitive
};

}  // namespace pellucid::gltf
