// --camera fit: the whole scene is in the picture, as near as the margin lets it be.
#include <gtest/gtest.h>

#include <random>

#include "engine_bridge/scene/fitted_camera.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

Scene cloud(const std::vector<glm::vec3>& points, const glm::dmat4& worldFromObject = glm::dmat4(1.0)) {
  Scene scene;
  scene.materials.emplace_back();
  Primitive primitive;
  for (const glm::vec3& point : points) {
    Vertex vertex{};
    vertex.position = point;
    primitive.vertices.push_back(vertex);
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) primitive.indices.push_back(i);
  scene.primitives.push_back(std::move(primitive));
  Instance instance;
  instance.worldFromObject = worldFromObject;
  scene.instances.push_back(instance);
  return scene;
}

// Largest |x| and |y| in NDC of the display window over all points, which all lie before the camera.
//   nearest, farthest  planar depth of the points
glm::dvec2 reach(const Scene& scene, const Camera& camera, const Window& display, double* nearest = nullptr,
                 double* farthest = nullptr) {
  glm::dvec2 most(0.0);
  double least = 1e300, greatest = 0.0;
  for (const Vertex& vertex : scene.primitives[0].vertices) {
    const glm::dvec4 world = scene.instances[0].worldFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0);
    const Projected at = project(camera, display, glm::dvec3(world));
    EXPECT_GT(at.z, 0.0);
    least = std::min(least, at.z);
    greatest = std::max(greatest, at.z);
    const glm::dvec2 size(display.width(), display.height());
    most = glm::max(most, glm::abs(2.0 * at.pixel / size - 1.0));
  }
  if (nearest) *nearest = least;
  if (farthest) *farthest = greatest;
  return most;
}

TEST(FittedCamera, ShowsEveryVertexAndIsNear) {
  std::mt19937 random(22);
  std::uniform_real_distribution<float> place(-3.0f, 5.0f);
  int full = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<glm::vec3> points(3 * (1 + round % 40));
    for (glm::vec3& point : points) point = glm::vec3(place(random), 0.1f * place(random), 7.0f + place(random));
    const double scale = std::pow(10.0, round % 7 - 3);  // millimetres to kilometres
    const Scene scene = cloud(points, glm::dmat4(glm::dmat3(scale)));
    const Window display{0, 0, 64 + 37 * (round % 20), 48 + 51 * (round % 13)};
    const FittedCamera wanted{-180.0 + 7.0 * round, -90.0 + 0.9 * round};
    const Camera camera = fittedCamera(wanted, scene, display, 1.0);
    double nearest = 0.0, farthest = 0.0;
    const glm::dvec2 most = reach(scene, camera, display, &nearest, &farthest);
    // The margin is 0.06 on both sides of the axis that is full; 1e-6 is what doubles lose over 1e4 steps of scale.
    EXPECT_LE(std::max(most.x, most.y), 0.94 + 1e-6) << round;
    const bool keepsAway = nearest <= std::max(1e-3, kFittedGap * (farthest - nearest)) * (1.0 + 1e-6);
    if (keepsAway) continue;
    EXPECT_NEAR(std::max(most.x, most.y), 0.94, 1e-6) << round;
    ++full;
  }
  EXPECT_GT(full, 150) << "the others are narrower than the cone of their nearest vertex";
}

TEST(FittedCamera, StandsWhereItsAnglesSay) {
  const Scene scene = cloud({{-1, -1, -1}, {1, 1, 1}, {1, -1, 1}});
  const Window display{0, 0, 100, 100};
  const auto eyeOf = [&](double azimuth, double elevation) {
    const Camera camera = fittedCamera({azimuth, elevation}, scene, display, 1.0);
    return glm::dvec3(glm::inverse(camera.viewFromWorld)[3]);
  };
  // Corners of a cube of 2 m: an eye with 40 degrees stands farther than 2.5 m from its middle.
  EXPECT_GT(eyeOf(0, 0).z, 2.5);
  EXPECT_GT(eyeOf(90, 0).x, 2.5);
  EXPECT_LT(eyeOf(180, 0).z, -2.5);
  EXPECT_GT(eyeOf(0, 90).y, 2.5);
  EXPECT_LT(eyeOf(0, -90).y, -2.5);
  EXPECT_NEAR(glm::determinant(fittedCamera({33, 44}, scene, display, 1.0).viewFromWorld), 1.0, 1e-12);
}

TEST(FittedCamera, PointsAndPlanesStillLieBeforeIt) {
  const Window display{0, 0, 160, 90};
  for (const std::vector<glm::vec3>& points :
       {std::vector<glm::vec3>(3, glm::vec3(2, 3, 4)), {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {
    const Scene scene = cloud(points);
    const glm::dvec2 most = reach(scene, fittedCamera({90, 0}, scene, display, 1.0), display);
    EXPECT_LE(std::max(most.x, most.y), 1.0);
  }
}

TEST(FittedCamera, AnEmptySceneIsRefused) {
  EXPECT_THROW(fittedCamera({}, Scene(), {0, 0, 8, 8}, 1.0), MeaningError);
  EXPECT_THROW(fittedCamera({}, cloud({}), {0, 0, 8, 8}, 1.0), MeaningError);
}

}  // namespace
}  // namespace pellucid
