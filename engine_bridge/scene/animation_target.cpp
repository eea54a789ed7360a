// What the channels of animations move: nodes by path, and any number of the document by KHR_animation_pointer.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "engine_bridge/scene/animations.h"

namespace pellucid::gltf {

namespace {

using namespace std::string_view_literals;

struct Property {
  std::string_view end;  // of the pointer
  CurveShape shape;
};

// The properties that the loader reads, by how their pointers end. Whatever else a file moves shows in no picture.
constexpr CurveShape kNumber{CurveKind::plain, 1, false}, kPair{CurveKind::plain, 2, false},
    kTriple{CurveKind::plain, 3, false}, kQuadruple{CurveKind::plain, 4, false}, kTurn{CurveKind::rotation, 4, false},
    kFlag{CurveKind::plain, 1, true}, kMany{CurveKind::plain, 0, false};

constexpr Property kNode[] = {{"translation"sv, kTriple},
                              {"rotation"sv, kTurn},
                              {"scale"sv, kTriple},
                              {"weights"sv, kMany},
                              {"extensions/KHR_node_visibility/visible"sv, kFlag}};
constexpr Property kMesh[] = {{"weights"sv, kMany}};
constexpr Property kCamera[] = {{"perspective/yfov"sv, kNumber},   {"perspective/aspectRatio"sv, kNumber},
                                {"perspective/znear"sv, kNumber},  {"perspective/zfar"sv, kNumber},
                                {"orthographic/xmag"sv, kNumber},  {"orthographic/ymag"sv, kNumber},
                                {"orthographic/znear"sv, kNumber}, {"orthographic/zfar"sv, kNumber}};
constexpr Property kLight[] = {{"color"sv, kTriple},
                               {"intensity"sv, kNumber},
                               {"range"sv, kNumber},
                               {"spot/innerConeAngle"sv, kNumber},
                               {"spot/outerConeAngle"sv, kNumber}};
constexpr Property kMaterial[] = {
    {"pbrMetallicRoughness/baseColorFactor"sv, kQuadruple},
    {"pbrMetallicRoughness/metallicFactor"sv, kNumber},
    {"pbrMetallicRoughness/roughnessFactor"sv, kNumber},
    {"alphaCutoff"sv, kNumber},
    {"emissiveFactor"sv, kTriple},
    {"normalTexture/scale"sv, kNumber},
    {"extensions/KHR_materials_emissive_strength/emissiveStrength"sv, kNumber},
    {"extensions/KHR_materials_ior/ior"sv, kNumber},
    {"extensions/KHR_materials_transmission/transmissionFactor"sv, kNumber},
    {"extensions/KHR_materials_volume/thicknessFactor"sv, kNumber},
    {"extensions/KHR_materials_volume/attenuationDistance"sv, kNumber},
    {"extensions/KHR_materials_volume/attenuationColor"sv, kTriple},
    {"extensions/KHR_materials_dispersion/dispersion"sv, kNumber},
    {"extensions/KHR_materials_specular/specularFactor"sv, kNumber},
    {"extensions/KHR_materials_specular/specularColorFactor"sv, kTriple},
    {"extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor"sv, kNumber},
    {"extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor"sv, kTriple}};
constexpr Property kTransform[] = {{"extensions/KHR_texture_transform/offset"sv, kPair},
                                   {"extensions/KHR_texture_transform/scale"sv, kPair},
                                   {"extensions/KHR_texture_transform/rotation"sv, kNumber}};

template <std::size_t count>
std::optional<CurveShape> shapeIn(const Property (&table)[count], std::string_view end) {
  for (const Property& row : table)
    if (row.end == end) return row.shape;
  return std::nullopt;
}

// "/materials/3/alphaCutoff" to its array, number and property.
struct Place {
  std::string array, number, end;
};

std::optional<Place> placeOf(const std::string& pointer) {
  constexpr std::string_view kLights = "/extensions/KHR_lights_punctual/lights/";
  Place place;
  std::size_t at = 0;
  if (pointer.compare(0, kLights.size(), kLights) == 0) {
    place.array = "lights";
    at = kLights.size();
  } else {
    const std::size_t slash = pointer.find('/', 1);
    if (pointer.empty() || pointer[0] != '/' || slash == std::string::npos) return std::nullopt;
    place.array = pointer.substr(1, slash - 1);
    at = slash + 1;
  }
  const std::size_t slash = pointer.find('/', at);
  if (slash == std::string::npos) return std::nullopt;
  place.number = pointer.substr(at, slash - at);
  place.end = pointer.substr(slash + 1);
  const bool digits =
      !place.number.empty() && place.number.size() < 10 &&
      std::all_of(place.number.begin(), place.number.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? std::optional(place) : std::nullopt;
}

std::optional<CurveShape> shapeOfMaterial(const std::string& end) {
  if (const auto shape = shapeIn(kMaterial, end)) return shape;
  // A texture's own object stands before what is said of all textures.
  const std::size_t at = end.find("extensions/KHR_texture_transform/");
  return at == std::string::npos ? std::nullopt : shapeIn(kTransform, std::string_view(end).substr(at));
}

std::optional<CurveShape> shapeOf(const Place& place) {
  if (place.array == "nodes") return shapeIn(kNode, place.end);
  if (place.array == "meshes") return shapeIn(kMesh, place.end);
  if (place.array == "cameras") return shapeIn(kCamera, place.end);
  if (place.array == "lights") return shapeIn(kLight, place.end);
  if (place.array == "materials") return shapeOfMaterial(place.end);
  return std::nullopt;
}

std::optional<Moved> byPointer(const JsonView& target, Notes& notes) {
  const std::optional<JsonView> extension = target.extension("KHR_animation_pointer");
  if (!extension) target.refuse("has the path pointer without the extension KHR_animation_pointer");
  const std::string& pointer = extension->at("pointer").string();
  const std::optional<Place> place = placeOf(pointer);
  const std::optional<CurveShape> shape = place ? shapeOf(*place) : std::nullopt;
  if (shape) return Moved{pointer, *shape};
  notes.add(fmt::format("what an animation does to {} shows in no picture and is not played", printable(pointer)));
  return std::nullopt;
}

}  // namespace

std::optional<Moved> movedBy(const GltfFile& file, const JsonView& target, Notes& notes) {
  const std::string& path = target.at("path").string();
  std::optional<Moved> moved;
  if (path == "pointer") {
    moved = byPointer(target, notes);
  } else {
    const bool known = path == "translation" || path == "rotation" || path == "scale" || path == "weights";
    if (!known)
      target.at("path").refuse(
          fmt::format("is {}; expected translation, rotation, scale, weights or pointer", printable(path)));
    const std::optional<JsonView> node = target.find("node");
    if (!node) return std::nullopt;  // glTF 2.0: ignored
    const Place place{"nodes", std::to_string(node->index(file.count("nodes"), "nodes")), path};
    moved = Moved{"/nodes/" + place.number + "/" + path, *shapeOf(place)};
  }
  if (!moved) return std::nullopt;
  const Place place = *placeOf(moved->pointer);
  if (place.array == "nodes" && place.end != "weights" && place.end.find('/') == std::string::npos) {
    const std::size_t number = std::stoul(place.number);
    if (number >= file.count("nodes"))
      target.refuse(fmt::format("moves {}; the file has {} nodes", moved->pointer, file.count("nodes")));
    if (file.item("nodes", number).find("matrix"))
      file.item("nodes", number).refuse("is animated and has a matrix; expected translation, rotation and scale");
  }
  if (!file.holds(moved->pointer)) target.refuse(fmt::format("moves {}, which is not there", moved->pointer));
  return moved;
}

}  // namespace pellucid::gltf
