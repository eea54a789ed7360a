#include "engine_bridge/scene/file_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/errors.h"
#include "shaders/shading.h"

namespace pellucid::gltf {

namespace {

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

std::size_t FileTriangles::triangles() const {
  const std::size_t count = corners();
  if (mode == kTriangles) return count / 3;
  return count < 3 ? 0 : count - 2;
}

std::array<std::uint32_t, 3> FileTriangles::cornersOf(std::size_t number) const {
  const std::size_t odd = number % 2;
  const std::array<std::size_t, 3> places = mode == kTriangles ? std::array{3 * number, 3 * number + 1, 3 * number + 2}
                                            : mode == kTriangleStrip
                                                ? std::array{number, number + 1 + odd, number + 2 - odd}
                                                : std::array{number + 1, number + 2, std::size_t{0}};
  std::array<std::uint32_t, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = corner(places[k]);
    if (corners[k] >= positions->count) throw InputError(place + " has changed since it was opened");
  }
  return corners;
}

RawTriangle FileTriangles::triangle(std::size_t number, Faults& faults) const {
  RawTriangle result;
  result.corners = cornersOf(number);
  if (!mirrored.empty()) {
    int turned = 0;
    for (const std::uint32_t corner : result.corners) turned += mirrored[corner] ? 1 : 0;
    if (turned > 1) std::swap(result.corners[1], result.corners[2]);  // glTF 2.0, 3.7.4
  }
  glm::vec3 p[3];
  for (std::size_t k = 0; k < 3; ++k) p[k] = vec3At(*positions, result.corners[k]);
  if (!finite(p[0]) || !finite(p[1]) || !finite(p[2])) {
    ++faults.nonFinite;
    return result;
  }
  const glm::dvec3 area = areaNormal(p[0], p[1], p[2]);
  const double twice = glm::length(area);
  if (!(twice > 0.0)) {
    // Strips repeat a vertex on purpose, to jump.
    const std::array<std::uint32_t, 3>& c = result.corners;
    const bool jump = mode != kTriangles && (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]);
    if (!jump) ++faults.degenerate;
    return result;
  }
  result.flat = glm::vec3(area / twice);
  result.drawn = true;
  return result;
}

bool FileTriangles::shared(std::size_t number) const {
  if (!normals) return false;
  const double length = glm::length(glm::dvec3(vec3At(*normals, number)));  // in double: no finite float overflows
  return std::isfinite(length) && length > 0.0;
}

Vertex FileTriangles::vertex(std::size_t number, glm::vec3 flat, Faults& faults) const {
  Vertex vertex;
  vertex.position = vec3At(*positions, number);
  vertex.normal = flat;
  if (normals) {
    const glm::dvec3 normal(vec3At(*normals, number));
    if (shared(number)) {
      vertex.normal = glm::vec3(normal / glm::length(normal));
    } else {
      ++faults.repairedNormals;
    }
  }
  if (tangents) vertex.tangent = tangentAt(*tangents, number, vertex.normal);
  for (std::size_t set = 0; set < 2; ++set)
    vertex.uv[set] = uvs[set] ? uvAt(*uvs[set], number, faults.repairedValues) : glm::vec2(0.0f);
  if (colours) {
    for (std::size_t c = 0; c < colours->width; ++c)
      vertex.colour[static_cast<int>(c)] = unitValue(colours->at(number, c), faults.repairedValues);
  }
  return vertex;
}

template <class Visit>
void FileTriangles::eachAttribute(const Visit& visit) const {
  for (const Shared* attribute : {&positions, &normals, &tangents, &uvs[0], &uvs[1], &colours})
    if (*attribute) visit(**attribute);
}

void FileTriangles::announceVertices(std::size_t first, std::size_t last) const {
  eachAttribute([&](const Elements& attribute) { attribute.announce(first, last); });
}

// Also settles what was announced before.
void FileTriangles::announceCorners(std::size_t first, std::size_t count) const {
  eachAttribute([](const Elements& attribute) { attribute.settle(); });
  if (!indices) return;
  indices->settle();
  indices->announce(mode == kTriangles ? 3 * first : first,
                    mode == kTriangles ? 3 * (first + count) - 1 : first + count + 1);
}

bool FileTriangles::announce(std::size_t first, std::size_t count) const {
  if (count == 0) return true;
  announceCorners(first, count);
  const std::size_t begin = mode == kTriangles ? 3 * first : first;
  const std::size_t end = mode == kTriangles ? 3 * (first + count) : first + count + 2;
  std::uint32_t least = corner(mode == kTriangleFan ? 0 : begin), most = least;
  for (std::size_t i = begin; i < end; ++i) {
    least = std::min(least, corner(i));
    most = std::max(most, corner(i));
  }
  if (most >= positions->count) throw InputError(place + " has changed since it was opened");
  // Little more than the triangles' own vertices?
  if (most - least > 8 * count) return false;
  announceVertices(least, most);
  return true;
}

void FileTriangles::announceOne(std::size_t number) const {
  announceCorners(number, 1);
  for (const std::uint32_t corner : cornersOf(number)) announceVertices(corner, corner);
}

