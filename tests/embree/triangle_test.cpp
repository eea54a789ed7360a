// Rays and triangles: every edge belongs to one triangle.
#include "engine_bridge/embree/triangle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"

namespace pellucid::rays {
namespace {

int hitsOf(const std::vector<Corners>& mesh, const Ray& ray, bool orthographic) {
  int hits = 0;
  for (const Corners& corners : mesh) hits += intersectHalfOpen(ray, corners, orthographic).has_value() ? 1 : 0;
  return hits;
}

// A plane at z = 4 cut into a grid of squares, each into two triangles, corners on whole numbers.
std::vector<Corners> grid(int edge, bool slanted) {
  std::vector<Corners> mesh;
  const auto at = [&](int x, int y) { return glm::dvec3(x, y, slanted ? -4.0 - 0.25 * x + 0.125 * y : -4.0); };
  for (int y = -edge; y < edge; ++y)
    for (int x = -edge; x < edge; ++x) {
      mesh.push_back({{at(x, y), at(x + 1, y), at(x + 1, y + 1)}});
      mesh.push_back({{at(x, y), at(x + 1, y + 1), at(x, y + 1)}});
    }
  return mesh;
}

TEST(HalfOpen, GridCornersAndEdgesAreHitOnce) {
  const std::vector<Corners> mesh = grid(6, false);
  for (const bool orthographic : {false, true})
    for (int y = -16; y <= 16; ++y)
      for (int x = -16; x <= 16; ++x) {
        Ray ray;  // through multiples of a quarter: corners, edges, diagonals and insides
        if (orthographic)
          ray.origin = {0.25 * x, 0.25 * y, 0.0};
        else
          ray.direction = {0.0625 * x, 0.0625 * y, -1.0};
        EXPECT_EQ(hitsOf(mesh, ray, orthographic), 1) << x << ' ' << y << ' ' << orthographic;
      }
}

// The nudge to the right and down is the top-left rule.
TEST(HalfOpen, LeftAndTopEdgesAreInside) {
  const auto square = [](double x, double y) {
    return std::vector<Corners>{{{{x, y, -1}, {x + 1, y, -1}, {x + 1, y + 1, -1}}},
                                {{{x, y, -1}, {x + 1, y + 1, -1}, {x, y + 1, -1}}}};
  };
  const Ray forward;  // meets (0, 0)
  for (const bool orthographic : {false, true}) {
    EXPECT_EQ(hitsOf(square(0, -0.5), forward, orthographic), 1) << "left edge";
    EXPECT_EQ(hitsOf(square(-1, -0.5), forward, orthographic), 0) << "right edge";
    EXPECT_EQ(hitsOf(square(-0.5, -1), forward, orthographic), 1) << "top edge";
    EXPECT_EQ(hitsOf(square(-0.5, 0), forward, orthographic), 0) << "bottom edge";
    EXPECT_EQ(hitsOf(square(0, -1), forward, orthographic), 1) << "top left corner";
    EXPECT_EQ(hitsOf(square(-1, -1), forward, orthographic), 0) << "top right corner";
  }
}

// Rays aimed at points of shared edges, as near as doubles come: rounding puts them on either side, never on both or on
// none.
TEST(HalfOpen, RandomFansAreWatertight) {
  test::Random random(7);
  std::size_t rays = 0;
  for (int fan = 0; fan < 400; ++fan) {
    const glm::dvec3 hub(random.between(-0.1, 0.1), random.between(-0.1, 0.1), -random.between(1, 100));
    const int blades = 5 + static_cast<int>(random.below(9));
    std::vector<glm::dvec3> rim;
    for (int i = 0; i < blades; ++i) {
      const double angle = 2 * M_PI * (i + random.between(-0.3, 0.3)) / blades;
      const double radius = -hub.z * random.between(0.2, 0.4);
      rim.emplace_back(hub.x + radius * std::cos(angle), hub.y + radius * std::sin(angle),
                       hub.z * random.between(0.9, 1.1));
    }
    std::vector<Corners> mesh;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const glm::dvec3 next = rim[(i + 1) % rim.size()];
      // Every order of corners that keeps the side.
      const std::uint32_t turn = random.below(3);
      mesh.push_back(turn == 0   ? Corners{{hub, rim[i], next}}
                     : turn == 1 ? Corners{{rim[i], next, hub}}
                                 : Corners{{next, hub, rim[i]}});
    }
    for (const glm::dvec3& corner : rim)
      for (int step = 0; step < 20; ++step) {
        const glm::dvec3 target = hub + (corner - hub) * (0.9 * random.uniform());
        Ray ray;
        ray.direction = target / -target.z;
        ASSERT_EQ(hitsOf(mesh, ray, false), 1);
        ray.direction = glm::dvec3(0, 0, -1);
        ray.origin = glm::dvec3(target.x, target.y, 0);
        ASSERT_EQ(hitsOf(mesh, ray, true), 1);
        rays += 2;
      }
  }
  std::printf("%zu rays at shared edges, each hit once\n", rays);
}

TEST(HalfOpen, DepthAndWeightsAreThePlanes) {
  const std::vector<Corners> mesh = grid(6, true);
  test::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    Ray ray;
    ray.direction = {random.between(-0.5, 0.5), random.between(-0.5, 0.5), -1.0};
    // z = 4 + x z / 4 - y z / 8
    const double expected = 4.0 / (1.0 - 0.25 * ray.direction.x + 0.125 * ray.direction.y);
    for (const Corners& corners : mesh)
      if (const auto hit = intersectHalfOpen(ray, corners, false)) {
        EXPECT_NEAR(hit->z, expected, 1e-13);
        EXPECT_NEAR(hit->weight[0] + hit->weight[1] + hit->weight[2], 1.0, 1e-14);
        EXPECT_TRUE(hit->front);
      }
  }
}

TEST(HalfOpen, EdgeOnTrianglesAreMissed) {
  const Corners edgeOn{{{0, 0, -1}, {0, 0, -2}, {0, 1, -2}}};
  EXPECT_FALSE(intersectHalfOpen(Ray{}, edgeOn, false).has_value());
  EXPECT_FALSE(intersectPlane(Ray{}, edgeOn).has_value());
}

}  // namespace
}  // namespace pellucid::rays
