// EXT_mesh_gpu_instancing: the many places of one node's mesh.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

// Transforms relative to the node, in the file's order; empty for a node without the extension.
// Throws InputError (damaged accessors, counts that differ, values that are not finite, rotations without length).
std::optional<std::vector<glm::dmat4>> instanceTransforms(GltfFile& file, const JsonView& node);

}  // namespace pellucid::gltf
