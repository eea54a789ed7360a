#include "engine_bridge/scene/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pellucid::gltf {

namespace {

constexpr std::uint32_t kUnused = 0xffffffffu;
constexpr std::size_t kNoAccessor = static_cast<std::size_t>(-1);

// A copy of its own in the place of what is shared; null for what is not there.
Elements* copied(std::shared_ptr<const Elements>& from) {
  if (!from) return nullptr;
  const auto copy = std::make_shared<Elements>(*from);
  from = copy;
  return copy.get();
}

}  // namespace

PrimitiveReader::PrimitiveReader(GltfFile& file, Notes& notes, bool stream)
    : file_(&file), notes_(&notes), stream_(stream), quantised_(file.uses("KHR_mesh_quantization")) {}

PrimitiveReader::Shared PrimitiveReader::attribute(const JsonView& attributes, const char* name,
                                                   std::initializer_list<std::size_t> widths, Integers integers,
                                                   std::size_t vertexCount) {
  const std::optional<JsonView> reference = attributes.find(name);
  if (!reference) return nullptr;
  const std::size_t accessor = reference->index(file_->count("accessors"), "accessors");
  Cached& cached = cache_[name];
  if (draco_ && draco_->has(name)) {
    cached.elements =
        std::make_shared<const Elements>(draco_->elements(name, elementType(*file_, *reference, widths, integers)));
    cached.accessor = kNoAccessor;
    charge(cached.elements->count, *reference);
  } else if (!cached.elements || cached.accessor != accessor || cached.inPlace != inPlace_) {
    cached.elements = std::make_shared<const Elements>(readElements(*file_, *reference, widths, integers, inPlace_));
    cached.accessor = accessor;
    cached.inPlace = inPlace_;
    charge(cached.elements->count, *reference);
  }
  if (vertexCount != 0 && cached.elements->count != vertexCount) {
    reference->refuse(
        fmt::format("has {} elements; expected {}, as POSITION has", cached.elements->count, vertexCount));
  }
  return cached.elements;
}

