#include "samples/generate/view.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace pellucid::samples {

Camera View::camera() const {
  Camera camera;
  camera.viewFromWorld = glm::lookAt(eye, target, glm::dvec3(0.0, 1.0, 0.0));
  const double focal = 1.0 / std::tan(0.5 * yfov);
  camera.focal = {focal / aspect(), focal};
  camera.rangeNear = nearest;
  camera.rangeFar = farthest;
  camera.origin = "the sample's view";
  return camera;
}

}  // namespace pellucid::samples
