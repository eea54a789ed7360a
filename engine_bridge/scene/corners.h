// The corners of a scene's triangles where its instances put them, wherever the triangles lie.
#pragma once
#include <algorithm>

#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {

// Calls each(instance, corner) for every corner of the triangles whose material is wanted, in file order; those that
// triangles share are told once a batch.
//   space   from world space to where the corners are asked for
//   wanted  of a Material
template <class Wanted, class Each>
void forEachCorner(const Scene& scene, const glm::dmat4& space, const Wanted& wanted, const Each& each) {
  constexpr std::size_t kBatch = 1024;
  VertexPlaces places;
  TriangleBatch batch;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    if (!wanted(scene.materials[static_cast<std::size_t>(primitive.material)])) continue;
    const glm::dmat4 placed = space * instance.worldFromObject;
    for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (const Vertex& vertex : batch.vertices)
        each(instance, glm::dvec3(placed * glm::dvec4(glm::dvec3(vertex.position), 1.0)));
    }
  }
}

}  // namespace pellucid
