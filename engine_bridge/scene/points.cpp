#include "engine_bridge/scene/points.h"

#include <algorithm>
#include <cmath>

#include "gbuffer/errors.h"

namespace pellucid::gltf {
namespace {

constexpr float kMostRadius = 1e15f;
constexpr std::size_t kBlock = 1024;
// Around the unit disc, counter-clockwise.
const glm::vec2 kCorners[3] = {{0.0f, 2.0f}, {-1.7320508f, -1.0f}, {1.7320508f, -1.0f}};

class Particles : public TriangleSource {
 public:
  Particles(FilePoints file, PointFaults& faults) : file_(std::move(file)) {
    for (std::size_t first = 0; first < file_.count(); first += kBlock) {
      const std::size_t end = std::min(first + kBlock, file_.count());
      announce(first, end - first);
      for (std::size_t i = first; i < end; ++i) colours_.add(particle(i, faults).colour);
    }
  }
  std::size_t triangles() const override { return file_.count(); }
  const ColourRange& colours() const override { return colours_; }

  void read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const override {
    batch.clear();
    places.start(3 * count);
    PointFaults ignored;  // counted before
    announce(first, count);
    for (std::size_t i = first; i < first + count; ++i) {
      Vertex vertex = particle(i, ignored);
      for (const glm::vec2& corner : kCorners) {
        vertex.uv[0] = corner;
        batch.indices.push_back(static_cast<std::uint32_t>(batch.vertices.size()));
        batch.vertices.push_back(vertex);
      }
    }
    if (file_.indices) file_.indices->requireWhole();
    each([](const Elements& elements) { elements.requireWhole(); });
  }

 private:
  template <class Visit>
  void each(const Visit& visit) const {
    for (const auto* elements : {&file_.positions, &file_.radii, &file_.colours})
      if (*elements) visit(**elements);
  }

  // Their files keep pages of what is announced alone.
  void announce(std::size_t first, std::size_t count) const {
    each([](const Elements& elements) { elements.settle(); });
    if (count == 0) return;
    if (!file_.indices) {
      each([&](const Elements& elements) { elements.announce(first, first + count - 1); });
      return;
    }
    file_.indices->settle();
    file_.indices->announce(first, first + count - 1);
    std::uint32_t least = file_.indices->at(first), most = least;
    for (std::size_t i = first; i < first + count; ++i) {
      least = std::min(least, file_.indices->at(i));
      most = std::max(most, file_.indices->at(i));
    }
    if (most >= file_.positions->count) throw InputError(file_.place + " has changed since it was opened");
    each([&](const Elements& elements) { elements.announce(least, most); });
  }

  Vertex particle(std::size_t number, PointFaults& faults) const {
    const std::size_t i = file_.indices ? file_.indices->at(number) : number;
    if (i >= file_.positions->count) throw InputError(file_.place + " has changed since it was opened");
    Vertex vertex;
    vertex.normal = glm::vec3(0.0f, 0.0f, 1.0f);
    for (std::size_t c = 0; c < 3; ++c) vertex.position[static_cast<int>(c)] = file_.positions->at(i, c);
    float radius = file_.radii ? file_.radii->at(i, 0) : kPointRadius;
    if (!std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z)) {
      ++faults.nonFinite;
      vertex.position = glm::vec3(0.0f);
      radius = 0.0f;
    } else if (!(radius > 0.0f && radius <= kMostRadius)) {
      ++faults.noRadius;
      radius = 0.0f;
    }
    vertex.uv[0] = glm::vec2(0.0f);
    vertex.uv[1] = {radius, 0.0f};
    if (file_.colours)
      for (std::size_t c = 0; c < file_.colours->width; ++c) {
        const float value = file_.colours->at(i, c);
        const float inside = value >= 0.0f ? std::min(value, 1.0f) : 0.0f;
        if (inside != value) ++faults.repairedColours;
        vertex.colour[static_cast<int>(c)] = inside;
      }
    return vertex;
  }

  FilePoints file_;
  ColourRange colours_;
};

}  // namespace

std::shared_ptr<const TriangleSource> particlesOf(FilePoints points, PointFaults& faults) {
  return std::make_shared<Particles>(std::move(points), faults);
}

}  // namespace pellucid::gltf
