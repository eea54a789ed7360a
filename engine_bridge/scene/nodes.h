// The node tree of a glTF file: world transforms, lights, cameras.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine_bridge/scene/gltf.h"
#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

struct PlacedNode {
  std::size_t index = 0;            // in the file
  std::string name;                 // "node 3" when it has none
  glm::dmat4 worldFromObject{1.0};  // metres
  bool visible = true;              // KHR_node_visibility of it and its ancestors
};

// Nodes of the default scene, else of the only scene, else of all root nodes; depth first, children in file order.
// Throws InputError when a node is its own ancestor or has two parents, or a transform is not finite and affine.
std::vector<PlacedNode> placeNodes(const GltfFile& file, double metresPerUnit, Notes& notes);

// Of a node that the scene does not hold, metres. Throws InputError as placeNodes().
glm::dmat4 worldBesideScene(const GltfFile& file, std::size_t node, double metresPerUnit, Notes& notes);

// Throws InputError when a node's world transform leaves the range of magnitudes that float products stand.
void checkMagnitude(const JsonView& node, const glm::dmat4& worldFromObject);

// Appends what KHR_lights_punctual puts on the visible nodes. Throws InputError.
void readLights(const GltfFile& file, const std::vector<PlacedNode>& nodes, const SceneOptions& options, Notes& notes,
                std::vector<Light>& lights);

// Appends the nodes' cameras, hidden nodes' too. One without a field of view, orientation or clip range is left out and
// noted: most files are drawn through another.
void readCameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, double metresPerUnit, Notes& notes,
                 std::vector<SceneCamera>& cameras);

}  // namespace pellucid::gltf
