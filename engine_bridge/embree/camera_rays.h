// Rays through pixels, in view space and double precision.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/camera.h"

namespace pellucid::rays {

// origin + z * direction has the planar depth z: direction.z is -1.
struct Ray {
  glm::dvec3 origin{0.0}, direction{0, 0, -1};
};

class CameraRays {
 public:
  CameraRays(const Camera& camera, const Window& display)
      : camera_(camera), corner_(display.x0, display.y0), size_(display.width(), display.height()) {}

  bool orthographic() const { return camera_.orthographic; }

  //   pixel  display window coordinates, (x + 0.5, y + 0.5) at a pixel's centre, y down
  Ray through(glm::dvec2 pixel) const {
    const glm::dvec2 across = (pixel - corner_) / size_;
    const glm::dvec2 ndc(2.0 * across.x - 1.0, 1.0 - 2.0 * across.y);
    const glm::dvec2 atOne = (ndc - camera_.centre) / camera_.focal;
    Ray ray;
    if (camera_.orthographic)
      ray.origin = glm::dvec3(atOne, 0.0);
    else
      ray.direction = glm::dvec3(atOne, -1.0);
    return ray;
  }

 private:
  Camera camera_;
  glm::dvec2 corner_, size_;
};

}  // namespace pellucid::rays
