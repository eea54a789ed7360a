// Depth of every convention back to the distance that it came from.
#include <gtest/gtest.h>

#include <cmath>

#include "shaders/device_depth.h"

namespace pellucid::test {
namespace {

struct Convention {
  const char* name;
  bool zeroToOne, reversed, infinite, orthographic;
};

// Window depth of planar distance z, and the projection that gives it, in double.
struct Projection {
  double a, b, c, d;
  Projection(const Convention& convention, double zNear, double zFar) {
    const double lo = convention.zeroToOne ? 0.0 : -1.0;
    const double atNear = convention.reversed ? 1.0 : lo, atFar = convention.reversed ? lo : 1.0;
    if (convention.orthographic) {
      // ndc = a v + b, v = -z
      a = (atNear - atFar) / (zFar - zNear);
      b = atNear + a * zNear;
      c = 0, d = 1;
    } else {
      // ndc = (a v + b) / -v; at infinity it is -a.
      b = convention.infinite ? (atNear - atFar) * zNear : (atNear - atFar) * zNear * zFar / (zFar - zNear);
      a = convention.infinite ? -atFar : b / zFar - atFar;
      c = -1, d = 0;
    }
  }
  double ndc(double z) const { return (a * -z + b) / (c * -z + d); }
};

TEST(DeviceDepth, EveryConventionComesBack) {
  constexpr double zNear = 0.1, zFar = 500.0;
  const Convention conventions[] = {{"-1..1", false, false, false, false},
                                    {"0..1", true, false, false, false},
                                    {"0..1 reversed", true, true, false, false},
                                    {"0..1 infinite", true, false, true, false},
                                    {"0..1 reversed infinite", true, true, true, false},
                                    {"-1..1 orthographic", false, false, false, true},
                                    {"0..1 orthographic", true, false, false, true},
                                    {"0..1 reversed orthographic", true, true, false, true}};
  for (const Convention& convention : conventions) {
    const Projection projection(convention, zNear, zFar);
    const float scale = convention.zeroToOne ? 1.0f : 2.0f, offset = convention.zeroToOne ? 0.0f : -1.0f;
    const float empty = convention.reversed ? 0.0f : 1.0f;
    shading::DepthRows rows;
    rows.a = static_cast<float>(projection.a), rows.b = static_cast<float>(projection.b);
    rows.c = static_cast<float>(projection.c), rows.d = static_cast<float>(projection.d);
    double worst = 0;
    for (double z = 0.11; z < 400; z *= 1.13) {
      const double window = (projection.ndc(z) - static_cast<double>(offset)) / static_cast<double>(scale);
      ASSERT_GE(window, 0.0) << convention.name;
      ASSERT_LE(window, 1.0) << convention.name;
      const double found =
          static_cast<double>(shading::planarFromDevice(rows, static_cast<float>(window), scale, offset, empty));
      // A float depth knows 2^-24 of its range, and two or three roundings follow; the slope turns that into metres.
      const double step = 3e-7;
      const double slope = std::abs(projection.ndc(z * 1.0001) - projection.ndc(z)) / (z * 1e-4);
      const double allowed =
          convention.reversed && !convention.orthographic && convention.infinite ? 3e-7 * z : step / slope + 3e-7 * z;
      worst = std::max(worst, std::abs(found - z) / allowed);
    }
    std::printf("%s: %.2f of the allowed error\n", convention.name, worst);
    EXPECT_LT(worst, 1.0) << convention.name;
    EXPECT_TRUE(std::isinf(shading::planarFromDevice(rows, empty, scale, offset, empty))) << convention.name;
  }
}

}  // namespace
}  // namespace pellucid::test
