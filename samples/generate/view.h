// Where a sample is looked at from: one camera for the EXR's attributes and for the glTF node.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/camera.h"

namespace pellucid::samples {

struct View {
  glm::dvec3 eye{0.0, 0.0, 5.0}, target{0.0};  // world, metres, y up
  double yfov = 0.6;                           // radians
  double nearest = 0.1, farthest = 100.0;      // metres: what weights are spread over
  int width = 640, height = 360;

  Window window() const { return {0, 0, width, height}; }
  double aspect() const { return static_cast<double>(width) / height; }
  Camera camera() const;
};

}  // namespace pellucid::samples
