#include "engine_bridge/scene/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "shaders/shading.h"

namespace pellucid::gltf {

namespace {

enum Mode : std::size_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kTriangleStrip, kTriangleFan };

constexpr std::uint32_t kUnused = 0xffffffffu;
constexpr std::size_t kNoAccessor = static_cast<std::size_t>(-1);

bool finite(glm::vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::vec3 vec3At(const Elements& elements, std::size_t i) {
  return {elements.at(i, 0), elements.at(i, 1), elements.at(i, 2)};
}

// Twice the area along the normal; in double so that no finite float triangle overflows or vanishes.
glm::dvec3 areaNormal(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
}

// Clamped to [0, 1]; what is not a number becomes 0.
float unitValue(float value, std::size_t& repaired) {
  if (value >= 0.0f && value <= 1.0f) return value;
  ++repaired;
  return value > 1.0f ? 1.0f : 0.0f;
}

glm::vec2 uvAt(const Elements& elements, std::size_t i, std::size_t& repaired) {
  const glm::vec2 uv(elements.at(i, 0), elements.at(i, 1));
  // Beyond 2^23 a float holds no texel position any more, and sums of it may overflow.
  constexpr float kMost = 8388608.0f;
  if (std::abs(uv.x) <= kMost && std::abs(uv.y) <= kMost) return uv;
  ++repaired;
  return glm::vec2(0.0f);
}

// At right angles to the normal; nothing where it has no direction.
glm::vec2 tangentAt(const Elements& elements, std::size_t i, glm::vec3 normal) {
  const glm::dvec3 along(vec3At(elements, i)), up(normal);
  const glm::dvec3 flat = along - up * glm::dot(up, along);
  const double length = glm::length(flat);
  if (!std::isfinite(length) || !(length > 1e-6 * glm::length(along))) return glm::vec2(0.0f);
  return shading::packTangent(glm::vec3(flat / length), elements.at(i, 3) < 0.0f ? -1.0f : 1.0f);
}

}  // namespace

PrimitiveReader::PrimitiveReader(GltfFile& file, Notes& notes) : file_(&file), notes_(&notes) {
  const std::optional<JsonView> used = file.root().find("extensionsUsed");
  for (std::size_t i = 0; used && i < used->size(); ++i)
    quantised_ = quantised_ || used->at(i).string() == "KHR_mesh_quantization";
}

const Elements* PrimitiveReader::attribute(const JsonView& attributes, const char* name,
                                           std::initializer_list<std::size_t> widths, Integers integers,
                                           std::size_t vertexCount) {
  const std::optional<JsonView> reference = attributes.find(name);
  if (!reference) return nullptr;
  const std::size_t accessor = reference->index(file_->count("accessors"), "accessors");
  Cached& cached = cache_[name];
  if (draco_ && draco_->has(name)) {
    cached.elements = draco_->elements(name, elementType(*file_, *reference, widths, integers));
    cached.accessor = kNoAccessor;
    charge(cached.elements.count, *reference);
  } else if (cached.elements.count == 0 || cached.accessor != accessor) {
    cached.elements = readElements(*file_, *reference, widths, integers);
    cached.accessor = accessor;
    charge(cached.elements.count, *reference);
  }
  if (vertexCount != 0 && cached.elements.count != vertexCount) {
    reference->refuse(fmt::format("has {} elements; expected {}, as POSITION has", cached.elements.count, vertexCount));
  }
  return &cached.elements;
}

std::vector<std::uint32_t> PrimitiveReader::triangleCorners(const JsonView& primitive, std::size_t vertexCount) {
  if (draco_) {
    std::vector<std::uint32_t> corners = draco_->corners();
    charge(corners.size(), primitive);
    return corners;
  }
  std::vector<std::uint32_t> order;
  if (const std::optional<JsonView> indices = primitive.find("indices")) {
    order = readIndices(*file_, *indices);
    const auto beyond = std::find_if(order.begin(), order.end(), [&](std::uint32_t i) { return i >= vertexCount; });
    if (beyond != order.end()) {
      indices->refuse(fmt::format("hold {}; expected indices below {}, the vertex count", *beyond, vertexCount));
    }
  } else {
    order.resize(vertexCount);
    for (std::size_t i = 0; i < vertexCount; ++i) order[i] = static_cast<std::uint32_t>(i);
  }
  charge(order.size(), primitive);
  const std::size_t mode = primitive.unsignedInteger("mode", kTriangles);
  if (mode == kTriangles) {
    if (order.size() % 3 != 0) ++unfinished_;
    order.resize(order.size() / 3 * 3);
    return order;
  }
  const std::size_t triangles = order.size() < 3 ? 0 : order.size() - 2;
  std::vector<std::uint32_t> corners;
  corners.reserve(triangles * 3);
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::size_t odd = i % 2;
    if (mode == kTriangleStrip) {
      corners.insert(corners.end(), {order[i], order[i + 1 + odd], order[i + 2 - odd]});
    } else {
      corners.insert(corners.end(), {order[i + 1], order[i + 2], order[0]});
    }
  }
  return corners;
}

void PrimitiveReader::charge(std::size_t elements, const JsonView& user) {
  // A small file that names the same buffers again and again must not take time and memory without end.
  constexpr std::size_t kFree = std::size_t{1} << 22, kPerByte = 64;
  charged_ += elements;
  if (charged_ > kFree + kPerByte * file_->bytesRead()) {
    user.refuse(fmt::format("takes the file to {} vertices and triangles; expected at most {} a byte of it", charged_,
                            kPerByte));
  }
}

