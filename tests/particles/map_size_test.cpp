// Shadow maps of dense particles: a finer one holds nearly the same shadow for more fragments.
#include <gtest/gtest.h>

#include <cmath>

#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "engine_bridge/scene/particle_grid.h"
#include "tests/particles/points_file.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

Scene cloudOf(int count, double radius, float alpha, const std::string& folder) {
  Random random(8);
  PointsFile points;
  for (int i = 0; i < count; ++i) {
    points.positions.push_back({static_cast<float>(random.between(-1, 1)), static_cast<float>(random.between(1, 3)),
                                static_cast<float>(random.between(-1, 1))});
    points.radii.push_back(static_cast<float>(radius * random.between(.7, 1.3)));
  }
  points.material = unlitPoints(.5f, .5f, .5f, alpha);
  writePoints(folder + "/points.gltf", points);
  Scene scene = loadScene({folder + "/points.gltf"}, {});
  Light light;
  light.kind = LightKind::directional;
  light.intensity = 1.0f;
  light.direction = {0, -1, 0};
  scene.lights = {light};
  return scene;
}

TEST(ParticleMap, ADenseCloudNeedsFewTexelsAcrossAParticle) {
  const std::string folder = freshFolder("particle-map");
  const Scene scene = cloudOf(3000, .1, .03f, folder);
  const int size = particleMapSize(scene, 24, 4096);
  EXPECT_EQ(size, 512);
  GlContext context;
  ShadowMaps maps[2];
  for (int i = 0; i < 2; ++i) {
    ShadowMapSettings settings;
    settings.size = i == 0 ? size : 4 * size;
    ShadowMapStatistics statistics;
    maps[i] = renderShadowMaps(context, scene, {}, nullptr, settings, &statistics);
    std::printf("%d^2: drawn in %.2f s, filtered in %.2f s\n", settings.size, statistics.drawSeconds,
                statistics.filterSeconds);
  }
  Random random(2);
  double sum = 0, worst = 0, shadow = 0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const glm::vec3 at(static_cast<float>(random.between(-1, 1)), 0.0f, static_cast<float>(random.between(-1, 1)));
    const double coarse = static_cast<double>(maps[0].onOpaque(0, at).g),
                 fine = static_cast<double>(maps[1].onOpaque(0, at).g);
    sum += std::abs(coarse - fine);
    worst = std::max(worst, std::abs(coarse - fine));
    shadow += 1 - fine;
  }
  std::printf("they differ by %.4f in the mean, %.4f at most, of a mean shadow of %.3f\n", sum / kPoints, worst,
              shadow / kPoints);
  EXPECT_GT(shadow / kPoints, .2);
  EXPECT_LT(sum / kPoints, .02 * shadow / kPoints);
}

TEST(ParticleMap, SmallParticlesAndOtherCastersTakeMoreTexels) {
  const std::string folder = freshFolder("particle-map-size");
  const int small = particleMapSize(cloudOf(60000, .02, .03f, folder), 24, 4096);
  EXPECT_NEAR(small, 24 / .04 * 2.05, 128);  // of the cloud's 2 m
  EXPECT_EQ(small % 128, 0);
  EXPECT_EQ(particleMapSize(cloudOf(150, .1, .03f, folder), 24, 4096), 4096);  // one or two deep
  EXPECT_EQ(particleMapSize(cloudOf(60000, .02, .03f, folder), 24, 1024), 1024);
  Scene mixed = cloudOf(3000, .1, .03f, folder);
  Material glass;
  glass.transmission = 1.0f;
  Primitive pane = mixed.primitives[0];
  pane.points = false;
  pane.material = static_cast<int>(mixed.materials.size());
  mixed.materials.push_back(glass);
  Instance instance;
  instance.primitive = static_cast<int>(mixed.primitives.size());
  mixed.primitives.push_back(pane);
  mixed.instances.push_back(instance);
  EXPECT_EQ(particleMapSize(mixed, 24, 4096), 4096);
}

}  // namespace
}  // namespace pellucid::test
