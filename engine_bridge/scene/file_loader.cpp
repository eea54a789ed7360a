#include "engine_bridge/scene/file_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "engine_bridge/scene/materials.h"
#include "engine_bridge/scene/placed.h"
#include "engine_bridge/scene/tangents.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::gltf {

namespace {

// Instances one file may have: this, and one more for each of its bytes. A real node takes more than ten.
constexpr std::size_t kFreeInstances = std::size_t{1} << 20;

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

}  // namespace

FileLoader::FileLoader(GltfFile& file, std::size_t fileIndex, const SceneOptions& options, Scene& scene, Notes& notes,
                       bool again)
    : file_(file),
      fileIndex_(fileIndex),
      options_(options),
      scene_(scene),
      notes_(notes),
      again_(again),
      primitives_(file, notes, options.streamBytes > 0),
      textures_(file, scene.textures, notes),
      closedGlass_(file, options.closedGlass) {}

void FileLoader::load() {
  if (file_.hasRepairedText()) notes_.add("has text that is not UTF-8 and is read as Latin-1");
  const std::vector<PlacedNode> nodes = placeNodes(file_, options_.metresPerUnit, notes_);
  readMaterials(nodes);
  shows_.clear();
  readNow_.clear();
  firstInstance_ = scene_.instances.size();
  primitives_.startOver();
  poses_.emplace(file_, nodes, options_.metresPerUnit, notes_);
  for (const PlacedNode& node : nodes) placeMesh(node);
  poses_.reset();
  closedGlass_.apply(scene_, firstMaterial_, scene_.materials.size(), readNow_, notes_);
  readLights(file_, nodes, options_, notes_, scene_.lights);
  readCameras(file_, nodes, options_.metresPerUnit, notes_, scene_.cameras);
}

std::optional<JsonView> FileLoader::meshOf(const PlacedNode& node) const {
  const std::optional<JsonView> reference = file_.item("nodes", node.index).find("mesh");
  if (!reference) return std::nullopt;
  return file_.item("meshes", *reference).at("primitives");
}

// What a material is seen by does not depend on its textures; an animation may change it later.
bool FileLoader::wantsTextures(std::size_t material) {
  if (options_.textured == Textured::all || (again_ && file_.uses("KHR_animation_pointer"))) return true;
  Material plain = readMaterial(file_, material, options_.metresPerUnit, false, textures_, notes_);
  applyOverrides(options_.overrides, plain);
  return plain.transparent() == (options_.textured == Textured::transparent);
}

void FileLoader::readMaterials(const std::vector<PlacedNode>& nodes) {
  const std::size_t count = file_.count("materials");
  std::vector<bool> used(count, false);
  std::set<std::size_t> seen;
  for (const PlacedNode& node : nodes) {
    const std::optional<JsonView> reference = file_.item("nodes", node.index).find("mesh");
    if (!reference || !node.visible || !seen.insert(reference->index(file_.count("meshes"), "meshes")).second) continue;
    const JsonView mesh = *meshOf(node);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const std::optional<JsonView> material = mesh.at(i).find("material");
      if (material) used[material->index(count, "materials")] = true;
    }
  }
  firstMaterial_ = scene_.materials.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool textured = used[i] && wantsTextures(i);
    scene_.materials.push_back(readMaterial(file_, i, options_.metresPerUnit, textured, textures_, notes_));
  }
  // The materials of the files behind this one must keep their numbers, whichever pose first needs it.
  default_ = -1;
  if (!again_) return;
  default_ = static_cast<int>(scene_.materials.size());
  scene_.materials.push_back(defaultMaterial());
}

int FileLoader::materialOf(const JsonView& primitive) {
  const std::optional<JsonView> reference = primitive.find("material");
  if (reference) return static_cast<int>(firstMaterial_ + reference->index(file_.count("materials"), "materials"));
  if (default_ < 0) {
    default_ = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(defaultMaterial());
  }
  return default_;
}

// Whether its normals come from a texture: its tangents may have to be made of all its triangles.
bool FileLoader::bumpy(const JsonView& primitive) const {
  const std::optional<JsonView> reference = primitive.find("material");
  if (!reference) return false;
  const std::size_t material = firstMaterial_ + reference->index(file_.count("materials"), "materials");
  return scene_.materials[material].normalTexture.texture >= 0;
}

