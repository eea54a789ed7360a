// Where a ray meets the studio's shapes.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "samples/generate/studio.h"

namespace pellucid::samples {

struct Ray {
  glm::dvec3 origin, direction;  // world; the direction is unit
};

struct Hit {
  double distance = 0.0;   // along the ray, metres, > 0
  glm::dvec3 normal{0.0};  // world, unit, outwards
  const Shape* shape = nullptr;
};

std::optional<Hit> nearestHit(const std::vector<Shape>& shapes, const Ray& ray);
bool anyHit(const std::vector<Shape>& shapes, const Ray& ray, double reach);  // reach in metres

}  // namespace pellucid::samples
