#include "engine_bridge/scene/closed.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <tuple>
#include <vector>

#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {
namespace {

constexpr std::size_t kBatch = 1024;
constexpr double kCancels = 1e-3;       // of the summed areas
constexpr double kWeld = 1e-6;          // of the mesh's extent
constexpr std::size_t kFewOpen = 1000;  // edges among which one may be open

bool areasCancel(const Primitive& primitive) {
  VertexPlaces places;
  TriangleBatch batch;
  glm::dvec3 sum(0.0);
  double all = 0.0;
  for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
    readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      const glm::dvec3 a(batch.vertices[batch.indices[i]].position), b(batch.vertices[batch.indices[i + 1]].position),
          c(batch.vertices[batch.indices[i + 2]].position);
      const glm::dvec3 area = glm::cross(b - a, c - a);
      sum += area;
      all += glm::length(area);
    }
  }
  return all > 0.0 && glm::length(sum) < kCancels * all;
}

// For each vertex the first one in its cell of a grid much finer than the mesh: seams differ in the last bits.
std::vector<std::uint32_t> welded(const std::vector<Vertex>& vertices) {
  glm::vec3 low(0.0f), high(0.0f);
  if (!vertices.empty()) low = high = vertices[0].position;
  for (const Vertex& vertex : vertices) {
    low = glm::min(low, vertex.position);
    high = glm::max(high, vertex.position);
  }
  const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
  const double cell = std::max({size.x, size.y, size.z, 1e-30}) * kWeld;
  std::vector<glm::dvec3> cells;
  cells.reserve(vertices.size());
  for (const Vertex& vertex : vertices)
    cells.push_back(glm::round((glm::dvec3(vertex.position) - glm::dvec3(low)) / cell));
  std::vector<std::uint32_t> order(vertices.size()), result(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tuple(cells[i].x, cells[i].y, cells[i].z, i); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    result[order[i]] = i > 0 && cells[order[i]] == cells[order[i - 1]] ? result[order[i - 1]] : order[i];
  return result;
}

}  // namespace

bool isClosed(const Primitive& primitive) {
  if (primitive.streamed || primitive.triangles() > kMostTested) return areasCancel(primitive);
  const std::vector<std::uint32_t> corner = welded(primitive.vertices);
  struct Edge {
    std::uint32_t low, high;
    int way;
  };
  std::vector<Edge> edges;
  edges.reserve(primitive.indices.size());
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner[primitive.indices[i + k]], b = corner[primitive.indices[i + (k + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::size_t open = 0;
  for (std::size_t i = 0; i < edges.size();) {
    int sum = 0;
    const Edge first = edges[i];
    for (; i < edges.size() && edges[i].low == first.low && edges[i].high == first.high; ++i) sum += edges[i].way;
    open += static_cast<std::size_t>(std::abs(sum));
  }
  return open * kFewOpen <= edges.size() && areasCancel(primitive);
}

}  // namespace pellucid
