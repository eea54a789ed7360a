#include "tests/pictures/scene_files.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/pictures/png.h"
#include "tests/pictures/scene_parts.h"

namespace pellucid::test {
namespace {

using nlohmann::json;
using reference::Vec2;
using reference::Vec3;
using reference::Vec4;

float storedDepth(const reference::Column& column, const OpaqueForm& form) {
  const std::string& kind = form.depthKind;
  const double z = column.opaque.z / form.metresPerUnit;
  if (z == reference::kNothing) return kind == "inverse" ? 0.0f : std::numeric_limits<float>::infinity();
  if (kind == "ray") return static_cast<float>(z * glm::length(column.ray.along));
  if (kind == "inverse") return static_cast<float>(1.0 / z);
  return static_cast<float>(kind == "negative" ? -z : z);
}

constexpr double kEmissionAtMost = 2.0;  // glTF's own factor ends at 1

class GlbFile {
 public:
  json root{
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"extensionsUsed",
       {"KHR_materials_unlit", "KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_specular",
        "KHR_materials_emissive_strength", "KHR_materials_volume", "KHR_materials_dispersion", "KHR_lights_punctual"}}};

  std::size_t view(const std::string& bytes) {
    while (binary_.size() % 4) binary_.push_back('\0');
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
    binary_ += bytes;
    return root["bufferViews"].size() - 1;
  }
  template <class T>
  std::size_t accessor(const std::vector<T>& values, int componentType, const char* type) {
    const std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    root["accessors"].push_back(
        {{"bufferView", view(bytes)}, {"componentType", componentType}, {"count", values.size()}, {"type", type}});
    return root["accessors"].size() - 1;
  }
  void write(const std::string& path) {
    while (binary_.size() % 4) binary_.push_back('\0');
    if (!binary_.empty()) root["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    std::string text = root.dump();
    while (text.size() % 4) text.push_back(' ');
    std::string file = "glTF";
    const auto word = [&](std::size_t value) {
      for (int k = 0; k < 4; ++k) file.push_back(static_cast<char>(value >> (8 * k)));
    };
    word(2);
    word(12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size()));
    word(text.size());
    file += "JSON" + text;
    if (!binary_.empty()) {
      word(binary_.size());
      file += std::string("BIN\0", 4) + binary_;
    }
    std::ofstream(path, std::ios::binary) << file;
  }

 private:
  std::string binary_;
};

json numbersOf(const glm::dmat4& matrix) {
  json numbers = json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) numbers.push_back(matrix[column][row]);
  return numbers;
}

// Thickness is in the mesh's own units, as long as its nodes keep proportions.
void fill(const reference::Filling& filling, double metresPerUnit, json& extensions) {
  extensions["KHR_materials_volume"] = {{"thicknessFactor", filling.thickness / metresPerUnit},
                                        {"attenuationColor", {filling.colour.r, filling.colour.g, filling.colour.b}}};
  if (filling.clearness < 1e300) extensions["KHR_materials_volume"]["attenuationDistance"] = filling.clearness;
  if (filling.dispersion > 0.0) extensions["KHR_materials_dispersion"] = {{"dispersion", filling.dispersion}};
}

json materialOf(const reference::Coat& coat, double metresPerUnit) {
  json colour = {{"baseColorFactor", {coat.colour.r, coat.colour.g, coat.colour.b, coat.colour.a}}};
  if (coat.texture >= 0) {
    const Vec2 across(coat.fromUv[0]), down(coat.fromUv[1]);
    colour["baseColorTexture"] = {{"index", coat.texture},
                                  {"extensions",
                                   {{"KHR_texture_transform",
                                     {{"scale", {glm::length(across), glm::length(down)}},
                                      {"rotation", std::atan2(-across.y, across.x)},
                                      {"offset", {coat.fromUv[2].x, coat.fromUv[2].y}}}}}}};
  }
  json material{{"pbrMetallicRoughness", colour},
                {"doubleSided", coat.bothSides},
                {"alphaMode", coat.covering == reference::Covering::blend ? "BLEND" : "MASK"}};
  if (!coat.glass && !coat.finish.lit) {
    material["extensions"] = {{"KHR_materials_unlit", json::object()}};
  } else {
    material["emissiveFactor"] = {coat.emission.r / kEmissionAtMost, coat.emission.g / kEmissionAtMost,
                                  coat.emission.b / kEmissionAtMost};
    material["extensions"] = {{"KHR_materials_ior", {{"ior", coat.filling.index}}},
                              {"KHR_materials_specular", {{"specularFactor", coat.filling.mirrors ? 1.0 : 0.0}}},
                              {"KHR_materials_emissive_strength", {{"emissiveStrength", kEmissionAtMost}}}};
    if (coat.glass) material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", coat.finish.passes}};
    if (coat.filling.thickness > 0.0) fill(coat.filling, metresPerUnit, material["extensions"]);
    material["pbrMetallicRoughness"]["metallicFactor"] = coat.finish.metal;
    material["pbrMetallicRoughness"]["roughnessFactor"] = coat.finish.roughness;
  }
  if (coat.covering == reference::Covering::mask) material["alphaCutoff"] = coat.cutoff;
  return material;
}