void FileTriangles::requireWhole() const {
  if (indices) indices->requireWhole();
  eachAttribute([](const Elements& attribute) { attribute.requireWhole(); });
}

namespace {

constexpr std::size_t kBlock = 1024;  // triangles of the file, drawn or not

class StreamedTriangles : public TriangleSource {
 public:
  StreamedTriangles(FileTriangles triangles, Faults& faults);
  std::size_t triangles() const override { return drawnBefore_.back(); }
  const ColourRange& colours() const override { return colours_; }
  void read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const override;

 private:
  std::size_t blockEnd(std::size_t block) const { return std::min((block + 1) * kBlock, file_.triangles()); }
  void append(const RawTriangle& triangle, VertexPlaces& places, TriangleBatch& batch) const;

  FileTriangles file_;
  std::vector<std::size_t> drawnBefore_;  // by block; one more for all
  ColourRange colours_;
};

StreamedTriangles::StreamedTriangles(FileTriangles triangles, Faults& faults)
    : file_(std::move(triangles)), drawnBefore_(1, 0) {
  // A shared vertex is decoded once.
  std::vector<bool> seen(file_.normals ? file_.positions->count : 0, false);
  const std::size_t blocks = (file_.triangles() + kBlock - 1) / kBlock;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t first = block * kBlock, end = blockEnd(block);
    const bool together = file_.announce(first, end - first);
    std::size_t drawn = drawnBefore_.back();
    for (std::size_t number = first; number < end; ++number) {
      if (!together) file_.announceOne(number);
      const RawTriangle triangle = file_.triangle(number, faults);
      if (!triangle.drawn) continue;
      ++drawn;
      for (const std::uint32_t corner : triangle.corners) {
        if (file_.shared(corner)) {
          if (seen[corner]) continue;
          seen[corner] = true;
        }
        colours_.add(file_.vertex(corner, triangle.flat, faults).colour);
      }
    }
    drawnBefore_.push_back(drawn);
  }
}

void StreamedTriangles::append(const RawTriangle& triangle, VertexPlaces& places, TriangleBatch& batch) const {
  Faults ignored;  // counted before
  for (const std::uint32_t corner : triangle.corners) {
    const auto next = static_cast<std::uint32_t>(batch.vertices.size());
    const std::uint32_t place = file_.shared(corner) ? places.placeOf(corner, next) : next;
    batch.indices.push_back(place);
    if (place != next) continue;
    batch.vertices.push_back(file_.vertex(corner, triangle.flat, ignored));
  }
}

void StreamedTriangles::read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const {
  batch.clear();
  places.start(3 * count);
  Faults ignored;
  const auto after = std::upper_bound(drawnBefore_.begin(), drawnBefore_.end(), first);
  std::size_t block = static_cast<std::size_t>(after - drawnBefore_.begin()) - 1;
  for (const std::size_t end = first + count; first < end; ++block) {
    std::size_t drawn = drawnBefore_[block], raw = block * kBlock;
    const std::size_t rawEnd = blockEnd(block), drawnEnd = drawnBefore_[block + 1];
    const bool allDrawn = drawnEnd - drawn == rawEnd - raw;
    if (allDrawn) {  // straight to it
      raw += first - drawn;
      drawn = first;
    }
    const std::size_t span = allDrawn ? std::min(end, drawnEnd) - first : rawEnd - raw;
    const bool together = file_.announce(raw, span);
    for (const std::size_t stop = raw + span; raw < stop; ++raw) {
      if (drawn >= std::min(end, drawnEnd)) break;
      if (!together) file_.announceOne(raw);
      const RawTriangle triangle = file_.triangle(raw, ignored);
      if (!triangle.drawn) continue;
      if (drawn++ < first) continue;
      append(triangle, places, batch);
    }
    if (drawn < std::min(end, drawnEnd)) {
      file_.requireWhole();
      throw InputError(file_.place + " has changed since it was opened");
    }
    first = drawn;
  }
  file_.requireWhole();
}

class MirroredTriangles : public TriangleSource {
 public:
  explicit MirroredTriangles(std::shared_ptr<const TriangleSource> source) : source_(std::move(source)) {}
  std::size_t triangles() const override { return source_->triangles(); }
  const ColourRange& colours() const override { return source_->colours(); }
  void read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const override {
    source_->read(first, count, places, batch);
    for (std::size_t t = 0; t + 2 < batch.indices.size(); t += 3) std::swap(batch.indices[t + 1], batch.indices[t + 2]);
    // Mirrored, a right-handed frame is a left-handed one.
    for (Vertex& vertex : batch.vertices) vertex.tangent.y = -vertex.tangent.y;
  }

 private:
  std::shared_ptr<const TriangleSource> source_;
};

}  // namespace

std::shared_ptr<const TriangleSource> streamTriangles(FileTriangles triangles, Faults& faults) {
  return std::make_shared<StreamedTriangles>(std::move(triangles), faults);
}

std::shared_ptr<const TriangleSource> mirroredTriangles(const std::shared_ptr<const TriangleSource>& source) {
  return std::make_shared<MirroredTriangles>(source);
}

}  // namespace pellucid::gltf
