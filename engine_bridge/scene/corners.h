// The corners of a scene's triangles where its instances put them, wherever the triangles lie.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

#include "engine_bridge/scene/placed.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {

// Calls each(instance, corner, middle, reach) for every corner of the triangles whose material is wanted, in file
// order; those that triangles share are told once a batch.
//   space   from world space to where the corners are asked for, of its metres
//   wanted  of a Material
//   middle  what turns to whoever looks turns about it, as particles and billboards do; else the corner
//   reach   how far from there it may come to lie: the radius of a particle, a billboard's corner's distance; else 0
template <class Wanted, class Each>
void forEachReach(const Scene& scene, const glm::dmat4& space, const Wanted& wanted, const Each& each) {
  constexpr std::size_t kBatch = 1024;
  VertexPlaces places;
  TriangleBatch batch;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    if (!wanted(scene.materials[static_cast<std::size_t>(primitive.material)])) continue;
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    const glm::dmat4 placed = space * instance.worldFromObject;
    const glm::dvec3 middle(placed[3]);
    const double scale = uniformScale(instance.worldFromObject) * static_cast<double>(material.pointScale);
    for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (const Vertex& vertex : batch.vertices) {
        const glm::dvec3 corner(placed * glm::dvec4(glm::dvec3(vertex.position), 1.0));
        if (primitive.points)
          each(instance, corner, corner, scale * static_cast<double>(vertex.uv[1].x));
        else if (material.billboard)
          each(instance, corner, middle, glm::length(corner - middle));
        else
          each(instance, corner, corner, 0.0);
      }
    }
  }
}

// The corners alone, each(instance, corner), of particles their middles.
template <class Wanted, class Each>
void forEachCorner(const Scene& scene, const glm::dmat4& space, const Wanted& wanted, const Each& each) {
  forEachReach(
      scene, space, wanted,
      [&](const Instance& instance, const glm::dvec3& corner, const glm::dvec3&, double) { each(instance, corner); });
}

}  // namespace pellucid