void addTextures(const DrawnScene& scene, GlbFile& file) {
  const auto wrapOf = [](reference::Wrap wrap) {
    return wrap == reference::Wrap::repeat ? 10497 : wrap == reference::Wrap::mirror ? 33648 : 33071;
  };
  for (const StoredTexture& texture : scene.stored) {
    const std::size_t at = file.root.contains("images") ? file.root["images"].size() : 0;
    const std::string png = pngOf(texture.width, texture.height, texture.rgba);
    file.root["images"].push_back({{"bufferView", file.view(png)}, {"mimeType", "image/png"}});
    file.root["samplers"].push_back({{"wrapS", wrapOf(texture.wrapS)},
                                     {"wrapT", wrapOf(texture.wrapT)},
                                     {"magFilter", texture.nearest ? 9728 : 9729}});
    file.root["textures"].push_back({{"source", at}, {"sampler", at}});
  }
  if (!scene.stored.empty()) file.root["extensionsUsed"].push_back("KHR_texture_transform");
}

// Under its nodes, parents first; returns the outermost.
std::size_t addMesh(const PlacedMesh& placed, GlbFile& file) {
  std::vector<std::uint32_t> indices;
  for (const auto& triangle : placed.triangles)
    for (const int index : triangle) indices.push_back(static_cast<std::uint32_t>(index));
  json attributes{{"POSITION", file.accessor(placed.points, 5126, "VEC3")}};
  if (!placed.uv.empty()) attributes["TEXCOORD_0"] = file.accessor(placed.uv, 5126, "VEC2");
  if (!placed.colours.empty()) attributes["COLOR_0"] = file.accessor(placed.colours, 5126, "VEC4");
  glm::dmat4 world(1.0);
  for (const glm::dmat4& node : placed.nodes) world = world * node;
  file.root["materials"].push_back(materialOf(placed.coat, std::cbrt(std::abs(glm::determinant(glm::dmat3(world))))));
  file.root["meshes"].push_back({{"primitives",
                                  {{{"attributes", attributes},
                                    {"indices", file.accessor(indices, 5125, "SCALAR")},
                                    {"material", file.root["materials"].size() - 1}}}}});
  json& nodes = file.root["nodes"];
  nodes.push_back({{"mesh", file.root["meshes"].size() - 1}});
  if (!placed.nodes.empty()) nodes.back()["matrix"] = numbersOf(placed.nodes.back());
  for (std::size_t i = placed.nodes.size(); i-- > 1;)
    nodes.push_back({{"children", {nodes.size() - 1}}, {"matrix", numbersOf(placed.nodes[i - 1])}});
  return nodes.size() - 1;
}

// Boxes, for shadows: what is opaque in the file throws them.
std::size_t addSolid(const reference::Box& box, GlbFile& file) {
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> indices;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(points.size());
      for (const Vec2 at : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        Vec3 corner;
        corner[axis] = side * box.half[axis];
        corner[(axis + 1) % 3] = at.x * side * box.half[(axis + 1) % 3];
        corner[(axis + 2) % 3] = at.y * box.half[(axis + 2) % 3];
        points.emplace_back(corner);
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
    }
  file.root["materials"].push_back({{"alphaMode", "OPAQUE"}});
  file.root["meshes"].push_back({{"primitives",
                                  {{{"attributes", {{"POSITION", file.accessor(points, 5126, "VEC3")}}},
                                    {"indices", file.accessor(indices, 5125, "SCALAR")},
                                    {"material", file.root["materials"].size() - 1}}}}});
  glm::dmat4 pose(box.axes);
  pose[3] = glm::dvec4(box.centre, 1.0);
  file.root["nodes"].push_back({{"mesh", file.root["meshes"].size() - 1}, {"matrix", numbersOf(pose)}});
  return file.root["nodes"].size() - 1;
}