// Empty where there is nothing to draw.
std::optional<Primitive> FileLoader::readPrimitive(const Drawn& drawn, const JsonView& source) {
  std::optional<Primitive> primitive = primitives_.read(source, *drawn.pose, bumpy(source));
  if (!primitive) return std::nullopt;
  primitive->material = materialOf(source);
  const Material& material = scene_.materials[static_cast<std::size_t>(primitive->material)];
  if (primitive->points && !material.transparent()) {
    notes_.add(source.where() + ": its points are opaque and are not drawn; particles want a material that blends");
    return std::nullopt;
  }
  const TextureRef& normals = material.normalTexture;
  if (normals.texture >= 0 && !hasTangents(*primitive)) makeTangents(*primitive, normals);
  return primitive;
}

// Index into the scene's primitives, -1 when there is nothing to draw. Read once for each pose, and once more if
// mirrored.
int FileLoader::primitiveOf(const Drawn& drawn, std::size_t index, const JsonView& source, bool mirrored) {
  Loaded& loaded = loaded_[{drawn.mesh, drawn.posed, index, mirrored}];
  if (loaded.read && loaded.pose == *drawn.pose) return loaded.drawn ? loaded.primitive : -1;
  std::optional<Primitive> primitive;
  bool fromFile = !mirrored;
  if (mirrored) {
    const int original = primitiveOf(drawn, index, source, false);
    fromFile = readNow_.count(original) > 0;
    if (original >= 0) primitive = withFlippedWinding(scene_.primitives[static_cast<std::size_t>(original)]);
  } else {
    primitive = readPrimitive(drawn, source);
  }
  loaded.read = true;
  loaded.pose = *drawn.pose;
  loaded.drawn = primitive.has_value();
  if (!primitive) return -1;
  if (loaded.primitive < 0) {
    loaded.primitive = static_cast<int>(scene_.primitives.size());
    scene_.primitives.emplace_back();
  }
  scene_.primitives[static_cast<std::size_t>(loaded.primitive)] = std::move(*primitive);
  if (fromFile) readNow_.insert(loaded.primitive);
  return loaded.primitive;
}

void FileLoader::placeMesh(const PlacedNode& node) {
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

float FileLoader::alphaOf(int texture) {
  const auto known = alphas_.find(texture);
  if (known != alphas_.end()) return known->second;
  return alphas_.emplace(texture, largestAlpha(scene_.textures[static_cast<std::size_t>(texture)].texels))
      .first->second;
}

// Whether some texel, factor and vertex could pass its alpha test: below the cutoff everything is clear.
bool FileLoader::canShow(int number) {
  const auto known = shows_.find(number);
  if (known != shows_.end()) return known->second;
  const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(number)];
  const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
  bool shows = true;
  if (material.alphaMode == AlphaMode::mask) {
    const int texture = material.baseColorTexture.texture;
    const float most = texture >= 0 ? alphaOf(texture) : 1.0f;
    shows = material.baseColor.a * coloursOf(primitive).most.a * most >= material.alphaCutoff;
    if (!shows)
      notes_.add(fmt::format("material {}: no alpha reaches its cutoff of {:g}; nothing of it is drawn", material.name,
                             material.alphaCutoff));
  }
  shows_.emplace(number, shows);
  return shows;
}

//   there  in the world
//   copy   0, or 1 and up for the instances of one node
void FileLoader::place(const PlacedNode& node, const JsonView& source, const Drawn& drawn, const JsonView& primitives,
                       const InstancePlace& there, std::size_t copy) {
  if (vanishes(there.transform)) {
    notes_.add(fmt::format("node {} has a scale of zero and is not drawn", node.name));
    return;
  }
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const int primitive = primitiveOf(drawn, i, primitives.at(i), mirrors(there.transform));
    if (primitive < 0 || !canShow(primitive)) continue;
    if (scene_.instances.size() - firstInstance_ >= kFreeInstances + file_.bytesRead())
      source.refuse(fmt::format("takes the file beyond {} instances", kFreeInstances + file_.bytesRead()));
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

}  // namespace pellucid::gltf
