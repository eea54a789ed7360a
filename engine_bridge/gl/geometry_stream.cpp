#include "engine_bridge/gl/geometry_stream.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace pellucid::gl {
namespace {

constexpr std::size_t kFewestSlots = 3;
// Below the 16 MiB that GL 4.5 promises of a storage block. While a chunk is drawn, llvmpipe holds it several times
// over.
constexpr std::size_t kMostChunkBytes = std::size_t{4} << 20;
constexpr std::uint32_t kShuffledRun = 64;  // triangles that a shuffle keeps in one draw
constexpr std::uint32_t kBatch = 1024;      // triangles decoded at once
constexpr std::uint32_t kUnplaced = 0xffffffffu;
constexpr std::size_t kTriangleBytes = 3 * sizeof(std::uint32_t) + sizeof(std::uint32_t);

// SplitMix64's finaliser.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

std::uint32_t trianglesOf(const Primitive& primitive) {
  return static_cast<std::uint32_t>(primitive.triangles());
}

// What a sweep draws of an instance; null for none.
const Primitive* drawn(const Scene& scene, const Instance& instance, bool opaque) {
  const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
  const bool transparent = scene.materials.at(static_cast<std::size_t>(primitive.material)).transparent();
  return transparent == opaque ? nullptr : &primitive;
}

// Fisher-Yates over a run of at most kShuffledRun triangles.
std::uint32_t shuffledTurn(std::uint64_t key, std::uint32_t count, std::uint32_t turn) {
  std::uint32_t order[kShuffledRun];
  std::iota(order, order + count, 0u);
  for (std::uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[mixed(key + i) % i]);
  return order[turn];
}

}  // namespace

void ChunkData::clear() {
  vertices.clear();
  indices.clear();
  triangleNumbers.clear();
  draws.clear();
}

std::size_t ChunkData::bytes() const {
  return vertices.size() * sizeof(Vertex) + (indices.size() + triangleNumbers.size()) * sizeof(std::uint32_t);
}

ChunkCutter::ChunkCutter(const Scene& scene, SubmissionOrder order, std::size_t chunkBytes, bool opaque)
    : scene_(scene), order_(order), chunkBytes_(chunkBytes) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Primitive* found = drawn(scene, scene.instances[i], opaque);
    if (!found) continue;
    const Primitive& primitive = *found;
    const std::uint32_t triangles = trianglesOf(primitive);
    const std::uint32_t step = order.kind == SubmissionOrder::shuffle ? kShuffledRun : std::max(triangles, 1u);
    for (std::uint32_t first = 0; first < triangles; first += step)
      runs_.push_back({static_cast<std::uint32_t>(i), first, std::min(step, triangles - first)});
  }
  if (order.kind == SubmissionOrder::reverse) std::reverse(runs_.begin(), runs_.end());
  if (order.kind == SubmissionOrder::shuffle)
    for (std::size_t i = runs_.size(); i > 1; --i) std::swap(runs_[i - 1], runs_[mixed(order.seed ^ mixed(i)) % i]);
}

std::uint32_t ChunkCutter::triangleAt(const Run& run, std::uint32_t turn) const {
  if (order_.kind == SubmissionOrder::reverse) return run.first + run.count - 1 - turn;
  if (order_.kind == SubmissionOrder::shuffle) {
    const std::uint64_t key = mixed(order_.seed ^ mixed((std::uint64_t{run.instance} << 32) | run.first));
    return run.first + shuffledTurn(key, run.count, turn);
  }
  return run.first + turn;
}

bool ChunkCutter::reuseWhole(const Run& run, ChunkData& chunk) {
  if (done_ != 0) return false;
  const auto found = whole_.find(scene_.instances[run.instance].primitive);
  if (found == whole_.end()) return false;
  ChunkDraw draw = found->second;
  draw.instance = run.instance;
  chunk.draws.push_back(draw);
  return true;
}

void ChunkCutter::fetch(const Run& run, std::uint32_t triangle) {
  if (triangle - batchFirst_ < batchCount_) return;
  const std::uint32_t end = run.first + run.count;
  batchFirst_ = triangle;
  if (order_.kind == SubmissionOrder::reverse)
    batchFirst_ = std::max(run.first, triangle - std::min(triangle, kBatch - 1));
  if (order_.kind == SubmissionOrder::shuffle) batchFirst_ = run.first;
  batchCount_ = std::min(kBatch, (order_.kind == SubmissionOrder::reverse ? triangle + 1 : end) - batchFirst_);
  const int number = scene_.instances[run.instance].primitive;
  readTriangles(scene_.primitives[static_cast<std::size_t>(number)], batchFirst_, batchCount_, places_, batch_);
  place_.assign(batch_.vertices.size(), kUnplaced);
}

