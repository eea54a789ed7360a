// glTF POINTS as particles: balls of smoke or sparks, each one triangle around its disc that the vertex stage turns to
// the camera.
#pragma once
#include <memory>
#include <string>

#include "engine_bridge/scene/accessor.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::gltf {

constexpr float kPointRadius = 0.05f;  // object space, where the file has no _RADIUS

struct FilePoints {
  std::string place;                                          // for messages
  std::shared_ptr<const Elements> positions, radii, colours;  // radii and colours may be null
  std::shared_ptr<const Indices> indices;                     // null: in order
  std::size_t count() const { return indices ? indices->count : positions->count; }
};

struct PointFaults {
  std::size_t nonFinite = 0, noRadius = 0, repairedColours = 0;
};

// Triangle i is particle i; of its vertices the position is the middle, uv[0] the corner about the unit disc, uv[1].x
// the radius. A particle without a place or a radius keeps its number and has radius 0.
std::shared_ptr<const TriangleSource> particlesOf(FilePoints points, PointFaults& faults);

}  // namespace pellucid::gltf
