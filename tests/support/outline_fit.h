// Where the straight outline of an object lies in a picture, to about a hundredth of a pixel, told from the colours
// that a known pixel filter mixed along it.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid::test {

// Density of a separable filter along one axis, 0 beyond `radius` pixels.
struct FilterProfile {
  double radius = 0.5;
  std::function<double(double)> density;
};

struct MeasuredCorner {
  glm::dvec2 expected{0.0};  // pixels, y down, (0.5, 0.5) at the centre of the first
  glm::dvec2 apart{0.0};     // how far the picture's corner lies from it
  double uncertainty = 0.0;  // standard error of `apart`
};

struct MeasuredOutline {
  std::vector<MeasuredCorner> corners;  // where both edges could be measured
  int edges = 0;                        // that could be measured
  double worstEdge = 0.0;               // largest distance of an end of such an edge from where it is expected
};

// The convex hull, in order.
std::vector<glm::dvec2> hullOf(std::vector<glm::dvec2> points);

// An edge is measured where the colours on either side of it are even: there each pixel's colour says which part of
// the filter lies inside, and a line is fitted to all of them by least squares. Places where anything else shows are
// left out; an edge with too few others, or whose fit leaves more than the noise of the picture, is not measured.
//   outline  convex, where it is expected: what it is measured against, and from where the fit starts
MeasuredOutline measureOutline(const Image<glm::vec4>& picture, const std::vector<glm::dvec2>& outline,
                               const FilterProfile& filter);

}  // namespace pellucid::test
