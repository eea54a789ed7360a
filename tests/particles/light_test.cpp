// Particles that cross in depth, and that stand in each other's light.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/over.h"
#include "composite/resolve.h"
#include "engine_bridge/scene/blocks.h"
#include "engine_bridge/scene/gltf.h"
#include "engine_bridge/scene/light_volume.h"
#include "engine_bridge/scene/particle_grid.h"
#include "tests/gl/builder.h"
#include "tests/particles/points_file.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// Must show (the papers' argument): red smoke passes through blue smoke. The picture is continuous in its depth under
// blended methods, and jumps under `over`, where the order turns.
TEST(Crossing, IsContinuousUnderBlendedMethodsAndJumpsUnderOver) {
  const std::string folder = freshFolder("crossing");
  Stage stage(16, 16);
  stage.gbuffer.viewZ = Image<float>(16, 16, 20.0f);
  stage.gbuffer.beauty = Image<glm::vec4>(16, 16, glm::vec4(0.2f, 0.2f, 0.2f, 1.0f));
  PointsFile points;
  points.material = unlitPoints(1, 1, 1, 0.6f);
  points.radii = {0.6f, 0.6f};
  points.colours = {{0.9f, 0.1f, 0.1f, 1.0f}, {0.1f, 0.1f, 0.9f, 1.0f}};
  GlContext context;
  constexpr int kSteps = 40;
  const int weights[] = {shading::PLD_WEIGHT_EQ5, shading::PLD_WEIGHT_EQ7Z, shading::PLD_WEIGHT_UNIFORM};
  double jumpOver = 0, jumpSums[3] = {}, travel[4] = {};
  glm::vec4 before[4] = {};
  for (int step = 0; step <= kSteps; ++step) {
    const float z = 4.98f + 0.001f * static_cast<float>(step);  // from before to behind the blue one at 5 m
    points.positions = {{0.0f, 0.0f, -z}, {0.1f, 0.0f, -5.0f}};
    writePoints(folder + "/points.gltf", points);
    stage.scene = loadScene({folder + "/points.gltf"}, {});
    TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
    glm::vec4 now[4];
    Veil veil(16, 16);
    pass.fragments({}, [&](const FragmentLists& lists) { compositeSorted(lists, stage.gbuffer.data, veil); });
    now[3] = compose(veil, stage.gbuffer).rgba.at(8, 8);
    for (int k = 0; k < 3; ++k) {
      PassSettings settings;
      settings.weight.kind = weights[k];
      now[k] = compose(resolve(pass.accumulate(settings), {}), stage.gbuffer).rgba.at(8, 8);
    }
    if (step > 0)
      for (int k = 0; k < 4; ++k) {
        double& jump = k < 3 ? jumpSums[k] : jumpOver;
        const double change = static_cast<double>(std::abs(now[k].r - before[k].r));
        jump = std::max(jump, change);
        travel[k] += change;
      }
    for (int k = 0; k < 4; ++k) before[k] = now[k];
  }
  std::printf(
      "red channel, 40 steps of a millimetre: largest step under over %.4f; eq5 %.2g, eq7z %.2g, uniform %.2g\n",
      jumpOver, jumpSums[0], jumpSums[1], jumpSums[2]);
  EXPECT_GT(jumpOver, 0.1);
  for (const double jump : jumpSums) EXPECT_LT(jump, 1e-3);
}

struct Cloud {
  Scene scene;
  Camera camera;
  std::vector<shading::PunctualLight> lights;
};

// `count` balls in a cube of 2 m about the origin, lit from above.
Cloud cloudOf(int count, float radius, float alpha) {
  const std::string folder = freshFolder("cloud");
  Random random(17);
  PointsFile points;
  for (int i = 0; i < count; ++i)
    points.positions.push_back({static_cast<float>(random.between(-1, 1)), static_cast<float>(random.between(-1, 1)),
                                static_cast<float>(random.between(-1, 1))});
  points.radii.assign(points.positions.size(), radius);
  points.material = unlitPoints(1, 1, 1, alpha);
  writePoints(folder + "/points.gltf", points);
  Cloud cloud;
  cloud.scene = loadScene({folder + "/points.gltf"}, {});
  Light sun;
  sun.kind = LightKind::directional;
  sun.direction = {0.0, -1.0, 0.0};
  sun.intensity = 1.0f;
  cloud.scene.lights = {sun};
  cloud.lights = lightBlocks(cloud.scene.lights, cloud.camera);
  return cloud;
}

