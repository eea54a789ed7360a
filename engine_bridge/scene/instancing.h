// EXT_mesh_gpu_instancing: a node that draws its mesh many times.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

struct InstancePlace {
  glm::dmat4 transform{1.0};  // between the node and the mesh
  glm::vec4 colour{1.0f};     // _COLOR_0, linear, [0,1]: multiplies vertex colours
};

// One for each instance; empty when the node does not use the extension. Throws InputError.
std::optional<std::vector<InstancePlace>> instancesOf(GltfFile& file, const JsonView& node);

}  // namespace pellucid::gltf
