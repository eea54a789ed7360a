// What machine parts are made of: prisms, rings, tubes and springs, to be turned and put in place.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "samples/generate/mesh.h"

namespace pellucid::samples {

// Adds a part, turned and moved by a rigid transform.
void add(Mesh& mesh, const Mesh& part, const glm::dmat4& place = glm::dmat4(1.0));

glm::dmat4 moved(glm::dvec3 by);
glm::dmat4 alongX();  // what stands along y lies along x
glm::dmat4 alongZ();
glm::dmat4 turnedX(double angle);  // radians about +x

Mesh boxOf(glm::dvec3 half);
// A polygon in the xz plane, counter-clockwise as seen from +y, from y = -half to y = half.
Mesh prism(const std::vector<glm::dvec2>& outline, double half);
Mesh cylinderOf(double radius, double half);
Mesh ring(double inner, double outer, double half);  // about y
Mesh gear(int teeth, double inner, double outer, double half);
Mesh tube(const std::vector<glm::dvec3>& path, double radius);  // round, open at its ends
Mesh spring(double radius, double wire, double height, int turns);
// A quarter bend and more: the curve through these points.
std::vector<glm::dvec3> curve(const std::vector<glm::dvec3>& points, int steps);

}  // namespace pellucid::samples