// Light falls with depth as Beer and Lambert say: the mean of what a random cloud leaves is near exp(-n sigma d).
TEST(SelfShadow, FallsThroughACloudAsItsDensitySays) {
  constexpr int kCount = 40000;
  constexpr float kRadius = 0.05f, kAlpha = 0.05f;
  const Cloud cloud = cloudOf(kCount, kRadius, kAlpha);
  const auto grid = particleGrid(cloud.scene, 64);
  ASSERT_TRUE(grid);
  const Fog fog = particleFog(grid, cloud.camera, cloud.lights);
  const double volume = 4.0 / 3.0 * M_PI * std::pow(static_cast<double>(kRadius), 3);
  const double extinction =
      -std::log1p(-static_cast<double>(kAlpha)) / (2 * static_cast<double>(kRadius)) * volume * kCount / 8.0;
  double worst = 0;
  for (const double depth : {0.25, 0.5, 1.0, 1.5}) {
    double mean = 0;
    int count = 0;
    for (double x = -0.8; x <= 0.81; x += 0.2)
      for (double z = -0.8; z <= 0.81; z += 0.2, ++count)
        mean += static_cast<double>(gridDepth(fog, cloud.lights[0], {x, 1.0 - depth, z}, 0.02));
    mean /= count;
    const double wanted = extinction * depth;
    std::printf("depth %.2f m: optical depth %.4f, expected %.4f\n", depth, mean, wanted);
    worst = std::max(worst, std::abs(mean - wanted) / wanted);
  }
  EXPECT_LT(worst, 0.08);  // balls reach .05 m beyond the cube, and 40,000 of them are random
  // As much mass as the balls have, whatever the grid.
  for (const int edge : {8, 32, 100}) {
    const auto other = particleGrid(cloud.scene, edge);
    double mass = 0;
    const double cell = 1.0 / std::abs(glm::determinant(glm::dmat3(other->boxFromWorld))) /
                        static_cast<double>(other->density.texels.size());
    for (const float value : other->density.texels) mass += static_cast<double>(value) * cell;
    EXPECT_NEAR(mass / (extinction * 8.0), 1.0, 1e-3) << edge;
  }
}

TEST(SelfShadow, LitParticlesDarkenAwayFromTheLight) {
  Cloud cloud = cloudOf(3000, 0.1f, 0.3f);
  for (Material& material : cloud.scene.materials) material.unlit = false;
  Stage stage(48, 48);
  stage.scene = cloud.scene;
  stage.camera.viewFromWorld[3] = glm::dvec4(0.0, 0.0, -5.0, 1.0);
  const std::vector<shading::PunctualLight> lights = lightBlocks(stage.scene.lights, stage.camera);
  const Fog fog = particleFog(particleGrid(stage.scene, 64), stage.camera, lights);
  PassSettings settings;
  settings.particleLight = sampleLights(fog, {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}}, 48, nullptr);
  const auto meanRow = [&](const OitPlanes& planes, int y) {
    double sum = 0;
    for (int x = 20; x < 28; ++x) {
      const shading::Resolved resolved = shading::resolveSums(shading::unpackSums(planes.at(x, y)), false);
      sum += static_cast<double>(resolved.transparent.g / (1.0f - resolved.transmission.g)) / 8;
    }
    return sum;
  };
  const OitPlanes shadowed = stage.accumulate(settings);
  settings.particleLight = nullptr;
  const OitPlanes open = stage.accumulate(settings);
  const double top = meanRow(shadowed, 16), bottom = meanRow(shadowed, 32);
  std::printf("self-shadowed: top %.4f bottom %.4f; without: %.4f %.4f (1/4pi is %.4f)\n", top, bottom,
              meanRow(open, 16), meanRow(open, 32), 1 / (4 * M_PI));
  EXPECT_NEAR(meanRow(open, 16), 1 / (4 * M_PI), 1e-4);
  EXPECT_NEAR(meanRow(open, 32), 1 / (4 * M_PI), 1e-4);
  EXPECT_LT(top, 1 / (4 * M_PI));
  EXPECT_LT(bottom, 0.5 * top);
}

}  // namespace
}  // namespace pellucid::test
