// glTF files of points that tests write for themselves.
#pragma once
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pellucid::test {

struct PointsFile {
  std::vector<std::array<float, 3>> positions;
  std::vector<float> radii;                   // or none
  std::vector<std::array<float, 4>> colours;  // or none
  nlohmann::json material = nlohmann::json::object();
  nlohmann::json extra = nlohmann::json::object();  // merged into the top level
  nlohmann::json nodes = nlohmann::json::array();   // more nodes of the scene
  double yfov = 0.9272952180016122;                 // 2 atan(1/2): the picture is z metres high at distance z
};

inline std::string base64(const std::string& bytes) {
  static const char* const kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kLetters[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

inline void writePoints(const std::string& path, const PointsFile& points) {
  using nlohmann::json;
  std::string bytes;
  json file = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", points.yfov}, {"znear", 0.1}}}}}},
               {"materials", {points.material}}};
  json attributes;
  const auto add = [&](const char* name, const auto& values, const char* type) {
    const std::size_t size = values.size() * sizeof(values[0]);
    file["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    file["accessors"].push_back({{"bufferView", file["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", values.size()},
                                 {"type", type}});
    attributes[name] = file["accessors"].size() - 1;
    bytes.append(reinterpret_cast<const char*>(values.data()), size);
  };
  add("POSITION", points.positions, "VEC3");
  if (!points.radii.empty()) add("_RADIUS", points.radii, "SCALAR");
  if (!points.colours.empty()) add("COLOR_0", points.colours, "VEC4");
  file["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"mode", 0}, {"material", 0}}}}}};
  file["nodes"] = {{{"name", "points"}, {"mesh", 0}}, {{"name", "cam"}, {"camera", 0}}};
  for (const json& node : points.nodes) file["nodes"].push_back(node);
  json all = json::array();
  for (std::size_t i = 0; i < file["nodes"].size(); ++i) all.push_back(i);
  file["scenes"] = {{{"nodes", all}}};
  file["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
  file.merge_patch(points.extra);
  std::ofstream(path) << file.dump();
}

// Straight colour and coverage; lit by nothing.
inline nlohmann::json unlitPoints(float r, float g, float b, float alpha) {
  return {{"name", "smoke"},
          {"alphaMode", "BLEND"},
          {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, alpha}}}},
          {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}};
}

}  // namespace pellucid::test
