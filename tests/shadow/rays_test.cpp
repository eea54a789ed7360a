// Shadow rays against closed forms.
#include "engine_bridge/embree/shadow_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shaders/shading.h"
#include "tests/shadow/scenes.h"

namespace pellucid {
namespace {

using namespace test;

// The camera is at the origin: view space is world space.
TEST(ShadowRays, ColouredPaneCastsItsOwnColour) {
  Scene scene;
  add(scene, quad(1, 2), glass({.9f, .5f, .1f}));
  scene.lights = {sun({0, -1, 0}), sun({.3, -1, .2})};
  const ShadowRays rays(scene, Camera{});
  for (std::size_t light : {0, 1}) {
    const glm::vec3 v = rays.visibility(light, {.1, 0, .2});
    EXPECT_NEAR(v.r, .9f, 1e-6);
    EXPECT_NEAR(v.g, .5f, 1e-6);
    EXPECT_NEAR(v.b, .1f, 1e-6);
  }
  EXPECT_EQ(rays.visibility(0, {3, 0, 0}), glm::vec3(1.0f));
  EXPECT_EQ(rays.visibility(0, {0, 1.5, 0}), glm::vec3(1.0f));  // above the pane
}

TEST(ShadowRays, LayersMultiplyAndCoverageCounts) {
  Scene scene;
  add(scene, quad(1, 2), glass(glm::vec3(.5f)));
  Material smoke = glass(glm::vec3(1.0f));
  smoke.transmission = 0.0f;
  smoke.alphaMode = AlphaMode::blend;
  smoke.baseColor.a = .25f;
  add(scene, quad(2, 2), smoke);
  Material ghost = glass(glm::vec3(0.0f));
  ghost.castsShadow = false;
  add(scene, quad(3, 2), ghost);
  scene.lights = {sun({0, -1, 0})};
  const glm::vec3 v = ShadowRays(scene, Camera{}).visibility(0, {0, 0, 0});
  EXPECT_NEAR(v.r, .5f * .75f, 1e-6);
}

TEST(ShadowRays, SharedEdgesCountOnce) {
  Scene scene;
  add(scene, quad(1, 2), glass(glm::vec3(.5f)));
  scene.lights = {sun({0, -1, 0})};
  const ShadowRays rays(scene, Camera{});
  for (int i = -9; i <= 9; ++i)  // along the diagonal of the quad
    EXPECT_NEAR(rays.visibility(0, {.2 * i, 0, -.2 * i}).r, .5f, 1e-6) << i;
}

TEST(ShadowRays, SingleSidedPanesCountFromBothSidesAndSolidsOnce) {
  Material tinted = glass(glm::vec3(.5f));
  tinted.doubleSided = false;
  Scene scene;
  add(scene, quad(1, 2), tinted);
  scene.lights = {sun({0, -1, 0}), sun({0, 1, 0})};
  const ShadowRays pane(scene, Camera{});
  EXPECT_NEAR(pane.visibility(0, {0, 0, 0}).r, .5f, 1e-6);
  EXPECT_NEAR(pane.visibility(1, {0, 2, 0}).r, .5f, 1e-6);
  Scene ball;
  add(ball, sphere({0, 1, 0}, .5f), tinted);
  ball.lights = {sun({0, -1, 0})};
  EXPECT_NEAR(ShadowRays(ball, Camera{}).visibility(0, {.1, 0, .1}).r, .5f, 1e-6);
}

TEST(ShadowRays, PointLightStopsAtTheLightAndSpotOutsideItsCone) {
  Scene scene;
  add(scene, quad(1, 5), glass(glm::vec3(.5f)));
  add(scene, quad(3, 5), glass(glm::vec3(.5f)));  // behind the light
  Light lamp;
  lamp.kind = LightKind::point;
  lamp.intensity = 1.0f;
  lamp.position = {0, 2, 0};
  Light spot = lamp;
  spot.kind = LightKind::spot;
  spot.direction = {0, -1, 0};
  spot.innerCone = .2f;
  spot.outerCone = .3f;
  scene.lights = {lamp, spot};
  const ShadowRays rays(scene, Camera{});
  EXPECT_NEAR(rays.visibility(0, {.3, 0, 0}).r, .5f, 1e-6);
  EXPECT_NEAR(rays.visibility(1, {.3, 0, 0}).r, .5f, 1e-6);
  EXPECT_EQ(rays.visibility(1, {3, 0, 0}), glm::vec3(1.0f));
}

TEST(ShadowRays, CausticBallIsLighterAtItsCentreDarkerAtItsRim) {
  double centreBefore = 0, rimBefore = 2;
  for (const float ior : {1.0f, 1.3f, 1.5f}) {
    Scene scene;
    Material material = glass(glm::vec3(.6f), ior, true);
    material.doubleSided = false;
    add(scene, sphere({0, 2, 0}, 1.0f), material);
    scene.lights = {sun({0, -1, 0})};
    const ShadowRays rays(scene, Camera{});
    const double centre = rays.visibility(0, {.01, 0, .01}).r, rim = rays.visibility(0, {.97, 0, .02}).r;
    std::printf("ior %.1f: visibility %.4f at the centre, %.4f at the rim\n", static_cast<double>(ior), centre, rim);
    if (ior == 1.0f) {
      EXPECT_NEAR(centre, .36, 1e-6);  // exactly the plain coloured shadow: a volume tints on both of its sides
      EXPECT_NEAR(rim, .36, 1e-6);
    }
    EXPECT_GT(centre, centreBefore);
    EXPECT_LT(rim, rimBefore);
    EXPECT_LE(centre, 1.0);
    centreBefore = centre;
    rimBefore = rim;
  }
}

// A floor seen from above, a pane over half of it: umbra and lit part to the bit, edges antialiased.
TEST(ShadowRays, PictureOfAPaneShadow) {
  Camera camera;
  camera.viewFromWorld = glm::dmat4(glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0));  // looks down -y
  camera.viewFromWorld[3] = {0, 0, -4, 1};
  Scene scene;
  Primitive pane = quad(1, 1);
  for (Vertex& vertex : pane.vertices) vertex.position.x += 1.013f;
  add(scene, pane, glass({.25f, .5f, 1.0f}));
  scene.lights = {sun({0, -1, 0})};
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 64, 48};
  gbuffer.viewZ = Image<float>(64, 48, 4.0f);
  gbuffer.viewZ.at(5, 5) = std::numeric_limits<float>::infinity();
  const ShadowRays rays(scene, camera);
  const Image<glm::vec3> v = rays.visibility(0, gbuffer, 16);
  const double metres = 8.0 / 64;  // a pixel
  int lit = 0, umbra = 0, edge = 0;
  for (int y = 20; y < 28; ++y)
    for (int x = 0; x < 64; ++x) {
      const double left = (x - 32) * metres, right = left + metres;
      if (right < .013 || left > 2.013) {
        EXPECT_EQ(v.at(x, y), glm::vec3(1.0f)) << x;
        ++lit;
      } else if (left > .013 && right < 2.013) {
        EXPECT_NEAR(v.at(x, y).r, .25f, 1e-6) << x;
        EXPECT_NEAR(v.at(x, y).g, .5f, 1e-6) << x;
        ++umbra;
      } else {
        const double covered = left <= .013 ? (right - .013) / metres : (2.013 - left) / metres;
        EXPECT_NEAR(v.at(x, y).r, 1 - .75 * covered, .75 * 1.5 / 16) << x;  // 16 stratified positions
        ++edge;
      }
    }
  EXPECT_GT(lit, 100);
  EXPECT_GT(umbra, 80);
  EXPECT_EQ(edge, 16);
  EXPECT_EQ(v.at(5, 5), glm::vec3(1.0f));
}

}  // namespace
}  // namespace pellucid
