#include "engine_bridge/scene/fitted_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/corners.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMargin = 0.06;  // of half the picture, on each side

struct Axes {
  glm::dvec3 right, up, forward;
};

Axes axesOf(const FittedCamera& wanted) {
  const double azimuth = glm::radians(wanted.azimuth), elevation = glm::radians(wanted.elevation);
  Axes axes;
  axes.forward = -glm::dvec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                             std::cos(azimuth) * std::cos(elevation));
  axes.right = {std::cos(azimuth), 0.0, -std::sin(azimuth)};
  axes.up = glm::cross(axes.right, axes.forward);
  return axes;
}

// Where an eye may stand along one direction of the picture: a point at `across` and `along` is inside when
// |across - eye| <= slope * (along - eye's own along). Both extremes are those of lines with that slope.
struct Side {
  double slope;
  double least = -kInfinity, most = -kInfinity;  // of across - slope * along, and of -across - slope * along
  void add(double across, double along) {
    least = std::max(least, across - slope * along);
    most = std::max(most, -across - slope * along);
  }
  double farthestEye() const { return -(least + most) / (2.0 * slope); }  // along
  double eye() const { return 0.5 * (least - most); }                     // across: the slack is shared
};

}  // namespace

Camera fittedCamera(const FittedCamera& wanted, const Scene& scene, const Window& display, double pixelAspect) {
  const Axes axes = axesOf(wanted);
  const double slope = std::tan(glm::radians(0.5 * kFittedView)) * (1.0 - kMargin);
  const double aspect = pixelAspect * static_cast<double>(display.width()) / static_cast<double>(display.height());
  Side across{slope * aspect}, upwards{slope};
  double nearest = kInfinity, farthest = -kInfinity;
  forEachCorner(
      scene, glm::dmat4(1.0), [](const Material&) { return true; },
      [&](const Instance&, const glm::dvec3& world) {
        const double along = glm::dot(world, axes.forward);
        across.add(glm::dot(world, axes.right), along);
        upwards.add(glm::dot(world, axes.up), along);
        nearest = std::min(nearest, along);
        farthest = std::max(farthest, along);
      });
  if (!std::isfinite(nearest) || !std::isfinite(farthest))
    throw MeaningError("--camera fit: found no triangle in the scene, expected something to frame");
  // What is long and narrow lies inside the cone of its nearest vertex: the eye keeps away from that, by a millimetre
  // at least.
  const double gap = std::max(1e-3, kFittedGap * (farthest - nearest));
  const double along = std::min({across.farthestEye(), upwards.farthestEye(), nearest - gap});
  const glm::dvec3 eye = across.eye() * axes.right + upwards.eye() * axes.up + along * axes.forward;
  SceneCamera camera;
  glm::dmat4 worldFromView(glm::dvec4(axes.right, 0.0), glm::dvec4(axes.up, 0.0), glm::dvec4(-axes.forward, 0.0),
                           glm::dvec4(eye, 1.0));
  camera.viewFromWorld = glm::inverse(worldFromView);
  camera.yfov = glm::radians(kFittedView);
  Camera result = cameraOf(camera, display, pixelAspect);
  result.origin = fmt::format("--camera fit:{:g},{:g}, which frames the scene from {:.4g},{:.4g},{:.4g}",
                              wanted.azimuth, wanted.elevation, eye.x, eye.y, eye.z);
  return result;
}

}  // namespace pellucid