std::optional<Primitive> PrimitiveReader::read(const JsonView& primitive, const Pose& pose) {
  const std::size_t mode = primitive.unsignedInteger("mode", kTriangles);
  if (mode > kTriangleFan) primitive.at("mode").refuse(fmt::format("is {}; expected 0 to 6", mode));
  if (mode < kTriangles) {
    ++points_;
    return std::nullopt;
  }
  draco_.reset();
  if (const auto packed = primitive.extension("KHR_draco_mesh_compression"))
    draco_ = std::make_unique<DracoMesh>(*file_, primitive, *packed);
  const JsonView attributes = primitive.at("attributes");
  attributes.at("POSITION");
  const Integers placed = quantised_ ? Integers::any : Integers::none;
  const Integers turned = quantised_ ? Integers::normalised : Integers::none;
  const Integers mapped = quantised_ ? Integers::any : Integers::normalised;
  const Elements* positions = attribute(attributes, "POSITION", {3}, placed, 0);
  const std::size_t count = positions->count;
  const Elements* normals = attribute(attributes, "NORMAL", {3}, turned, count);
  // Without normals the file's tangents do not count (glTF 2.0, Meshes).
  const Elements* tangents = normals ? attribute(attributes, "TANGENT", {4}, turned, count) : nullptr;
  const Elements* uvs[2] = {attribute(attributes, "TEXCOORD_0", {2}, mapped, count),
                            attribute(attributes, "TEXCOORD_1", {2}, mapped, count)};
  const Elements* colours = attribute(attributes, "COLOR_0", {3, 4}, Integers::normalised, count);
  Elements movedPositions, movedNormals, movedTangents;
  if (pose.moves()) {
    charge(count * (2 + pose.weights.size()), primitive);
    const auto copied = [](const Elements*& from, Elements& to) {
      if (from) to = *from;
      if (from) from = &to;
    };
    copied(positions, movedPositions);
    copied(normals, movedNormals);
    copied(tangents, movedTangents);
    applyPose(*file_, primitive, pose, quantised_, movedPositions, normals ? &movedNormals : nullptr,
              tangents ? &movedTangents : nullptr, unbound_);
  }
  const std::vector<std::uint32_t> corners = triangleCorners(primitive, count);
  if (compact_.size() < count) compact_.resize(count, kUnused);

  Primitive result;
  const auto vertexAt = [&](std::uint32_t i, glm::vec3 flat) {
    Vertex vertex;
    vertex.position = vec3At(*positions, i);
    vertex.normal = flat;
    if (normals) {
      const glm::dvec3 normal(vec3At(*normals, i));
      const double length = glm::length(normal);  // in double: no finite float overflows
      if (std::isfinite(length) && length > 0.0) {
        vertex.normal = glm::vec3(normal / length);
      } else {
        ++repairedNormals_;
      }
    }
    if (tangents) vertex.tangent = tangentAt(*tangents, i, vertex.normal);
    for (int set = 0; set < 2; ++set) vertex.uv[set] = uvs[set] ? uvAt(*uvs[set], i, repairedValues_) : glm::vec2(0.0f);
    if (colours) {
      for (std::size_t c = 0; c < colours->width; ++c) {
        vertex.colour[static_cast<int>(c)] = unitValue(colours->at(i, c), repairedValues_);
      }
    }
    return vertex;
  };
  result.indices.reserve(corners.size());
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const std::uint32_t corner[3] = {corners[t], corners[t + 1], corners[t + 2]};
    const glm::vec3 a = vec3At(*positions, corner[0]), b = vec3At(*positions, corner[1]),
                    c = vec3At(*positions, corner[2]);
    if (!finite(a) || !finite(b) || !finite(c)) {
      ++nonFinite_;
      continue;
    }
    const glm::dvec3 area = areaNormal(a, b, c);
    const double twice = glm::length(area);
    if (!(twice > 0.0)) {
      // Strips repeat a vertex on purpose, to jump.
      const bool jump =
          mode != kTriangles && (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]);
      if (!jump) ++degenerate_;
      continue;
    }
    const glm::vec3 flat(area / twice);
    for (const std::uint32_t i : corner) {
      // Without normals every triangle has its own vertices.
      if (normals && compact_[i] != kUnused) {
        result.indices.push_back(compact_[i]);
        continue;
      }
      const auto kept = static_cast<std::uint32_t>(result.vertices.size());
      if (normals) compact_[i] = kept;
      result.vertices.push_back(vertexAt(i, flat));
      result.indices.push_back(kept);
    }
  }
  for (const std::uint32_t i : corners) compact_[i] = kUnused;
  charge(result.vertices.size(), primitive);
  if (result.indices.empty()) {
    notes_->add(primitive.where() + " has no triangle that can be drawn");
    return std::nullopt;
  }
  return result;
}

void PrimitiveReader::noteCounts() {
  const auto note = [&](std::size_t& count, const char* what) {
    if (count > 0) notes_->add(fmt::format("{} {}", count, what));
    count = 0;
  };
  note(points_, "primitives are points or lines and are not drawn");
  note(unfinished_, "triangle lists end in the middle of a triangle, which is left out");
  note(nonFinite_, "triangles have a position that is not finite and are left out");
  note(degenerate_, "triangles have no area and are left out");
  note(repairedNormals_, "normals have no direction and are replaced by the triangle's");
  note(unbound_, "vertices of skins have no weight and follow their first joint");
  note(repairedValues_, "vertex colours or texture coordinates are out of range and are clamped");
}

Primitive withFlippedWinding(Primitive primitive) {
  for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    std::swap(primitive.indices[t + 1], primitive.indices[t + 2]);
  }
  // Mirrored, a right-handed frame is a left-handed one.
  for (Vertex& vertex : primitive.vertices) vertex.tangent.y = -vertex.tangent.y;
  return primitive;
}

}  // namespace pellucid::gltf
