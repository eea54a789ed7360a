// Triangles of a sample's transparent part.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pellucid::samples {

// One glTF primitive: object space, metres, y up, counter-clockwise fronts. uv and colours are empty or one per vertex.
struct Mesh {
  std::vector<glm::vec3> positions, normals;  // normals are unit
  std::vector<glm::vec2> uvs;                 // (0,0) is the texture's top left
  std::vector<glm::vec4> colours;             // linear, multiplies the base colour
  std::vector<std::uint32_t> indices;
};

// Adds a parallelogram with uvs: corner is its bottom left as seen from the front, right x up points to the viewer.
void addQuad(Mesh& mesh, glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up);

// A surface of revolution about +y through a smooth curve. Points are (radius, height) in metres, from the bottom up,
// with radius >= 0; the curve is a uniform Catmull-Rom spline, cut into `steps` per span.
Mesh lathe(const std::vector<glm::dvec2>& profile, int steps, int segments);

}  // namespace pellucid::samples
