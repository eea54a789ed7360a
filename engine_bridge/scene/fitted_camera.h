// A camera that shows the whole of a scene, for scenes and pictures that have none.
#pragma once
#include "engine_bridge/scene/scene.h"

namespace pellucid {

// From where the scene is seen.
struct FittedCamera {
  double azimuth = 30.0;    // degrees about the y axis: 0 from +z, 90 from +x
  double elevation = 20.0;  // degrees above the horizon, -90 to 90
};

// As near as it can be with every vertex in the picture, up to a margin; vertical field of view kFittedView. Throws
// MeaningError for a scene without a triangle.
Camera fittedCamera(const FittedCamera& wanted, const Scene& scene, const Window& display, double pixelAspect);
constexpr double kFittedView = 40.0;  // degrees
constexpr double kFittedGap = 0.05;   // of the scene's depth, that the eye keeps away from the nearest vertex

}  // namespace pellucid
