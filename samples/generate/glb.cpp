#include "samples/generate/glb.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gbuffer/errors.h"

namespace pellucid::samples {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;

void append(std::vector<unsigned char>& out, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<unsigned char>(word >> shift));
}

std::vector<double> columns(const glm::dmat4& m) {
  std::vector<double> out;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out.push_back(m[c][r]);
  return out;
}

void use(json& root, const std::string& extension) {
  json& used = root["extensionsUsed"];
  if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
}

}  // namespace

Glb::Glb() {
  json_["asset"] = {{"version", "2.0"}, {"generator", "pellucid_samples"}};
  json_["scene"] = 0;
  json_["scenes"] = json::array({{{"nodes", json::array()}}});
}

int Glb::addView(const void* data, std::size_t size, int target) {
  binary_.resize((binary_.size() + 3) / 4 * 4, 0);
  json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
  if (target) view["target"] = target;
  const auto* bytes = static_cast<const unsigned char*>(data);
  binary_.insert(binary_.end(), bytes, bytes + size);
  json_["bufferViews"].push_back(view);
  return static_cast<int>(json_["bufferViews"].size()) - 1;
}

int Glb::addAccessor(int view, int componentType, std::size_t count, const char* type) {
  json_["accessors"].push_back(
      {{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
  return static_cast<int>(json_["accessors"].size()) - 1;
}

void Glb::addNode(json node) {
  json_["nodes"].push_back(std::move(node));
  json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
}

int Glb::addTexture(const std::string& name, const std::vector<unsigned char>& png) {
  constexpr int kClampToEdge = 33071, kLinear = 9729, kMipmapLinear = 9987;
  const int view = addView(png.data(), png.size(), 0);
  if (!json_.contains("samplers"))
    json_["samplers"].push_back(
        {{"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}, {"magFilter", kLinear}, {"minFilter", kMipmapLinear}});
  json_["images"].push_back({{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
  json_["textures"].push_back({{"sampler", 0}, {"source", json_["images"].size() - 1}});
  return static_cast<int>(json_["textures"].size()) - 1;
}

int Glb::addMaterial(json material) {
  if (material.contains("extensions"))
    for (const auto& [name, unused] : material["extensions"].items()) use(json_, name);
  json_["materials"].push_back(std::move(material));
  return static_cast<int>(json_["materials"].size()) - 1;
}

void Glb::addMesh(const std::string& node, const Mesh& mesh, int material, glm::dvec3 position) {
  const auto attribute = [&](const auto& values, const char* type) {
    return addAccessor(addView(values.data(), values.size() * sizeof(values[0]), kArrayBuffer), kFloat, values.size(),
                       type);
  };
  glm::vec3 low = mesh.positions.front(), high = low;
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  json attributes;
  const int positions = attribute(mesh.positions, "VEC3");
  json_["accessors"][static_cast<std::size_t>(positions)]["min"] = {low.x, low.y, low.z};
  json_["accessors"][static_cast<std::size_t>(positions)]["max"] = {high.x, high.y, high.z};
  attributes["POSITION"] = positions;
  attributes["NORMAL"] = attribute(mesh.normals, "VEC3");
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = attribute(mesh.uvs, "VEC2");
  if (!mesh.colours.empty()) attributes["COLOR_0"] = attribute(mesh.colours, "VEC4");
  const int view = addView(mesh.indices.data(), mesh.indices.size() * sizeof(std::uint32_t), kElementArrayBuffer);
  const int indices = addAccessor(view, kUnsignedInt, mesh.indices.size(), "SCALAR");
  const json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", material}};
  json_["meshes"].push_back({{"name", node}, {"primitives", json::array({primitive})}});
  addNode({{"name", node}, {"mesh", json_["meshes"].size() - 1}, {"translation", list(position)}});
}

void Glb::addPoints(const std::string& node, const Points& points, int material) {
  const auto attribute = [&](const auto& values, const char* type) {
    return addAccessor(addView(values.data(), values.size() * sizeof(values[0]), kArrayBuffer), kFloat, values.size(),
                       type);
  };
  glm::vec3 low = points.positions.front(), high = low;
  for (const glm::vec3& p : points.positions) low = glm::min(low, p), high = glm::max(high, p);
  json attributes;
  const int positions = attribute(points.positions, "VEC3");
  json_["accessors"][static_cast<std::size_t>(positions)]["min"] = {low.x, low.y, low.z};
  json_["accessors"][static_cast<std::size_t>(positions)]["max"] = {high.x, high.y, high.z};
  attributes["POSITION"] = positions;
  attributes["_RADIUS"] = attribute(points.radii, "SCALAR");
  if (!points.colours.empty()) attributes["COLOR_0"] = attribute(points.colours, "VEC4");
  const json primitive = {{"attributes", attributes}, {"mode", 0}, {"material", material}};
  json_["meshes"].push_back({{"name", node}, {"primitives", json::array({primitive})}});
  addNode({{"name", node}, {"mesh", json_["meshes"].size() - 1}});
}

void Glb::addCamera(const std::string& node, const View& view) {
  const Camera camera = view.camera();
  json_["cameras"].push_back({{"name", node},
                              {"type", "perspective"},
                              {"perspective",
                               {{"yfov", view.yfov},
                                {"aspectRatio", view.aspect()},
                                {"znear", camera.rangeNear},
                                {"zfar", camera.rangeFar}}}});
  addNode({{"name", node},
           {"camera", json_["cameras"].size() - 1},
           {"matrix", columns(glm::inverse(camera.viewFromWorld))}});
}

void Glb::addSun(const std::string& node, glm::dvec3 toSun, glm::dvec3 irradiance) {
  constexpr double kLumensPerWatt = 683.0;
  const double strength = std::max({irradiance.r, irradiance.g, irradiance.b});
  use(json_, "KHR_lights_punctual");
  json_["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"name", node},
                                                                       {"type", "directional"},
                                                                       {"color", list(irradiance / strength)},
                                                                       {"intensity", strength * kLumensPerWatt}}});
  // The light shines along its node's -z.
  const glm::dvec3 z = glm::normalize(toSun), x = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), z));
  const glm::dmat4 worldFromLight(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0),
                                  glm::dvec4(0.0, 0.0, 0.0, 1.0));
  addNode(
      {{"name", node}, {"matrix", columns(worldFromLight)}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
}

std::vector<unsigned char> Glb::bytes() const {
  constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  const std::size_t length = (binary_.size() + 3) / 4 * 4;
  json root = json_;
  root["buffers"] = json::array({{{"byteLength", length}}});
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<unsigned char> out;
  const std::size_t total = 12 + 8 + text.size() + 8 + length;
  if (total > 0xffffffffu)
    throw ResourceError("a GLB of " + std::to_string(total) + " bytes: expected at most 4294967295");
  out.reserve(total);
  append(out, kMagic);
  append(out, 2);
  append(out, static_cast<std::uint32_t>(total));
  append(out, static_cast<std::uint32_t>(text.size()));
  append(out, kJsonChunk);
  out.insert(out.end(), text.begin(), text.end());
  append(out, static_cast<std::uint32_t>(length));
  append(out, kBinaryChunk);
  out.insert(out.end(), binary_.begin(), binary_.end());
  out.resize(total, 0);
  return out;
}

json glass(const std::string& name, glm::dvec3 colour, double ior, double roughness) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", roughness}}},
          {"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}, {"KHR_materials_ior", {{"ior", ior}}}}}};
}

std::vector<double> list(glm::dvec3 v) {
  return {v.x, v.y, v.z};
}

}  // namespace pellucid::samples
