// Occlusion from depth alone against closed forms.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include <tbb/global_control.h>

#include "composite/screen_occlusion.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr float kNoDepth = std::numeric_limits<float>::infinity();

struct Shot {
  Window window{0, 0, 192, 128};
  Camera camera;
  Shot() { camera.focal = {2.0 * 128 / 192, 2.0}; }
  // Depth where the pixel's ray meets n . p = d in view space.
  float plane(int x, int y, glm::dvec3 n, double d) const {
    const double nx = (2.0 * (x + 0.5) / window.width() - 1.0) / camera.focal.x,
                 ny = (1.0 - 2.0 * (y + 0.5) / window.height()) / camera.focal.y;
    const double z = d / (n.x * nx + n.y * ny - n.z);
    return z > 0.0 ? static_cast<float>(z) : kNoDepth;
  }
};

TEST(ScreenOcclusion, APlaneIsOpen) {
  const Shot shot;
  for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.4, 0.3, 1), glm::dvec3(0, 1.2, 0.3)}) {
    Image<float> z(192, 128);
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 192; ++x) z.at(x, y) = shot.plane(x, y, normal, -5.0 * normal.z - 0.5 * normal.y);
    const Image<float> open = screenOcclusion(z, shot.camera, shot.window, shot.window, {});
    float least = 1.0f;
    for (int y = 8; y < 120; ++y)
      for (int x = 8; x < 184; ++x)
        if (std::isfinite(z.at(x, y))) least = std::min(least, open.at(x, y));
    printf("[ figure ] plane (%.1f, %.1f, %.1f): least open %.4f\n", normal.x, normal.y, normal.z,
           static_cast<double>(least));
    // Float depth bends a plane by its last bits.
    EXPECT_GE(least, 0.99f);
  }
}

// Two planes that meet at right angles, seen along their bisector: at the corner each hides half of the other's
// hemisphere, and nothing beyond the radius.
TEST(ScreenOcclusion, ACornerIsHalfOpen) {
  const Shot shot;
  Image<float> z(192, 128);
  const double d = -6.0 * std::sqrt(0.5);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 192; ++x)
      z.at(x, y) = std::min(shot.plane(x, y, {0, std::sqrt(0.5), std::sqrt(0.5)}, d),
                            shot.plane(x, y, {0, -std::sqrt(0.5), std::sqrt(0.5)}, d));
  ScreenOcclusionSettings settings;
  settings.radius = 2.5;  // 53 pixels
  const Image<float> open = screenOcclusion(z, shot.camera, shot.window, shot.window, settings);
  const auto at = [&](int y) { return static_cast<double>(open.at(96, y)); };
  printf("[ figure ] corner: %.3f %.3f | %.3f %.3f; far from it %.3f\n", at(62), at(63), at(64), at(65), at(4));
  // Half at the corner itself; the filter mixes in the two rows beside it, which are half a row to two and a half away.
  EXPECT_NEAR(at(63), 0.5, 0.12);
  EXPECT_NEAR(at(64), 0.5, 0.12);
  EXPECT_LT(at(64), at(70));
  EXPECT_LT(at(70), at(90));
  EXPECT_GE(at(4), 0.98);
}

Image<float> clutter(double scale) {
  test::Random random(3);
  Image<float> z(192, 128, kNoDepth);
  for (int i = 0; i < 60; ++i) {
    const int x0 = static_cast<int>(random.below(170)), y0 = static_cast<int>(random.below(110));
    const float depth = static_cast<float>(scale * random.between(3.0, 4.0));
    for (int y = y0; y < std::min(y0 + 25, 128); ++y)
      for (int x = x0; x < std::min(x0 + 25, 192); ++x) z.at(x, y) = std::min(z.at(x, y), depth);
  }
  return z;
}

