#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/errors.h"

namespace pellucid {

Camera cameraOf(const SceneCamera& source, const Window& display, double pixelAspect) {
  if (display.width() <= 0 || display.height() <= 0 || !(pixelAspect > 0.0) || !std::isfinite(pixelAspect)) {
    throw MeaningError(
        fmt::format("glTF camera {}: found a picture of {}x{} with pixel aspect {:g}; expected positive sizes",
                    source.name, display.width(), display.height(), pixelAspect));
  }
  Camera camera;
  camera.viewFromWorld = source.viewFromWorld;
  camera.orthographic = source.orthographic;
  if (source.orthographic) {
    camera.focal = glm::dvec2(1.0 / source.xmag, 1.0 / source.ymag);
  } else {
    // The picture's shape, not the camera's aspectRatio: glTF 2.0, Projection Matrices.
    const double aspect = pixelAspect * static_cast<double>(display.width()) / static_cast<double>(display.height());
    camera.focal.y = 1.0 / std::tan(0.5 * source.yfov);
    camera.focal.x = camera.focal.y / aspect;
  }
  camera.rangeNear = source.znear;
  camera.rangeFar = source.zfar;
  camera.origin = "glTF node " + source.name;
  return camera;
}

}  // namespace pellucid
