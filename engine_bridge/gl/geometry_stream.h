// Cuts a scene's transparent triangles into chunks that fit a budget, in the order asked for, and keeps a ring of them
// in GL buffers. What does not fit is uploaded again on every sweep, so memory is set by the budget, not by the file.
#pragma once
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::gl {

// Triangles of one instance that lie together in a chunk.
struct ChunkDraw {
  std::uint32_t instance;       // index into Scene::instances
  std::uint32_t firstTriangle;  // in the chunk's index and triangle-number buffers
  std::uint32_t triangles;
};

struct ChunkData {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;          // into vertices
  std::vector<std::uint32_t> triangleNumbers;  // within the primitive, one per triangle: survives every reordering
  std::vector<ChunkDraw> draws;
  void clear();
  std::size_t bytes() const;
};

// Walks the transparent triangles, or the opaque ones, once. next() fills one chunk of at most `chunkBytes` (but at
// least one triangle).
class ChunkCutter {
 public:
  ChunkCutter(const Scene& scene, SubmissionOrder order, std::size_t chunkBytes, bool opaque = false);
  bool next(ChunkData& chunk);

 private:
  struct Run {  // triangles of one instance, submitted one after the other
    std::uint32_t instance, first, count;
  };
  bool appendRun(const Run& run, ChunkData& chunk);  // false when the chunk is full
  bool reuseWhole(const Run& run, ChunkData& chunk);
  std::uint32_t triangleAt(const Run& run, std::uint32_t turn) const;
  // Has the triangle, and those that are submitted next, in batch_.
  void fetch(const Run& run, std::uint32_t triangle);

  const Scene& scene_;
  SubmissionOrder order_;
  std::size_t chunkBytes_;
  std::vector<Run> runs_;
  std::size_t run_ = 0;     // next run
  std::uint32_t done_ = 0;  // triangles of it that earlier chunks hold
  TriangleBatch batch_;     // of the current run
  VertexPlaces places_;
  std::uint32_t batchFirst_ = 0, batchCount_ = 0;
  std::vector<std::uint32_t> place_;          // vertex of the batch -> vertex of the chunk, kUnplaced
  std::unordered_map<int, ChunkDraw> whole_;  // primitives that lie complete in this chunk: instances share them
};

class GeometryStream {
 public:
  explicit GeometryStream(const Scene& scene, bool opaque = false);

  // Calls `draw` for each chunk in submission order, with an empty vertex array bound, and its buffers as storage
  // blocks 2 (triangle numbers), 5 (vertices) and 6 (indices). Chunks already resident from the last sweep with the
  // same arguments are not uploaded again.
  void sweep(SubmissionOrder order, std::size_t budgetBytes,
             const std::function<void(const std::vector<ChunkDraw>&)>& draw);
  // The scene has been posed anew: what is resident is no longer what it holds.
  void forget();
  std::size_t sceneTriangles() const { return sceneTriangles_; }  // that a sweep draws
  std::size_t sceneInstances() const { return sceneInstances_; }  // that they belong to
  std::size_t chunks() const { return chunks_; }                  // of the last sweep
  std::size_t triangles() const { return triangles_; }            // of the last sweep
  std::size_t draws() const { return draws_; }                    // of the last sweep
  bool resident() const { return resident_; }                     // the next sweep like the last uploads nothing

 private:
  struct Slot {
    Buffer vertices, indices, triangleNumbers;
    VertexArray array;  // empty: the stages pull their vertices
    std::vector<ChunkDraw> draws;
    Fences::Mark drawn = 0;  // passed when the device has drawn the chunk
  };
  Slot makeSlot() const;
  void upload(const ChunkData& chunk, Slot& slot);
  void present(Slot& slot, const std::function<void(const std::vector<ChunkDraw>&)>& draw);

  const Scene& scene_;
  bool opaque_;
  std::vector<Slot> slots_;
  SubmissionOrder residentOrder_;
  std::size_t residentBudget_ = 0;
  bool resident_ = false;  // every chunk lies in a slot
  std::size_t sceneTriangles_ = 0, sceneInstances_ = 0;
  std::size_t chunks_ = 0, triangles_ = 0, draws_ = 0;
  ChunkData staging_;
};

}  // namespace pellucid::gl
