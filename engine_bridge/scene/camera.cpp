#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// A camera and a picture whose shapes differ by less than half a pixel of a thousand have the same: exporters round.
constexpr double kSameShape = 5e-4;

}  // namespace

Camera cameraOf(const SceneCamera& source, const Window& display, double pixelAspect) {
  if (display.width() <= 0 || display.height() <= 0 || !(pixelAspect > 0.0) || !std::isfinite(pixelAspect)) {
    throw MeaningError(
        fmt::format("glTF camera {}: found a picture of {}x{} with pixel aspect {:g}; expected positive sizes",
                    source.name, display.width(), display.height(), pixelAspect));
  }
  Camera camera;
  camera.viewFromWorld = source.viewFromWorld;
  camera.orthographic = source.orthographic;
  // Whole fields within the picture, equally many pixels a unit both ways (glTF 2.0, Projection Matrices).
  const double aspect = pixelAspect * static_cast<double>(display.width()) / static_cast<double>(display.height());
  const double own = source.orthographic ? source.xmag / source.ymag : source.aspect;
  const bool known = own > 0.0, same = known && std::abs(own / aspect - 1.0) <= kSameShape;
  const bool byWidth = known && !same && own > aspect;
  if (source.orthographic) {
    camera.focal = glm::dvec2(1.0 / source.xmag, 1.0 / source.ymag);
    if (byWidth) camera.focal.y = aspect * camera.focal.x;
    if (!same && !byWidth) camera.focal.x = camera.focal.y / aspect;
  } else {
    camera.focal.y = 1.0 / std::tan(0.5 * source.yfov);
    if (byWidth) camera.focal.y *= aspect / own;
    camera.focal.x = camera.focal.y / aspect;
  }
  camera.origin = "glTF node " + source.name;
  if (known && !same)
    camera.origin += fmt::format(", of aspect {:.6g}, fitted to the {} of the picture of aspect {:.6g}", own,
                                 byWidth ? "width" : "height", aspect);
  camera.rangeNear = source.znear;
  camera.rangeFar = source.zfar;
  return camera;
}

}  // namespace pellucid
