#include "engine_bridge/scene/scene_extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {
namespace {

constexpr std::size_t kBatch = 1024;
constexpr std::size_t kMostBatches = 64;  // of a primitive: a sixteenth of a million triangles tells where it lies

struct Extent {
  const Camera& camera;
  const GBuffer& gbuffer;
  SceneExtent found = {glm::dvec3(std::numeric_limits<double>::infinity()),
                       glm::dvec3(-std::numeric_limits<double>::infinity()),
                       std::numeric_limits<double>::infinity(),
                       0,
                       0,
                       0};
  std::size_t points = 0;

  void add(const glm::dvec3& world) {
    ++points;
    found.least = glm::min(found.least, world);
    found.most = glm::max(found.most, world);
    const Projected at = project(camera, gbuffer.display, world);
    if (!(at.z > 0.0)) return;
    found.nearest = std::min(found.nearest, at.z);
    found.farthest = std::max(found.farthest, at.z);
    const Window& data = gbuffer.data;
    const double x = std::floor(at.pixel.x), y = std::floor(at.pixel.y);
    if (!(x >= data.x0 && x < data.x1 && y >= data.y0 && y < data.y1)) return;
    ++found.inPicture;
    found.beforeDepth +=
        at.z < static_cast<double>(gbuffer.viewZ.at(static_cast<int>(x) - data.x0, static_cast<int>(y) - data.y0));
  }
};

}  // namespace

std::optional<SceneExtent> extentOf(const Scene& scene, const Camera& camera, const GBuffer& gbuffer) {
  Extent extent{camera, gbuffer};
  VertexPlaces places;
  TriangleBatch batch;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    if (!scene.materials[static_cast<std::size_t>(primitive.material)].transparent()) continue;
    const std::size_t batches = (primitive.triangles() + kBatch - 1) / kBatch;
    const std::size_t every = std::max<std::size_t>(1, batches / kMostBatches);
    for (std::size_t first = 0; first < primitive.triangles(); first += every * kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
        glm::dvec3 middle(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::dvec3 corner(batch.vertices[batch.indices[i + k]].position);
          const glm::dvec3 world(instance.worldFromObject * glm::dvec4(corner, 1.0));
          middle += world / 3.0;
          extent.add(world);
        }
        extent.add(middle);
      }
    }
  }
  if (extent.points == 0) return std::nullopt;
  return extent.found;
}

}  // namespace pellucid
