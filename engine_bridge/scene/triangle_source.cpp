#include "engine_bridge/scene/triangle_source.h"

#include <algorithm>
#include <stdexcept>

namespace pellucid {

void VertexPlaces::start(std::size_t most) {
  std::uint32_t bits = 1;
  while ((std::size_t{1} << bits) < 2 * most) ++bits;
  if (table_.size() < std::size_t{1} << bits || ++turn_ == 0) {
    table_.assign(std::max(table_.size(), std::size_t{1} << bits), Entry{0, 0, 0});
    turn_ = 1;
  }
  shift_ = 32;
  for (std::size_t size = table_.size(); size > 1; size /= 2) --shift_;
}

std::size_t Primitive::triangles() const {
  return streamed ? streamed->triangles() : indices.size() / 3;
}

void readTriangles(const Primitive& primitive, std::size_t first, std::size_t count, VertexPlaces& places,
                   TriangleBatch& batch) {
  if (primitive.streamed) {
    primitive.streamed->read(first, count, places, batch);
    return;
  }
  batch.clear();
  places.start(3 * count);
  for (std::size_t i = 3 * first; i < 3 * (first + count); ++i) {
    const std::uint32_t corner = primitive.indices[i];
    if (corner >= primitive.vertices.size()) throw std::logic_error("a primitive's index has no vertex");
    const std::uint32_t place = places.placeOf(corner, static_cast<std::uint32_t>(batch.vertices.size()));
    if (place == batch.vertices.size()) batch.vertices.push_back(primitive.vertices[corner]);
    batch.indices.push_back(place);
  }
}

ColourRange coloursOf(const Primitive& primitive) {
  if (primitive.streamed) return primitive.streamed->colours();
  ColourRange range;
  for (const Vertex& vertex : primitive.vertices) range.add(vertex.colour);
  return range;
}

Scene decodedScene(const Scene& scene) {
  Scene decoded = scene;
  VertexPlaces places;
  TriangleBatch batch;
  constexpr std::size_t kBatch = 1024;
  for (Primitive& primitive : decoded.primitives) {
    if (!primitive.streamed || primitive.points) continue;
    for (std::size_t first = 0; first < primitive.streamed->triangles(); first += kBatch) {
      primitive.streamed->read(first, std::min(kBatch, primitive.streamed->triangles() - first), places, batch);
      const auto base = static_cast<std::uint32_t>(primitive.vertices.size());
      primitive.vertices.insert(primitive.vertices.end(), batch.vertices.begin(), batch.vertices.end());
      for (const std::uint32_t corner : batch.indices) primitive.indices.push_back(base + corner);
    }
    primitive.streamed = nullptr;
  }
  return decoded;
}

std::vector<ColourRange> coloursDrawn(const Scene& scene) {
  std::vector<ColourRange> own, all;
  for (const Primitive& primitive : scene.primitives) own.push_back(coloursOf(primitive));
  all = own;
  for (const Instance& instance : scene.instances) {
    const auto number = static_cast<std::size_t>(instance.primitive);
    all[number].add(own[number].least * instance.colour);
    all[number].add(own[number].most * instance.colour);
  }
  return all;
}

}  // namespace pellucid
