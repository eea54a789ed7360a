#include "engine_bridge/scene/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>
#include <tuple>
#include <utility>

#include "engine_bridge/scene/instancing.h"
#include "engine_bridge/scene/materials.h"
#include "engine_bridge/scene/nodes.h"
#include "engine_bridge/scene/placed.h"
#include "engine_bridge/scene/pose.h"
#include "engine_bridge/scene/primitives.h"
#include "engine_bridge/scene/tangents.h"
#include "engine_bridge/scene/triangle_source.h"
#include "gbuffer/errors.h"

namespace pellucid {

namespace {

using namespace gltf;  // NOLINT: this file is its front door

// Instances one file may have: this, and one more for each of its bytes. A real node takes more than ten.
constexpr std::size_t kFreeInstances = std::size_t{1} << 20;

void checkExtensions(const GltfFile& file, Notes& notes) {
  std::set<std::string> required;
  if (const std::optional<JsonView> list = file.root().find("extensionsRequired")) {
    for (std::size_t i = 0; i < list->size(); ++i) required.insert(list->at(i).string());
  }
  for (const std::string& name : required) {
    if (supportFor(name) == Support::none) {
      throw MeaningError(
          printable(fmt::format("{}: requires the extension {}, which is not supported", file.path(), name)));
    }
  }
  const std::optional<JsonView> used = file.root().find("extensionsUsed");
  for (std::size_t i = 0; used && i < used->size(); ++i) {
    const std::string& name = used->at(i).string();
    if (supportFor(name) == Support::none) notes.add(fmt::format("the extension {} is not drawn", name));
  }
  if (file.count("animations") > 0) notes.add("animations are not played; nodes stand where the file puts them");
}

std::uint32_t mixBits(std::uint32_t hash, std::uint32_t value) {
  // murmur3's block and finaliser: every bit of every index reaches every bit of the identity.
  hash ^= value * 0xcc9e2d51u;
  hash ^= hash >> 16;
  hash *= 0x85ebca6bu;
  hash ^= hash >> 13;
  hash *= 0xc2b2ae35u;
  hash ^= hash >> 16;
  return hash + 0xe6546b64u;
}

std::uint32_t identityOf(std::size_t file, std::size_t node, std::size_t mesh, std::size_t primitive) {
  std::uint32_t hash = 0x9e3779b9u;
  for (const std::size_t index : {file, node, mesh, primitive}) hash = mixBits(hash, static_cast<std::uint32_t>(index));
  return hash;
}

// A scale of zero along two axes leaves no triangle an area; along one, what is flat already stays as it is.
bool vanishes(const glm::dmat4& worldFromObject) {
  const glm::dvec3 x(worldFromObject[0]), y(worldFromObject[1]), z(worldFromObject[2]);
  return glm::cross(x, y) == glm::dvec3(0.0) && glm::cross(y, z) == glm::dvec3(0.0) &&
         glm::cross(z, x) == glm::dvec3(0.0);
}

bool hasTangents(const Primitive& primitive) {
  if (primitive.streamed) return true;  // or it would have been decoded
  for (const Vertex& vertex : primitive.vertices)
    if (vertex.tangent != glm::vec2(0.0f)) return true;
  return false;
}

float largestAlpha(const Image<glm::vec4>& texels) {
  float most = 0.0f;
  for (std::size_t i = 0; i < texels.size(); ++i) most = std::max(most, texels[i].a);
  return most;
}

// One file's meshes and materials on their way into the scene.
class FileLoader {
 public:
  FileLoader(GltfFile& file, std::size_t fileIndex, const SceneOptions& options, Scene& scene, Notes& notes)
      : file_(file),
        fileIndex_(fileIndex),
        options_(options),
        scene_(scene),
        notes_(notes),
        primitives_(file, notes, options.streamBytes > 0) {}

  void load() {
    const std::vector<PlacedNode> nodes = placeNodes(file_, options_.metresPerUnit, notes_);
    readMaterials(nodes);
    firstInstance_ = scene_.instances.size();
    poses_.emplace(file_, nodes, options_.metresPerUnit);
    for (const PlacedNode& node : nodes) placeMesh(node);
    readLights(file_, nodes, options_, notes_, scene_.lights);
    readCameras(file_, nodes, options_.metresPerUnit, notes_, scene_.cameras);
    primitives_.noteCounts();
  }