bool ChunkCutter::appendRun(const Run& run, ChunkData& chunk) {
  const int number = scene_.instances[run.instance].primitive;
  ChunkDraw draw{run.instance, static_cast<std::uint32_t>(chunk.triangleNumbers.size()), 0};
  const bool fromStart = done_ == 0;
  if (fromStart) batchCount_ = 0;
  std::fill(place_.begin(), place_.end(), kUnplaced);
  bool full = false;
  for (; done_ < run.count; ++done_) {
    const std::uint32_t triangle = triangleAt(run, done_);
    fetch(run, triangle);
    const std::uint32_t* corners = &batch_.indices[std::size_t{3} * (triangle - batchFirst_)];
    std::size_t fresh = 0;
    for (int i = 0; i < 3; ++i) fresh += place_[corners[i]] == kUnplaced ? 1 : 0;
    full = !chunk.indices.empty() && chunk.bytes() + fresh * sizeof(Vertex) + kTriangleBytes > chunkBytes_;
    if (full) break;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t& place = place_[corners[i]];
      if (place == kUnplaced) {
        place = static_cast<std::uint32_t>(chunk.vertices.size());
        chunk.vertices.push_back(batch_.vertices[corners[i]]);
      }
      chunk.indices.push_back(place);
    }
    chunk.triangleNumbers.push_back(triangle);
    ++draw.triangles;
  }
  if (draw.triangles > 0) chunk.draws.push_back(draw);
  if (!full && fromStart && run.count == trianglesOf(scene_.primitives[static_cast<std::size_t>(number)]))
    whole_.emplace(number, draw);
  return !full;
}

bool ChunkCutter::next(ChunkData& chunk) {
  chunk.clear();
  whole_.clear();
  for (; run_ < runs_.size(); ++run_, done_ = 0) {
    if (reuseWhole(runs_[run_], chunk)) continue;
    if (!appendRun(runs_[run_], chunk)) break;
  }
  return !chunk.draws.empty();
}

GeometryStream::GeometryStream(const Scene& scene, bool opaque) : scene_(scene), opaque_(opaque) {
  forget();
}

void GeometryStream::forget() {
  resident_ = false;
  sceneTriangles_ = sceneInstances_ = 0;
  for (const Instance& instance : scene_.instances)
    if (const Primitive* primitive = drawn(scene_, instance, opaque_)) {
      sceneTriangles_ += trianglesOf(*primitive);
      ++sceneInstances_;
    }
}

GeometryStream::Slot GeometryStream::makeSlot() const {
  Slot slot;
  slot.vertices = Buffer::make();
  slot.indices = Buffer::make();
  slot.triangleNumbers = Buffer::make();
  slot.array = VertexArray::make();
  checkGl("preparing the geometry stream");
  return slot;
}

void GeometryStream::upload(const ChunkData& chunk, Slot& slot) {
  // Else a driver keeps the chunk before for as long as it is being drawn, beside this one: beyond the budget.
  fences().wait(slot.drawn);
  auto fill = [](const Buffer& buffer, const auto& values) {
    glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                      GL_STREAM_DRAW);
  };
  fill(slot.vertices, chunk.vertices);
  fill(slot.indices, chunk.indices);
  fill(slot.triangleNumbers, chunk.triangleNumbers);
  checkGl("uploading geometry");
  slot.draws = chunk.draws;
}

void GeometryStream::present(Slot& slot, const std::function<void(const std::vector<ChunkDraw>&)>& draw) {
  glBindVertexArray(slot.array.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, slot.triangleNumbers.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, slot.vertices.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, slot.indices.name());
  draw(slot.draws);
  slot.drawn = fences().mark();
}

void GeometryStream::sweep(SubmissionOrder order, std::size_t budgetBytes,
                           const std::function<void(const std::vector<ChunkDraw>&)>& draw) {
  const bool same =
      order.kind == residentOrder_.kind && order.seed == residentOrder_.seed && budgetBytes == residentBudget_;
  if (resident_ && same) {
    for (std::size_t i = 0; i < chunks_; ++i) present(slots_[i], draw);
    return;
  }
  residentOrder_ = order;
  residentBudget_ = budgetBytes;
  resident_ = false;
  chunks_ = triangles_ = draws_ = 0;
  // One share is the copy being cut; the rest lie in slots.
  const std::size_t chunkBytes = std::min(budgetBytes / (kFewestSlots + 1), kMostChunkBytes);
  const std::size_t slots = std::max(kFewestSlots, budgetBytes / std::max<std::size_t>(chunkBytes, 1) - 1);
  ChunkCutter cutter(scene_, order, chunkBytes, opaque_);
  // Room at once: what grows is copied, and for a while there twice. Pages without use are not there at all.
  staging_.vertices.reserve(chunkBytes / sizeof(Vertex));
  staging_.indices.reserve(chunkBytes / kTriangleBytes * 3);
  staging_.triangleNumbers.reserve(chunkBytes / kTriangleBytes);
  while (cutter.next(staging_)) {
    const std::size_t index = chunks_ % slots;
    if (index == slots_.size()) slots_.push_back(makeSlot());
    upload(staging_, slots_[index]);
    present(slots_[index], draw);
    ++chunks_;
    draws_ += staging_.draws.size();
    for (const ChunkDraw& one : staging_.draws) triangles_ += one.triangles;
  }
  resident_ = chunks_ <= slots;
}

}  // namespace pellucid::gl