TEST(ScreenOcclusion, StaysInRangeAndLeavesTheSkyOpen) {
  const Shot shot;
  Image<float> z = clutter(1.0);
  z.at(5, 5) = 1e-6f, z.at(6, 6) = 1e9f;
  const Image<float> open = screenOcclusion(z, shot.camera, shot.window, shot.window, {});
  double sum = 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    ASSERT_GE(open[i], 0.0f);
    ASSERT_LE(open[i], 1.0f);
    if (!std::isfinite(z[i])) {
      EXPECT_EQ(open[i], 1.0f);
    }
    sum += 1.0 - static_cast<double>(open[i]);
  }
  EXPECT_GT(sum / static_cast<double>(open.size()), 0.01);
}

TEST(ScreenOcclusion, ScaleChangesNothing) {
  const Shot shot;
  const Image<float> one = screenOcclusion(clutter(1.0), shot.camera, shot.window, shot.window, {});
  for (const double scale : {0.01, 100.0}) {
    const Image<float> other = screenOcclusion(clutter(scale), shot.camera, shot.window, shot.window, {});
    float most = 0;
    for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one[i] - other[i]));
    printf("[ figure ] scene times %g: largest difference %.2g\n", scale, static_cast<double>(most));
    EXPECT_LE(most, 1e-3f);
  }
}

TEST(ScreenOcclusion, WantedPixelsAndThreadsGiveTheSameBits) {
  const Shot shot;
  const Image<float> z = clutter(1.0);
  const Image<float> all = screenOcclusion(z, shot.camera, shot.window, shot.window, {});
  Image<std::uint8_t> wanted(192, 128);
  test::Random random(9);
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = random.below(7) == 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Image<float> some = screenOcclusion(z, shot.camera, shot.window, shot.window, {}, &wanted);
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(some[i], wanted[i] ? all[i] : 1.0f);
}

// Posts two pixels wide on either side of a wall, seen edge-on: few taps per pixel would mostly step over them.
TEST(ScreenOcclusion, ThingsSeenEdgeOnAreNotSteppedOver) {
  const Shot shot;
  Image<float> z(192, 128, 4.0f);
  for (int y = 0; y < 128; ++y)
    for (const int x : {65, 66, 125, 126}) z.at(x, y) = 3.0f;
  ScreenOcclusionSettings settings;
  settings.radius = 4.0;
  const Image<float> open = screenOcclusion(z, shot.camera, shot.window, shot.window, settings);
  double sum = 0.0, least = 1.0, most = 0.0;
  int count = 0;
  for (int y = 40; y < 88; ++y)
    for (int x = 80; x < 112; ++x) {
      const auto value = static_cast<double>(open.at(x, y));
      sum += value, ++count;
      least = std::min(least, value), most = std::max(most, value);
    }
  // Long walls that stand out a metre leave, on either side, half the sine of the angle from the normal to their edge.
  const auto half = [](double metres) { return 0.5 * metres / std::hypot(metres, 1.0); };
  const double edge = 29.5 * 3.0 / 128.0;
  double closed = 0.0;
  for (int x = 80; x < 112; ++x) {
    const double at = (x + 0.5 - 96.0) * 4.0 / 128.0;
    closed += (half(edge + at) + half(edge - at)) / 32.0;
  }
  printf("[ figure ] between posts: open %.3f (%.3f to %.3f); walls in their place %.3f\n", sum / count, least, most,
         closed);
  // Taps see blocks half as wide as their steps, and posts that thin are in half of them; wider ones are in all.
  EXPECT_LE(sum / count, 1.0 - 0.3 * (1.0 - closed));
  EXPECT_GE(sum / count, closed);
}

TEST(ScreenOcclusion, OrthographicPlanesAreOpen) {
  Shot shot;
  shot.camera.orthographic = true;
  shot.camera.focal = {0.5, 0.75};
  Image<float> z(192, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 192; ++x) z.at(x, y) = 4.0f + 0.005f * static_cast<float>(x);
  ScreenOcclusionSettings settings;
  settings.radius = 0.5;
  const Image<float> open = screenOcclusion(z, shot.camera, shot.window, shot.window, settings);
  for (int y = 4; y < 124; ++y)
    for (int x = 4; x < 188; ++x) ASSERT_GE(open.at(x, y), 0.99f);
}

}  // namespace
}  // namespace pellucid
