// One glTF file's nodes, meshes and materials on their way into a scene: at first, and again for every pose.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "engine_bridge/scene/closed_glass.h"
#include "engine_bridge/scene/gltf.h"
#include "engine_bridge/scene/instancing.h"
#include "engine_bridge/scene/nodes.h"
#include "engine_bridge/scene/pose.h"
#include "engine_bridge/scene/primitives.h"
#include "engine_bridge/scene/textures.h"

namespace pellucid::gltf {

class FileLoader {
 public:
  // All of it must outlive this.
  //   again  load() will be called more than once, with another pose in the file's document
  FileLoader(GltfFile& file, std::size_t fileIndex, const SceneOptions& options, Scene& scene, Notes& notes,
             bool again);

  // Appends the file's materials, instances, lights and cameras as its document stands. Textures, and primitives that
  // stand as they stood, stay as an earlier call has left them; primitives that move keep their numbers.
  void load();
  // The primitives that the last load() has read, and not kept from before.
  const std::set<int>& readNow() const { return readNow_; }
  // One note for each kind of thing that was left out or repaired.
  void noteCounts() { primitives_.noteCounts(); }

 private:
  // One mesh as some node draws it.
  struct Drawn {
    std::size_t mesh;
    std::size_t posed;  // the node's number and 1 where its pose is its own, else 0
    const Pose* pose;
  };
  using Key = std::tuple<std::size_t, std::size_t, std::size_t, bool>;  // mesh, posed, primitive, mirrored
  struct Loaded {
    bool read = false;   // in some pose
    int primitive = -1;  // -1 as long as no pose of it could be drawn
    bool drawn = false;  // in the pose that was read last
    Pose pose;
  };

  std::optional<JsonView> meshOf(const PlacedNode& node) const;
  void readMaterials(const std::vector<PlacedNode>& nodes);
  bool wantsTextures(std::size_t material);
  int materialOf(const JsonView& primitive);
  bool bumpy(const JsonView& primitive) const;
  int primitiveOf(const Drawn& drawn, std::size_t index, const JsonView& source, bool mirrored);
  std::optional<Primitive> readPrimitive(const Drawn& drawn, const JsonView& source);
  void placeMesh(const PlacedNode& node);
  bool canShow(int number);
  float alphaOf(int texture);
  void place(const PlacedNode& node, const JsonView& source, const Drawn& drawn, const JsonView& primitives,
             const InstancePlace& there, std::size_t copy);

  GltfFile& file_;
  std::size_t fileIndex_;
  const SceneOptions& options_;
  Scene& scene_;
  Notes& notes_;
  bool again_;
  PrimitiveReader primitives_;
  TextureReader textures_;
  std::optional<PoseReader> poses_;
  ClosedGlass closedGlass_;
  std::map<Key, Loaded> loaded_;
  std::set<int> readNow_;
  std::map<int, bool> shows_;    // by primitive: canShow
  std::map<int, float> alphas_;  // by texture: its largest
  std::size_t firstMaterial_ = 0, firstInstance_ = 0;
  int default_ = -1;
};

}  // namespace pellucid::gltf