 private:
  std::optional<JsonView> meshOf(const PlacedNode& node) const {
    const std::optional<JsonView> reference = file_.item("nodes", node.index).find("mesh");
    if (!reference) return std::nullopt;
    return file_.item("meshes", *reference).at("primitives");
  }

  void readMaterials(const std::vector<PlacedNode>& nodes) {
    const std::size_t count = file_.count("materials");
    std::vector<bool> used(count, false);
    std::set<std::size_t> seen;
    for (const PlacedNode& node : nodes) {
      const std::optional<JsonView> reference = file_.item("nodes", node.index).find("mesh");
      if (!reference || !node.visible || !seen.insert(reference->index(file_.count("meshes"), "meshes")).second)
        continue;
      const JsonView mesh = *meshOf(node);
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        const std::optional<JsonView> material = mesh.at(i).find("material");
        if (material) used[material->index(count, "materials")] = true;
      }
    }
    firstMaterial_ = scene_.materials.size();
    TextureReader textures(file_, scene_.textures, notes_);
    for (std::size_t i = 0; i < count; ++i) {
      scene_.materials.push_back(readMaterial(file_, i, options_.metresPerUnit, used[i], textures, notes_));
    }
  }

  int materialOf(const JsonView& primitive) {
    const std::optional<JsonView> reference = primitive.find("material");
    if (reference) return static_cast<int>(firstMaterial_ + reference->index(file_.count("materials"), "materials"));
    if (default_ < 0) {
      default_ = static_cast<int>(scene_.materials.size());
      scene_.materials.push_back(defaultMaterial());
    }
    return default_;
  }

  // Whether its normals come from a texture: its tangents may have to be made of all its triangles.
  bool bumpy(const JsonView& primitive) const {
    const std::optional<JsonView> reference = primitive.find("material");
    if (!reference) return false;
    const std::size_t material = firstMaterial_ + reference->index(file_.count("materials"), "materials");
    return scene_.materials[material].normalTexture.texture >= 0;
  }

  // One mesh as some node draws it.
  struct Drawn {
    std::size_t mesh;
    std::size_t posed;  // the node's number and 1 where its pose is its own, else 0
    const Pose* pose;
  };

  // Index into the scene's primitives, -1 when there is nothing to draw. Read once, and once more if mirrored.
  int primitiveOf(const Drawn& drawn, std::size_t index, const JsonView& source, bool mirrored) {
    const auto key = std::make_tuple(drawn.mesh, drawn.posed, index, mirrored);
    if (const auto found = loaded_.find(key); found != loaded_.end()) return found->second;
    int result = -1;
    if (mirrored) {
      const int original = primitiveOf(drawn, index, source, false);
      if (original >= 0) {
        result = static_cast<int>(scene_.primitives.size());
        scene_.primitives.push_back(withFlippedWinding(scene_.primitives[static_cast<std::size_t>(original)]));
      }
    } else if (std::optional<Primitive> primitive = primitives_.read(source, *drawn.pose, bumpy(source))) {
      primitive->material = materialOf(source);
      if (primitive->points && !scene_.materials[static_cast<std::size_t>(primitive->material)].transparent()) {
        notes_.add(source.where() + ": its points are opaque and are not drawn; particles want a material that blends");
        loaded_.emplace(key, -1);
        return -1;
      }
      const TextureRef& normals = scene_.materials[static_cast<std::size_t>(primitive->material)].normalTexture;
      if (normals.texture >= 0 && !hasTangents(*primitive)) makeTangents(*primitive, normals);
      result = static_cast<int>(scene_.primitives.size());
      scene_.primitives.push_back(std::move(*primitive));
    }
    loaded_.emplace(key, result);
    return result;
  }

  void placeMesh(const PlacedNode& node) {
    const std::optional<JsonView> primitives = node.visible ? meshOf(node) : std::nullopt;
    if (!primitives) return;
    const JsonView source = file_.item("nodes", node.index);
    const std::size_t meshIndex = source.at("mesh").index(file_.count("meshes"), "meshes");
    const Pose pose = poses_->of(source, file_.item("meshes", meshIndex));
    const bool skinned = !pose.joints.empty(), own = skinned || source.find("weights");
    const Drawn drawn{meshIndex, own ? node.index + 1 : 0, &pose};
    // Joints place a skinned mesh; its own node does not count (glTF 2.0, Skins).
    glm::dmat4 world = node.worldFromObject;
    if (skinned) {
      world = glm::dmat4(options_.metresPerUnit);
      world[3][3] = 1.0;
    }
    const std::optional<std::vector<InstancePlace>> many = instancesOf(file_, source);
    if (!many) {
      place(node, source, drawn, *primitives, {world}, 0);
      return;
    }
    for (std::size_t i = 0; i < many->size(); ++i) {
      const InstancePlace one{world * (*many)[i].transform, (*many)[i].colour};
      checkMagnitude(source, one.transform);
      place(node, source, drawn, *primitives, one, i + 1);
    }
  }

