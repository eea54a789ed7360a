// The opaque depth between pixel centres against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gbuffer/depth_plane.h"

namespace pellucid {
namespace {

constexpr int kSize = 32;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kPlaces[] = {0.01, 0.25, 0.5, 0.75, 0.99};

// Planar depth at a place of the picture, in pixels from its top left corner.
using Depth = std::function<double(double x, double y)>;

float roundedToHalf(double z) {
  int exponent = 0;
  std::frexp(z, &exponent);
  const double step = std::ldexp(1.0, exponent - 11);
  return static_cast<float>(std::nearbyint(z / step) * step);
}

GBuffer pictureOf(const Depth& depth, bool half = false) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, kSize, kSize};
  gbuffer.viewZ = Image<float>(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double z = depth(x + 0.5, y + 0.5);
      gbuffer.viewZ.at(x, y) = !std::isfinite(z) ? kInfinity : half ? roundedToHalf(z) : static_cast<float>(z);
    }
  gbuffer.depthPrecision = half ? 0x1p-10f : 0x1p-20f;
  return gbuffer;
}

// A camera that sees from -1/2 to 1/2 at distance 1, with its axis through the picture's middle.
Camera camera(bool orthographic = false) {
  Camera camera;
  camera.orthographic = orthographic;
  camera.focal = {2.0, 2.0};
  return camera;
}
glm::dvec2 atOne(double x, double y) {
  return {x / kSize - 0.5, 0.5 - y / kSize};
}

// A wall that stands `distance` away on the axis, turned about an upright axis.
Depth wall(double degrees, double distance) {
  const double t = degrees * M_PI / 180.0;
  return [=](double x, double y) {
    (void)y;
    const double cosine = std::cos(t) - std::sin(t) * atOne(x, y).x;
    return cosine > 0.05 ? distance * std::cos(t) / cosine : static_cast<double>(kInfinity);
  };
}

// Largest relative error at the places of all pixels that `counts`.
double worst(
    const GBuffer& gbuffer, const Camera& camera, const Depth& depth,
    const std::function<bool(int x, int y)>& counts = [](int, int) { return true; }) {
  const DepthPlanes planes(gbuffer, camera);
  Image<float> there(kSize, kSize);
  double largest = 0.0;
  for (const double u : kPlaces)
    for (const double v : kPlaces) {
      planes.depthAt({u, v}, there);
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double z = depth(x + u, y + v);
          if (!counts(x, y) || !std::isfinite(z) || !std::isfinite(gbuffer.viewZ.at(x, y))) continue;
          largest = std::max(largest, std::abs(static_cast<double>(there.at(x, y)) / z - 1.0));
        }
    }
  return largest;
}

TEST(DepthPlanes, PlanesAtAnyTiltWithinThePrecisionOfTheFile) {
  for (const double tilt : {0.0, 1.0, 30.0, -60.0, 80.0})
    for (const double distance : {0.05, 1.0, 5000.0})
      for (const bool half : {false, true}) {
        SCOPED_TRACE(testing::Message() << tilt << " degrees, " << distance << " m, half " << half);
        const GBuffer gbuffer = pictureOf(wall(tilt, distance), half);
        EXPECT_LE(worst(gbuffer, camera(), wall(tilt, distance)), static_cast<double>(gbuffer.depthPrecision));
      }
}

TEST(DepthPlanes, OrthographicDepthIsLinear) {
  const Depth slope = [](double x, double y) { return 3.0 + 0.1 * x - 0.05 * y; };
  EXPECT_LE(worst(pictureOf(slope), camera(true), slope), 0x1p-20);
}

TEST(DepthPlanes, CentresKeepTheirBits) {
  const GBuffer gbuffer = pictureOf(wall(60.0, 7.0), true);
  Image<float> there(kSize, kSize);
  DepthPlanes(gbuffer, camera()).depthAt({0.5, 0.5}, there);
  for (std::size_t i = 0; i < there.size(); ++i) EXPECT_EQ(there[i], gbuffer.viewZ[i]);
}

// Both sides of the line where a tilted floor meets a wall, and where a post hides it, keep the planes they lie on.
TEST(DepthPlanes, SurfacesThatMeetKeepTheirOwn) {
  const Depth floor = [](double x, double y) { return 1.0 / (0.02 * y + 0.001 * x); };
  for (const double back : {2.5, 3.7})
    for (const double post : {0.0, 0.8}) {
      const auto owner = [&](double x, double y) {
        return post > 0.0 && x > 9 && x < 14 ? 2 : floor(x, y) < back ? 1 : 0;
      };
      const GBuffer gbuffer = pictureOf([&](double x, double y) {
        return owner(x, y) == 2 ? post : owner(x, y) == 1 ? floor(x, y) : back;
      });
      const DepthPlanes planes(gbuffer, camera());
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double own[] = {back, floor(x + 0.9, y + 0.1), post};
          const double expected = own[owner(x + 0.5, y + 0.5)];
          // Of a row of two pixels that all but touches the wall, the third one may be taken for a bend of theirs.
          EXPECT_NEAR(planes.at(x, y).z(0.4, -0.4), expected, 5e-4 * expected) << x << ", " << y;
        }
    }
}

TEST(DepthPlanes, NarrowThingsByTheirNeighbourOrTheirNormal) {
  const double t = M_PI / 3.0;
  const Depth strip = wall(60.0, 2.0);
  for (const int width : {1, 2}) {
    const auto inside = [&](int x, int) { return x >= 12 && x < 12 + width; };
    GBuffer gbuffer = pictureOf([&](double x, double y) { return inside(static_cast<int>(x), 0) ? strip(x, y) : 9.0; });
    if (width == 2) {
      EXPECT_LE(worst(gbuffer, camera(), strip, inside), 1e-5);
    }
    const Depth flat = [&](double, double y) { return strip(12.5, y); };
    if (width == 1) {
      EXPECT_LE(worst(gbuffer, camera(), flat, inside), 1e-6) << "nothing tells its slope";
    }
    gbuffer.normal = Image<glm::vec3>(kSize, kSize, glm::vec3(std::sin(t), 0.0, std::cos(t)));
    EXPECT_LE(worst(gbuffer, camera(), strip, inside), 1e-5) << "the normal does";
  }
}

TEST(DepthPlanes, CurvedSurfacesFarBetterThanByTheirCentres) {
  // A ball of radius 1, 4 m away.
  const Depth ball = [](double x, double y) {
    const glm::dvec2 at = atOne(x, y) * 0.6;
    const double a = 1.0 + glm::dot(at, at), d = 16.0 - a * 15.0;
    return d > 0.0 ? (4.0 - std::sqrt(d)) / a : static_cast<double>(kInfinity);
  };
  Camera narrow = camera();
  narrow.focal = {2.0 / 0.6, 2.0 / 0.6};
  const auto middle = [](int x, int y) { return std::hypot(x - 15.5, y - 15.5) < 10.0; };
  GBuffer gbuffer = pictureOf(ball);
  double flat = 0.0;
  for (int y = 1; y < kSize - 1; ++y)
    for (int x = 1; x < kSize - 1; ++x)
      if (middle(x, y))
        flat = std::max(flat, std::abs(static_cast<double>(gbuffer.viewZ.at(x, y)) / ball(x + 1.0, y + 1.0) - 1.0));
  EXPECT_LE(worst(gbuffer, narrow, ball, middle), 0.1 * flat);
}

}  // namespace
}  // namespace pellucid