constexpr double kLumensPerWatt = 683.0;

// Returns its node.
std::size_t addLamp(const reference::PunctualLamp& lamp, GlbFile& file) {
  using Kind = reference::PunctualLamp::Kind;
  const double brightest = std::max({lamp.intensity.r, lamp.intensity.g, lamp.intensity.b});
  const Vec3 colour = lamp.intensity / brightest;
  json light{{"type", lamp.kind == Kind::sun     ? "directional"
                      : lamp.kind == Kind::point ? "point"
                                                 : "spot"},
             {"color", {colour.r, colour.g, colour.b}},
             {"intensity", brightest * kLumensPerWatt}};
  if (lamp.range > 0.0) light["range"] = lamp.range;
  if (lamp.kind == Kind::spot) light["spot"] = {{"innerConeAngle", lamp.innerCone}, {"outerConeAngle", lamp.outerCone}};
  json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  // Lamps shine along the -z of their nodes.
  const glm::dmat3 axes = facing(-lamp.along, 1.0);
  glm::dmat4 pose(axes);
  pose[3] = glm::dvec4(lamp.at, 1.0);
  file.root["nodes"].push_back(
      {{"matrix", numbersOf(pose)}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
  return file.root["nodes"].size() - 1;
}

}  // namespace

void writeOpaque(const std::string& path, const reference::Picture& picture, const reference::Samples& samples,
                 const OpaqueForm& form) {
  const reference::Eye& eye = picture.scene().eye;
  std::vector<Image<float>> planes(5, Image<float>(eye.width, eye.height));
  for (int y = 0; y < eye.height; ++y)
    for (int x = 0; x < eye.width; ++x) {
      const Vec4 colour = samples.mean(x, y, &reference::Sampled::background);
      for (int c = 0; c < 4; ++c) planes[static_cast<std::size_t>(c)].at(x, y) = static_cast<float>(colour[c]);
      planes[4].at(x, y) = storedDepth(picture.columnAt(x + 0.5, y + 0.5), form);
    }
  const Window display{0, 0, eye.displayWidth, eye.displayHeight};
  const Window data{eye.firstX, eye.firstY, eye.firstX + eye.width, eye.firstY + eye.height};
  writeLayers(path, display, data,
              {{"", {{"R", planes[0]}, {"G", planes[1]}, {"B", planes[2]}, {"A", planes[3]}, {"Z", planes[4]}}}}, {},
              nullptr, form.half);
}

void writeScene(const std::string& path, const DrawnScene& scene) {
  GlbFile file;
  addTextures(scene, file);
  json roots = json::array();
  for (const PlacedMesh& placed : scene.placed) roots.push_back(addMesh(placed, file));
  const reference::Eye& eye = scene.numbers.eye;
  if (eye.parallel)
    file.root["cameras"] = {
        {{"type", "orthographic"},
         {"orthographic",
          {{"xmag", eye.half.x}, {"ymag", eye.half.y}, {"znear", 1e-3 * scene.size}, {"zfar", 100.0 * scene.size}}}}};
  else
    file.root["cameras"] = {{{"type", "perspective"},
                             {"perspective",
                              {{"yfov", 2.0 * std::atan(eye.half.y)},
                               {"aspectRatio", static_cast<double>(eye.displayWidth) / eye.displayHeight},
                               {"znear", 1e-3 * scene.size}}}}};
  glm::dmat4 pose(eye.axes);
  pose[3] = glm::dvec4(eye.at, 1.0);
  for (const reference::PunctualLamp& lamp : scene.numbers.lamps) roots.push_back(addLamp(lamp, file));
  if (scene.numbers.shadows)
    for (const reference::Solid& solid : scene.numbers.solids)
      roots.push_back(addSolid(std::get<reference::Box>(solid.shape), file));
  roots.push_back(file.root.contains("nodes") ? file.root["nodes"].size() : 0);
  file.root["nodes"].push_back({{"camera", 0}, {"name", "cam"}, {"matrix", numbersOf(pose)}});
  file.root["scenes"] = {{{"nodes", roots}}};
  file.write(path);
}

}  // namespace pellucid::test
