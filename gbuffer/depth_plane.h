// The depth of a pixel and how it changes across it.
#pragma once
#include <cmath>
#include <limits>

#include "gbuffer/image.h"

namespace pellucid {

// 1/z is linear on a plane; of the two neighbours the one that changes less lies on the same surface.
struct DepthPlane {
  double inverse = 0, across = 0, down = 0;
  // At an offset from the pixel's centre, in pixels; not positive where the plane has left the picture.
  double z(double x, double y) const { return 1.0 / (inverse + across * x + down * y); }
};

inline double inverseDepthSlope(const Image<float>& viewZ, int x, int y, int dx, int dy) {
  const double here = 1.0 / static_cast<double>(viewZ.at(x, y));
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const int side : {-1, 1}) {
    const int u = x + side * dx, v = y + side * dy;
    if (u < 0 || v < 0 || u >= viewZ.width() || v >= viewZ.height() || !std::isfinite(viewZ.at(u, v))) continue;
    const double change = side * (1.0 / static_cast<double>(viewZ.at(u, v)) - here);
    if (std::abs(change) < least) {
      least = std::abs(change);
      best = change;
    }
  }
  return best;
}

// Of a pixel whose depth is finite.
inline DepthPlane depthPlaneAt(const Image<float>& viewZ, int x, int y) {
  return {1.0 / static_cast<double>(viewZ.at(x, y)), inverseDepthSlope(viewZ, x, y, 1, 0),
          inverseDepthSlope(viewZ, x, y, 0, 1)};
}

}  // namespace pellucid
