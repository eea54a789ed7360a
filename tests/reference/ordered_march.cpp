#include "tests/reference/ordered_march.h"

#include <cmath>

namespace pellucid::reference {

double phase(double cosine, double g) {
  return (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

Marched orderedMarch(const Air& air, const std::vector<Lamp>& lamps, const Vec& eye, const Vec& way, double length,
                     int steps) {
  Marched sum;
  double opticalDepth = 0;
  const double step = length / steps;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) * step;
    Vec point{};
    for (std::size_t c = 0; c < 3; ++c) point[c] = eye[c] + s * way[c];
    const double extinction = air.extinction(point);
    Vec arriving = air.ambient;
    for (const Lamp& lamp : lamps) {
      Vec towards = lamp.place;
      double distance = 1;
      if (!lamp.sun) {
        for (std::size_t c = 0; c < 3; ++c) towards[c] -= point[c];
        distance = std::sqrt(towards[0] * towards[0] + towards[1] * towards[1] + towards[2] * towards[2]);
        for (double& each : towards) each /= distance;
      }
      const double cosine = towards[0] * way[0] + towards[1] * way[1] + towards[2] * way[2];
      const double part = phase(cosine, air.g) * lamp.visible(point) / (distance * distance);
      for (std::size_t c = 0; c < 3; ++c) arriving[c] += part * lamp.intensity[c];
    }
    const double before = std::exp(-opticalDepth), hides = -std::expm1(-extinction * step);
    for (std::size_t c = 0; c < 3; ++c) sum.radiance[c] += before * hides * air.albedo[c] * arriving[c];
    if (air.emission) {
      // Even over the step: the mean of what the step itself leaves of it.
      const double depth = extinction * step, left = depth > 0 ? hides / depth : 1.0;
      const Vec emitted = air.emission(point);
      for (std::size_t c = 0; c < 3; ++c) sum.radiance[c] += before * left * step * emitted[c];
    }
    opticalDepth += extinction * step;
  }
  sum.transmittance = std::exp(-opticalDepth);
  return sum;
}

}  // namespace pellucid::reference
