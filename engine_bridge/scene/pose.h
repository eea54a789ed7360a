// Skins and morph targets, in the pose that the file's document states: nodes where their transforms put them, weights
// of the node, else of the mesh. animations.h puts other poses there.
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "engine_bridge/scene/accessor.h"
#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/nodes.h"

namespace pellucid::gltf {

struct Pose {
  std::vector<double> weights;     // one a morph target; empty where nothing is morphed
  std::vector<glm::dmat4> joints;  // the file's world from the mesh's bind pose, in its units; empty without a skin
  bool moves() const { return !weights.empty() || !joints.empty(); }
  bool operator==(const Pose&) const = default;
};

// The poses of one file's nodes.
class PoseReader {
 public:
  //   placed  outlives this
  PoseReader(GltfFile& file, const std::vector<PlacedNode>& placed, double metresPerUnit, Notes& notes);
  // Of the mesh that a node draws. A skin does nothing to a mesh without JOINTS_0, and joints that the scene does not
  // hold stand where their parents place them; both are noted. Throws InputError: a joint that is no node, matrices
  // that are damaged, weights that are not finite.
  Pose of(const JsonView& node, const JsonView& mesh);

 private:
  const std::vector<glm::dmat4>& jointsOf(const JsonView& node);

  GltfFile* file_;
  double metresPerUnit_;
  Notes* notes_;
  std::map<std::size_t, const glm::dmat4*> worldOf_;
  std::map<std::size_t, std::vector<glm::dmat4>> skins_;
};

// What was made of a pose that is not told whole.
struct PoseRepairs {
  std::size_t unbound = 0;       // vertices without any weight, which follow their first joint
  std::size_t otherWeights = 0;  // primitives of another number of morph targets than of weights
};

// A primitive's vertices, which a pose moves. All but the positions may be null.
struct PosedAttributes {
  Elements* positions = nullptr;
  Elements *normals = nullptr, *tangents = nullptr, *colours = nullptr;
  Elements* uvs[2] = {nullptr, nullptr};
  std::vector<bool> mirrored;  // out, by vertex: whether its joints mirror; empty without a skin
};

// Moves a primitive's vertices: morph targets first, then the skin.
// Throws InputError: targets or weights that are damaged, joints beyond the skin.
//   quantised  KHR_mesh_quantization is used
//   repairs    counted up
void applyPose(GltfFile& file, const JsonView& primitive, const Pose& pose, bool quantised, PosedAttributes& posed,
               PoseRepairs& repairs);

}  // namespace pellucid::gltf
