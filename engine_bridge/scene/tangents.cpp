#include "engine_bridge/scene/tangents.h"

#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "shaders/shading.h"

namespace pellucid::gltf {

namespace {

// What makes two corners one: bits of position, normal, texture coordinates, handedness.
struct Place {
  std::array<std::uint32_t, 9> bits;
  bool operator==(const Place& other) const { return bits == other.bits; }
};
struct PlaceHash {
  std::size_t operator()(const Place& place) const {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
    for (const std::uint32_t word : place.bits) hash = (hash ^ word) * 0x100000001b3u;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

Place placeOf(const Vertex& vertex, glm::vec2 uv, bool mirrored) {
  const float values[8] = {vertex.position.x,
                           vertex.position.y,
                           vertex.position.z,
                           vertex.normal.x,
                           vertex.normal.y,
                           vertex.normal.z,
                           uv.x,
                           uv.y};
  Place place{};
  std::memcpy(place.bits.data(), values, sizeof values);
  place.bits[8] = mirrored ? 1 : 0;
  return place;
}

glm::dvec3 inPlane(glm::dvec3 v, glm::dvec3 normal) {
  const glm::dvec3 flat = v - normal * glm::dot(normal, v);
  const double length = glm::length(flat);
  return length > 0.0 ? flat / length : glm::dvec3(0.0);
}

glm::dvec3 anyInPlane(glm::dvec3 normal) {
  const glm::dvec3 axis = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return inPlane(axis, normal);
}

// Direction of rising u of one triangle, and whether its picture is seen mirrored. Zero where the texture has no area.
struct Slope {
  glm::dvec3 alongU{0.0};
  bool mirrored = false;
};

Slope slopeOf(const std::array<glm::dvec3, 3>& p, const std::array<glm::dvec2, 3>& uv) {
  const glm::dvec2 first = uv[1] - uv[0], second = uv[2] - uv[0];
  const double area = first.x * second.y - first.y * second.x;
  Slope slope;
  // v runs downwards in glTF: a picture that is not mirrored has negative area.
  slope.mirrored = area > 0.0;
  if (area != 0.0) slope.alongU = ((p[1] - p[0]) * second.y - (p[2] - p[0]) * first.y) * (area > 0.0 ? 1.0 : -1.0);
  return slope;
}

}  // namespace

void makeTangents(Primitive& primitive, const TextureRef& normals) {
  const auto uvOf = [&](const Vertex& vertex) {
    return glm::vec2(normals.uvTransform * glm::vec3(vertex.uv[normals.texCoord == 0 ? 0 : 1], 1.0f));
  };
  const std::size_t triangles = primitive.indices.size() / 3;
  std::unordered_map<Place, glm::dvec3, PlaceHash> sums;
  std::vector<bool> mirrored(triangles, false);
  for (std::size_t t = 0; t < triangles; ++t) {
    std::array<glm::dvec3, 3> p;
    std::array<glm::dvec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& vertex = primitive.vertices[primitive.indices[3 * t + k]];
      p[k] = glm::dvec3(vertex.position);
      uv[k] = glm::dvec2(uvOf(vertex));
    }
    const Slope slope = slopeOf(p, uv);
    mirrored[t] = slope.mirrored;
    if (slope.alongU == glm::dvec3(0.0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& vertex = primitive.vertices[primitive.indices[3 * t + k]];
      const glm::dvec3 normal(vertex.normal);
      const glm::dvec3 ahead = inPlane(p[(k + 1) % 3] - p[k], normal), behind = inPlane(p[(k + 2) % 3] - p[k], normal);
      const double angle = std::acos(glm::clamp(glm::dot(ahead, behind), -1.0, 1.0));
      sums[placeOf(vertex, uvOf(vertex), slope.mirrored)] += angle * inPlane(slope.alongU, normal);
    }
  }
  // The first triangle of a vertex takes it; triangles of the other handedness take a copy.
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::array<std::uint32_t, 2>> kept(primitive.vertices.size(), {kNone, kNone});
  for (std::size_t corner = 0; corner < 3 * triangles; ++corner) {
    const std::uint32_t original = primitive.indices[corner];
    const std::size_t side = mirrored[corner / 3] ? 1 : 0;
    std::uint32_t& place = kept[original][side];
    if (place == kNone) {
      Vertex vertex = primitive.vertices[original];
      const auto sum = sums.find(placeOf(vertex, uvOf(vertex), side == 1));
      const glm::dvec3 normal(vertex.normal);
      glm::dvec3 tangent = sum == sums.end() ? glm::dvec3(0.0) : inPlane(sum->second, normal);
      if (tangent == glm::dvec3(0.0)) tangent = anyInPlane(normal);
      vertex.tangent = shading::packTangent(glm::vec3(tangent), side == 1 ? -1.0f : 1.0f);
      const bool taken = kept[original][1 - side] != kNone;
      place = taken ? static_cast<std::uint32_t>(primitive.vertices.size()) : original;
      if (taken)
        primitive.vertices.push_back(vertex);
      else
        primitive.vertices[original] = vertex;
    }
    primitive.indices[corner] = place;
  }
}

}  // namespace pellucid::gltf