  // Whether some texel, factor and vertex could pass its alpha test: below the cutoff everything is clear.
  bool canShow(int number) {
    const auto known = shows_.find(number);
    if (known != shows_.end()) return known->second;
    const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(number)];
    const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
    bool shows = true;
    if (material.alphaMode == AlphaMode::mask) {
      float most = 1.0f;
      if (const int texture = material.baseColorTexture.texture; texture >= 0)
        most = largestAlpha(scene_.textures[static_cast<std::size_t>(texture)].texels);
      shows = material.baseColor.a * coloursOf(primitive).most.a * most >= material.alphaCutoff;
      if (!shows)
        notes_.add(fmt::format("material {}: no alpha reaches its cutoff of {:g}; nothing of it is drawn",
                               material.name, material.alphaCutoff));
    }
    shows_.emplace(number, shows);
    return shows;
  }

  //   there  in the world
  //   copy   0, or 1 and up for the instances of one node
  void place(const PlacedNode& node, const JsonView& source, const Drawn& drawn, const JsonView& primitives,
             const InstancePlace& there, std::size_t copy) {
    if (vanishes(there.transform)) {
      notes_.add(fmt::format("node {} has a scale of zero and is not drawn", node.name));
      return;
    }
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const int primitive = primitiveOf(drawn, i, primitives.at(i), mirrors(there.transform));
      if (primitive < 0 || !canShow(primitive)) continue;
      if (scene_.instances.size() - firstInstance_ >= kFreeInstances + file_.bytesRead()) {
        source.refuse(fmt::format("takes the file beyond {} instances", kFreeInstances + file_.bytesRead()));
      }
      Instance instance;
      instance.worldFromObject = there.transform;
      instance.colour = there.colour;
      instance.primitive = primitive;
      instance.node = node.name;
      instance.identity = identityOf(fileIndex_, node.index, drawn.mesh, i);
      instance.file = static_cast<int>(fileIndex_);
      if (copy > 0) instance.identity = mixBits(instance.identity, static_cast<std::uint32_t>(copy));
      scene_.instances.push_back(std::move(instance));
    }
  }

  GltfFile& file_;
  std::size_t fileIndex_;
  const SceneOptions& options_;
  Scene& scene_;
  Notes& notes_;
  PrimitiveReader primitives_;
  std::optional<PoseReader> poses_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t, bool>, int> loaded_;
  std::map<int, bool> shows_;  // by primitive: canShow
  std::size_t firstMaterial_ = 0, firstInstance_ = 0;
  int default_ = -1;
};

void checkOption(double value, const char* flag) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw UsageError(fmt::format("{} {:g}: expected a finite number above 0", flag, value));
  }
}

}  // namespace

Scene loadScene(const std::vector<std::string>& paths, const SceneOptions& options) {
  checkOption(options.metresPerUnit, "--unit");
  checkOption(options.lumensPerWatt, "--lumens-per-watt");
  Scene scene;
  const auto ledger = options.streamBytes ? std::make_shared<PageLedger>(options.streamBytes) : nullptr;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      GltfFile file(paths[i], ledger, options.assetRoot);
      Notes notes(paths[i], scene.notes);
      checkExtensions(file, notes);
      try {
        FileLoader(file, i, options, scene, notes).load();
      } catch (const InputError&) {
        file.requireWhole();  // what is missing explains what was found
        throw;
      }
      file.requireWhole();
      notes.finish();
    } catch (const std::bad_alloc&) {
      throw ResourceError(fmt::format("{}: does not fit in memory", paths[i]));
    } catch (const std::length_error&) {
      throw ResourceError(fmt::format("{}: does not fit in memory", paths[i]));
    }
  }
  applyOverrides(options.overrides, scene.materials);
  return scene;
}

}  // namespace pellucid
