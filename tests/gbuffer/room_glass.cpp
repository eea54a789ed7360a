#include "room_glass.h"

#include <cstring>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace pellucid::test {
namespace {

using nlohmann::json;

constexpr double kBefore = 0.93, kAfter = 1.07;  // of the room's distance

double along(const std::array<double, 4>& plane, glm::dvec2 at) {  // 1/z of the plane, seen at (a, b, 1)
  return (plane[0] * at.x + plane[1] * at.y + plane[2]) / plane[3];
}

// What is left of a convex polygon where one plane is nearer than another.
std::vector<glm::dvec2> whereNearer(const std::vector<glm::dvec2>& polygon, const std::array<double, 4>& one,
                                    const std::array<double, 4>& other) {
  std::vector<glm::dvec2> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    const double before = along(one, from) - along(other, from), after = along(one, to) - along(other, to);
    if (before >= 0) left.push_back(from);
    if ((before >= 0) != (after >= 0)) left.push_back(glm::mix(from, to, before / (before - after)));
  }
  return left;
}

// Triangles of all that is seen of the room, so many times as far away, with a margin around the picture.
std::vector<glm::vec3> sheetOf(const Room& room, double times) {
  const glm::dvec2 edge = 1.1 / room.camera.focal;
  std::vector<glm::vec3> corners;
  for (const auto& plane : room.planes) {
    std::vector<glm::dvec2> seen{{-edge.x, -edge.y}, {edge.x, -edge.y}, edge, {-edge.x, edge.y}};
    for (const auto& other : room.planes)
      if (&other != &plane) seen = whereNearer(seen, plane, other);
    for (std::size_t i = 2; i < seen.size(); ++i)
      for (const glm::dvec2& at : {seen[0], seen[i - 1], seen[i]})
        corners.push_back(glm::vec3(glm::dvec3(at, -1.0) * times / along(plane, at)));
  }
  return corners;
}

json sheetMaterial(const json& colour) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", colour}}},
          {"alphaMode", "BLEND"},
          {"doubleSided", true},
          {"extensions", {{"KHR_materials_unlit", json::object()}}}};
}

}  // namespace

void writeRoomGlass(const std::string& path, const Room& room) {
  json gltf{{"asset", {{"version", "2.0"}}}, {"extensionsUsed", {"KHR_materials_unlit"}}, {"scene", 0}};
  gltf["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 2 * std::atan(1 / room.camera.focal.y)}, {"znear", 0.1}}}}};
  gltf["nodes"] = {{{"name", "cam"}, {"camera", 0}}, {{"mesh", 0}}, {{"mesh", 1}}};
  gltf["scenes"] = {{{"nodes", {0, 1, 2}}}};
  gltf["materials"] = {sheetMaterial({0, 1, 0, 0.5}), sheetMaterial({1, 0, 0, 0.5})};
  std::string binary;
  for (const double times : {kBefore, kAfter}) {
    const std::vector<glm::vec3> corners = sheetOf(room, times);
    const std::size_t index = gltf["accessors"].size(), bytes = corners.size() * sizeof(glm::vec3);
    glm::vec3 least(1e30f), most(-1e30f);
    for (const glm::vec3& corner : corners) least = glm::min(least, corner), most = glm::max(most, corner);
    gltf["accessors"].push_back({{"bufferView", index},
                                 {"componentType", 5126},
                                 {"type", "VEC3"},
                                 {"count", corners.size()},
                                 {"min", {least.x, least.y, least.z}},
                                 {"max", {most.x, most.y, most.z}}});
    gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}});
    const json primitive{{"attributes", {{"POSITION", index}}}, {"material", index}};
    gltf["meshes"].push_back({{"primitives", json::array({primitive})}});
    binary.append(reinterpret_cast<const char*>(corners.data()), bytes);
  }
  gltf["buffers"] = {{{"byteLength", binary.size()}}};
  std::string text = gltf.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto word = [](std::size_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&bits), 4);
  };
  spit(path, "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
                 word(binary.size()) + std::string("BIN\0", 4) + binary);
}

}  // namespace pellucid::test
