// Triangles by the batch, wherever they lie: in memory, or in a mapped file that decodes them when they are drawn.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

// Some triangles that follow one another. Vertices that they share are there once.
struct TriangleBatch {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
  void clear() {
    vertices.clear();
    indices.clear();
  }
};

// The places that vertices get in a batch, by their number in the whole. Memory goes by the batch, not by the whole.
class VertexPlaces {
 public:
  void start(std::size_t most);  // at most so many different vertices until the next start
  // The place of `vertex`, which is `next` when it has none yet.
  std::uint32_t placeOf(std::uint32_t vertex, std::uint32_t next) {
    for (std::size_t at = vertex * 2654435769u >> shift_;; at = (at + 1) & (table_.size() - 1)) {
      Entry& entry = table_[at];
      if (entry.turn != turn_) {
        entry = {vertex, next, turn_};
        return next;
      }
      if (entry.vertex == vertex) return entry.place;
    }
  }

 private:
  struct Entry {
    std::uint32_t vertex, place, turn;
  };
  std::vector<Entry> table_;  // open addressing, at most half full; an entry of an earlier turn is free
  std::uint32_t turn_ = 0, shift_ = 31;
};

class TriangleSource {
 public:
  virtual ~TriangleSource() = default;
  virtual std::size_t triangles() const = 0;
  virtual const ColourRange& colours() const = 0;  // of the vertices
  // Fills the batch with triangles [first, first + count). Throws InputError when the file is no longer what it was.
  virtual void read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const = 0;
};

// The same of any primitive.
void readTriangles(const Primitive& primitive, std::size_t first, std::size_t count, VertexPlaces& places,
                   TriangleBatch& batch);
ColourRange coloursOf(const Primitive& primitive);
// By primitive, as its instances colour it.
std::vector<ColourRange> coloursDrawn(const Scene& scene);

// The scene with the triangles that lie in their files decoded, but for particles: what rays need of a scene that is
// streamed otherwise. Throws what TriangleSource::read throws.
Scene decodedScene(const Scene& scene);

}  // namespace pellucid