void PrimitiveReader::readCorners(const JsonView& primitive, FileTriangles& triangles) {
  if (draco_) {
    auto corners = std::make_shared<Indices>();
    corners->values = draco_->corners();
    corners->count = corners->values.size();
    triangles.indices = corners;
    triangles.mode = kTriangles;
  } else if (const std::optional<JsonView> reference = primitive.find("indices")) {
    const auto indices = std::make_shared<const Indices>(placeIndices(*file_, *reference));
    const std::size_t vertexCount = triangles.positions->count;
    constexpr std::size_t kAtOnce = std::size_t{1} << 14;
    for (std::size_t i = 0; i < indices->count; ++i) {
      if (i % kAtOnce == 0) {
        indices->settle();
        indices->announce(i, std::min(i + kAtOnce, indices->count) - 1);
      }
      if (indices->at(i) >= vertexCount) {
        reference->refuse(
            fmt::format("hold {}; expected indices below {}, the vertex count", indices->at(i), vertexCount));
      }
    }
    triangles.indices = indices;
  }
  charge(triangles.corners(), primitive);
  if (triangles.mode == kTriangles && triangles.corners() % 3 != 0) ++unfinished_;
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

// glTF 2.0, 3.7.2.1: a client SHOULD skip what has no POSITION. Exporters write what is hidden with accessors of
// nothing.
bool PrimitiveReader::hasVertices(const JsonView& primitive) {
  const auto holdsNothing = [&](const std::optional<JsonView>& reference) {
    const auto count = reference ? file_->item("accessors", *reference).find("count") : std::nullopt;
    return count && count->unsignedInteger() == 0;
  };
  const std::optional<JsonView> positions = primitive.at("attributes").find("POSITION");
  const bool empty = holdsNothing(positions) || holdsNothing(primitive.find("indices"));
  if (!positions) notes_->add(primitive.where() + " has no POSITION and is not drawn");
  if (empty) notes_->add(primitive.where() + " is empty and is not drawn");
  return positions && !empty;
}

// Exporters leave the word out of bytes that mean parts of 255; whole numbers up to 255 are nobody's colours.
PrimitiveReader::Shared PrimitiveReader::vertexColours(const JsonView& attributes, std::size_t vertexCount) {
  const std::optional<JsonView> reference = attributes.find("COLOR_0");
  if (!reference) return nullptr;
  constexpr std::size_t kFloat = 5126;
  const JsonView accessor = file_->item("accessors", *reference);
  if (accessor.unsignedInteger("componentType", kFloat) != kFloat && !accessor.boolean("normalized", false))
    ++wholeColours_;
  return attribute(attributes, "COLOR_0", {3, 4}, Integers::asNormalised, vertexCount);
}

std::optional<Primitive> PrimitiveReader::read(const JsonView& primitive, const Pose& pose, bool decode) {
  const std::size_t mode = primitive.unsignedInteger("mode", kTriangles);
  if (mode > kTriangleFan) primitive.at("mode").refuse(fmt::format("is {}; expected 0 to 6", mode));
  if (mode == kPoints) return hasVertices(primitive) ? points(primitive, pose) : std::nullopt;
  if (mode < kTriangles) {
    ++lines_;
    return std::nullopt;
  }
  if (!hasVertices(primitive)) return std::nullopt;
  draco_.reset();
  if (const auto packed = primitive.extension("KHR_draco_mesh_compression"))
    draco_ = std::make_unique<DracoMesh>(*file_, primitive, *packed);
  inPlace_ = stream_ && !decode && !pose.moves();
  const JsonView attributes = primitive.at("attributes");
  const Integers placed = quantised_ ? Integers::any : Integers::none;
  const Integers turned = quantised_ ? Integers::normalised : Integers::none;
  const Integers mapped = quantised_ ? Integers::any : Integers::normalised;
  Shared positions = attribute(attributes, "POSITION", {3}, placed, 0);
  const std::size_t count = positions->count;
  Shared normals = attribute(attributes, "NORMAL", {3}, turned, count);
  // Without normals the file's tangents do not count (glTF 2.0, Meshes).
  Shared tangents = normals ? attribute(attributes, "TANGENT", {4}, turned, count) : nullptr;
  Shared uvs[2] = {attribute(attributes, "TEXCOORD_0", {2}, mapped, count),
                   attribute(attributes, "TEXCOORD_1", {2}, mapped, count)};
  Shared colours = vertexColours(attributes, count);
  FileTriangles triangles;
  if (pose.moves()) {
    charge(count * (2 + pose.weights.size()), primitive);
    PosedAttributes posed;
    posed.positions = copied(positions);
    posed.normals = copied(normals);
    posed.tangents = copied(tangents);
    posed.colours = copied(colours);
    for (std::size_t set = 0; set < 2; ++set) posed.uvs[set] = copied(uvs[set]);
    applyPose(*file_, primitive, pose, quantised_, posed, repairs_);
    triangles.mirrored = std::move(posed.mirrored);
  }
  triangles.place = printable(file_->path() + ": " + primitive.where());
  triangles.mode = mode;
  triangles.positions = positions;
  triangles.normals = normals;
  triangles.tangents = tangents;
  triangles.uvs = {uvs[0], uvs[1]};
  triangles.colours = colours;
  readCorners(primitive, triangles);

  Primitive result;
  if (stream_ && !decode) {
    charge(3 * triangles.triangles(), primitive);  // as many vertices as decoding could make
    result.streamed = streamTriangles(std::move(triangles), faults_);
  } else {
    result = decoded(triangles);
    charge(result.vertices.size(), primitive);
  }
  if (result.triangles() == 0) {
    notes_->add(primitive.where() + " has no triangle that can be drawn");
    return std::nullopt;
  }
  return result;
}

std::optional<Primitive> PrimitiveReader::points(const JsonView& primitive, const Pose& pose) {
  if (pose.moves()) notes_->add(primitive.where() + ": points of skins and morph targets stand as the file has them");
  draco_.reset();
  inPlace_ = stream_;
  if (!hasVertices(primitive)) return std::nullopt;
  const JsonView attributes = primitive.at("attributes");
  FilePoints file;
  file.place = printable(file_->path() + ": " + primitive.where());
  file.positions = attribute(attributes, "POSITION", {3}, quantised_ ? Integers::any : Integers::none, 0);
  const std::size_t count = file.positions->count;
  file.radii = attribute(attributes, "_RADIUS", {1}, Integers::normalised, count);
  file.colours = vertexColours(attributes, count);
  if (const std::optional<JsonView> reference = primitive.find("indices")) {
    const auto indices = std::make_shared<const Indices>(placeIndices(*file_, *reference));
    for (std::size_t i = 0; i < indices->count; ++i) {
      if (i % 16384 == 0) {
        indices->settle();
        indices->announce(i, std::min(i + 16384, indices->count) - 1);
      }
      if (indices->at(i) >= count)
        reference->refuse(fmt::format("hold {}; expected indices below {}, the vertex count", indices->at(i), count));
    }
    file.indices = indices;
  }
  charge(3 * file.count(), primitive);
  if (!file.radii) ++withoutRadius_;
  Primitive result;
  result.points = true;
  result.streamed = particlesOf(std::move(file), pointFaults_);
  if (result.triangles() == 0) return std::nullopt;
  return result;
}

Primitive PrimitiveReader::decoded(const FileTriangles& triangles) {
  if (compact_.size() < triangles.positions->count) compact_.resize(triangles.positions->count, kUnused);
  std::vector<std::uint32_t> used;
  Primitive result;
  result.indices.reserve(3 * triangles.triangles());
  for (std::size_t t = 0; t < triangles.triangles(); ++t) {
    const RawTriangle triangle = triangles.triangle(t, faults_);
    if (!triangle.drawn) continue;
    for (const std::uint32_t i : triangle.corners) {
      const bool shared = triangles.shared(i);
      if (shared && compact_[i] != kUnused) {
        result.indices.push_back(compact_[i]);
        continue;
      }
      const auto kept = static_cast<std::uint32_t>(result.vertices.size());
      if (shared) {
        compact_[i] = kept;
        used.push_back(i);
      }
      result.vertices.push_back(triangles.vertex(i, triangle.flat, faults_));
      result.indices.push_back(kept);
    }
  }
  for (const std::uint32_t i : used) compact_[i] = kUnused;
  return result;
}

void PrimitiveReader::noteCounts() {
  const auto note = [&](std::size_t& count, const char* what) {
    if (count > 0) notes_->add(fmt::format("{} {}", count, what));
    count = 0;
  };
  note(lines_, "primitives are lines and are not drawn");
  note(withoutRadius_, "point primitives have no _RADIUS; their particles get 0.05 times their scale");
  note(pointFaults_.nonFinite, "points have a position that is not finite and are left out");
  note(pointFaults_.noRadius, "points have a radius that is not above 0 and are left out");
  note(pointFaults_.repairedColours, "colour values of points are out of range and are clamped");
  note(unfinished_, "triangle lists end in the middle of a triangle, which is left out");
  note(faults_.nonFinite, "triangles have a position that is not finite and are left out");
  note(faults_.degenerate, "triangles have no area and are left out");
  note(faults_.repairedNormals, "normals have no direction and are replaced by the triangle's");
  note(repairs_.unbound, "vertices of skins have no weight and follow their first joint");
  note(repairs_.otherWeights,
       "primitives have another number of morph targets than of weights; what has no weight stands still");
  note(wholeColours_, "primitives have whole numbers as COLOR_0, which are taken as parts of the largest");
  note(faults_.repairedValues, "vertex colours or texture coordinates are out of range and are clamped");
}

Primitive withFlippedWinding(Primitive primitive) {
  if (primitive.points) return primitive;  // the vertex stage turns them to the camera
  if (primitive.streamed) primitive.streamed = mirroredTriangles(primitive.streamed);
  for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    std::swap(primitive.indices[t + 1], primitive.indices[t + 2]);
  }
  // Mirrored, a right-handed frame is a left-handed one.
  for (Vertex& vertex : primitive.vertices) vertex.tangent.y = -vertex.tangent.y;
  return primitive;
}

}  // namespace pellucid::gltf
