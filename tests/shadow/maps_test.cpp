// Shadow maps against shadow rays: on the shadow, beside it, behind several layers, of every kind of light.
#include "engine_bridge/gl/shadow_pass.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>

#include "engine_bridge/embree/shadow_rays.h"
#include "tests/shadow/scenes.h"

namespace pellucid {
namespace {

using namespace test;
using Form = ShadowMapSettings::Form;

// Above the scene, looking down: points on the floor y = 0 are all there is to see.
Camera above() {
  Camera camera;
  camera.viewFromWorld = glm::dmat4(glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0));
  camera.viewFromWorld[3] = {0, 0, -4, 1};
  return camera;
}

glm::dvec3 viewOf(const Camera& camera, const glm::dvec3& world) {
  return glm::dvec3(camera.viewFromWorld * glm::dvec4(world, 1.0));
}

Light lampAt(glm::dvec3 position, LightKind kind = LightKind::point) {
  Light light;
  light.kind = kind;
  light.intensity = 1.0f;
  light.position = position;
  light.direction = {0, -1, 0};
  light.innerCone = .5f;
  light.outerCone = .9f;
  return light;
}

struct Difference {
  double mean = 0, worst = 0, spread = 0;  // spread: standard deviation of the maps' own values
};

// Over a grid of points on the floor.
Difference compare(const ShadowMaps& maps, const ShadowRays& rays, const Camera& camera, std::size_t light,
                   glm::dvec2 low, glm::dvec2 high, bool onOpaque = true, double height = 0) {
  constexpr int kSteps = 60;
  Difference difference;
  double first = 0, second = 0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const glm::dvec2 at = low + (high - low) * glm::dvec2((i + .5) / kSteps, (j + .5) / kSteps);
      const glm::dvec3 point = viewOf(camera, {at.x, height, at.y});
      const glm::dvec3 truth(rays.visibility(light, point));
      const glm::dvec3 found(onOpaque ? maps.onOpaque(light, glm::vec3(point))
                                      : maps.visibility(light, glm::vec3(point)));
      for (int c = 0; c < 3; ++c) {
        difference.mean += std::abs(found[c] - truth[c]) / (3.0 * kSteps * kSteps);
        difference.worst = std::max(difference.worst, std::abs(found[c] - truth[c]));
      }
      first += found.g / (kSteps * kSteps);
      second += found.g * found.g / (kSteps * kSteps);
    }
  difference.spread = std::sqrt(std::max(0.0, second - first * first));
  return difference;
}

const char* nameOf(Form form) {
  switch (form) {
    case Form::variance:
      return "variance";
    case Form::published:
      return "published";
    case Form::naive:
      return "naive";
    case Form::stratified:
      return "stratified";
    case Form::corrected:
      return "corrected";
  }
  return "";
}

ShadowMaps mapsOf(const Scene& scene, const Camera& camera, Form form, int size = 1024, std::uint32_t seed = 0) {
  GlContext context;
  ShadowMapSettings settings;
  settings.form = form;
  settings.size = size;
  settings.seed = seed;
  return renderShadowMaps(context, scene, camera, nullptr, settings);
}

// The paper's size is 4096 filtered down to 1024. Beside the shadow no bit differs from no shadow.
TEST(ShadowMaps, FlatReceiverUnderAPane) {
  const Camera camera = above();
  Scene scene;
  add(scene, quad(1, 1), glass({.9f, .5f, .1f}));
  scene.lights = {sun({.2, -1, .1})};
  const auto start = std::chrono::steady_clock::now();
  const ShadowRays rays(scene, camera);
  compare(ShadowMaps{{shading::ShadowLight{}}, {}, {}}, rays, camera, 0, {-.6, -.7}, {.9, .8});
  std::printf("rays: %.3f s for 3600 points\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  for (const Form form : {Form::variance, Form::published, Form::naive, Form::stratified, Form::corrected}) {
    const bool filtered = form == Form::variance || form == Form::published;
    GlContext context;
    ShadowMapSettings settings;
    settings.form = form;
    settings.size = filtered ? 4096 : 1024;
    ShadowMapStatistics statistics;
    const ShadowMaps maps = renderShadowMaps(context, scene, camera, nullptr, settings, &statistics);
    const Difference in = compare(maps, rays, camera, 0, {-.6, -.7}, {.9, .8});
    const Difference beside = compare(maps, rays, camera, 0, {1.4, -2}, {3, 2});
    std::printf(
        "%-10s %d^2: drawn in %.2f s, filtered in %.2f s, %zu MiB; error mean %.5f, worst %.5f, deviation %.5f\n",
        nameOf(form), settings.size, statistics.drawSeconds, statistics.filterSeconds, statistics.bytes >> 20, in.mean,
        in.worst, in.spread);
    EXPECT_EQ(beside.worst, 0.0) << nameOf(form);
    if (form == Form::variance) {
      EXPECT_LT(in.spread, 1e-4);  // rounded steps of the optical depth are all the noise there is
      EXPECT_LT(in.worst, 3e-4);
    }
    // A coin per texel: the tent keeps sqrt(sum of its squared weights) of the deviation, 8.4% of .5 in one texel, and
    // a bilinear lookup a little less. One per cent needs stratified coins or the exact density.
    if (form == Form::published) {
      EXPECT_NEAR(in.spread, .04, .006);
    }
    if (form == Form::corrected) {
      EXPECT_LT(in.worst, 5e-4);
    }
  }
}

// An opaque floor and receivers between layers: what Chebyshev's bound lets through that rays do not.
TEST(ShadowMaps, LightLeaksBehindSeveralLayers) {
  const Camera camera = above();
  Scene scene;
  for (int i = 0; i < 4; ++i) add(scene, quad(1.0f + .3f * static_cast<float>(i), 1), glass(glm::vec3(.6f)));
  scene.lights = {sun({0, -1, 0})};
  const ShadowRays rays(scene, camera);
  for (const Form form : {Form::variance, Form::published, Form::stratified, Form::corrected}) {
    const ShadowMaps maps = mapsOf(scene, camera, form);
    const glm::dvec2 low(-.8, -.8), high(.8, .8);
    std::printf("%-10s visibility off by: floor %.4f,", nameOf(form), compare(maps, rays, camera, 0, low, high).mean);
    for (const double height : {.8, 1.15, 1.45, 1.75, 2.1})
      std::printf(" %.2f m %.4f,", height, compare(maps, rays, camera, 0, low, high, false, height).mean);
    std::printf("\n");
    if (form == Form::variance) {
      EXPECT_LT(compare(maps, rays, camera, 0, low, high).worst, 1e-3);  // no leak at all on the floor
      // Four sheets are no slab: a little too dark before the first, too light behind it.
      for (const double height : {.8, 1.15, 1.45, 1.75, 2.1})
        EXPECT_LT(compare(maps, rays, camera, 0, low, high, false, height).mean, .1) << height;
    }
    if (form == Form::corrected) {
      for (const double height : {.8, 1.15, 1.45, 1.75})
        EXPECT_LT(compare(maps, rays, camera, 0, low, high, false, height).mean, .1) << height;  // 16 texels
    }
  }
}

TEST(ShadowMaps, PointAndSpotLightsAgreeWithRays) {
  const Camera camera = above();
  Scene scene;
  add(scene, quad(1, 1), glass({.9f, .5f, .1f}));
  add(scene, quad(3, 5), glass(glm::vec3(.5f)));  // above the lamps
  Light wide = lampAt({.2, 2, .1}, LightKind::spot);
  wide.outerCone = 1.3f;
  scene.lights = {lampAt({.2, 2, .1}), lampAt({.2, 2, .1}, LightKind::spot), wide};
  const ShadowRays rays(scene, camera);
  const ShadowMaps maps = mapsOf(scene, camera, Form::variance);
  EXPECT_EQ(maps.lights[0].faces.y, 6);
  EXPECT_EQ(maps.lights[1].faces.y, 1);
  EXPECT_EQ(maps.lights[2].faces.y, 6);
  for (const std::size_t light : {0u, 1u, 2u}) {
    const Difference in = compare(maps, rays, camera, light, {-1.5, -1.5}, {1.2, 1.2});
    const Difference beside = compare(maps, rays, camera, light, {2.4, -2}, {3, 2});
    std::printf("light %zu: error mean %.5f, worst %.5f; beside %.2g\n", light, in.mean, in.worst, beside.worst);
    EXPECT_LT(in.worst, 3e-4) << light;
    EXPECT_EQ(beside.worst, 0) << light;
  }
  // Onto the ceiling, through what is above the lamp alone.
  const glm::dvec3 above = viewOf(camera, {.4, 4, .3});
  EXPECT_NEAR(maps.onOpaque(0, glm::vec3(above)).r, .5f, 3e-4);
}

// Across the edge of a shadow the map is a blurred step: all of the error lies within the tent.
TEST(ShadowMaps, EdgesBlurByTheTentAlone) {
  const Camera camera = above();
  Scene scene;
  add(scene, quad(1, 1), glass(glm::vec3(.25f)));
  scene.lights = {sun({0, -1, 0})};
  const ShadowRays rays(scene, camera);
  const ShadowMaps maps = mapsOf(scene, camera, Form::variance);
  const double texel = 2.0 / (1024 - 32);  // of the map as drawn, metres
  double outside = 0, sum = 0;
  for (int i = -60; i <= 60; ++i) {
    const double x = 1 + .25 * i * texel;
    const glm::vec3 point(viewOf(camera, {x, 0, .3}));
    const double error = static_cast<double>(maps.onOpaque(0, point).r - rays.visibility(0, glm::dvec3(point)).r);
    sum += error;
    if (std::abs(x - 1) > 12 * texel) outside = std::max(outside, std::abs(error));
  }
  EXPECT_LT(outside, 3e-4);             // 8 texels of the tent, 4 of the lookup
  EXPECT_LT(std::abs(sum) / 121, .01);  // as much lost as gained: no shift
}

TEST(ShadowMaps, CausticBall) {
  const Camera camera = above();
  double centreBefore = 0, rimBefore = 2;
  for (const float ior : {1.0f, 1.2f, 1.3f, 1.5f, 1.8f}) {
    Scene scene;
    Material material = glass({.9f, .6f, .3f}, ior, true);
    material.doubleSided = false;
    add(scene, sphere({0, 2, 0}, 1.0f), material);
    scene.lights = {sun({0, -1, 0})};
    const ShadowRays rays(scene, camera);
    const ShadowMaps maps = mapsOf(scene, camera, Form::variance);
    const auto at = [&](double x) { return maps.onOpaque(0, glm::vec3(viewOf(camera, {x, 0, .01}))); };
    const glm::vec3 centre = at(.01), rim = at(.97);
    const glm::vec3 truth = rays.visibility(0, viewOf(camera, {.97, 0, .01}));
    // The plain shadow: both sides of the volume, 1 - alpha (1 - t) each, t with its Fresnel loss head-on.
    const glm::vec3 side = glm::vec3(.9f, .6f, .3f) * (1.0f - shading::fresnelDielectric(1.0f, ior));
    const glm::vec3 plain = side * side;
    std::printf("ior %.1f: centre %.4f (plain %.4f), rim %.4f (rays %.4f)\n", static_cast<double>(ior),
                static_cast<double>(centre.g), static_cast<double>(plain.g), static_cast<double>(rim.g),
                static_cast<double>(truth.g));
    EXPECT_NEAR(rim.g, truth.g, .02f);  // within the tent rho rises steeply
    if (ior == 1.0f) {
      EXPECT_NEAR(centre.g, plain.g, 2e-4);
      EXPECT_NEAR(rim.g, plain.g, 2e-4);
    } else {
      EXPECT_GT(centre.g, plain.g);  // lighter than the plain shadow in the middle
      EXPECT_LT(rim.g, plain.g);     // darker at the rim
    }
    for (int i = 0; i < 100; ++i)
      for (int c = 0; c < 3; ++c) EXPECT_LE(at(.012 * i)[c], 1.0f);  // never brighter than no shadow
    EXPECT_GT(static_cast<double>(centre.g), centreBefore);
    EXPECT_LT(static_cast<double>(rim.g), rimBefore);
    centreBefore = static_cast<double>(centre.g);
    rimBefore = static_cast<double>(rim.g);
  }
}

TEST(ShadowMaps, ColouredGlassCastsItsOwnColour) {
  const Camera camera = above();
  const glm::vec3 colour(.8f, .4f, .2f);
  Scene scene;
  add(scene, quad(1, 1), glass(colour));
  scene.lights = {sun({.1, -1, 0})};
  for (const Form form : {Form::variance, Form::published}) {
    const ShadowMaps maps = mapsOf(scene, camera, form, 2048);
    glm::dvec3 sum(0);
    double worst = 0;
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j) {
        const glm::dvec3 v(maps.onOpaque(0, glm::vec3(viewOf(camera, {.03 * i, 0, .03 * j}))));
        sum += v;
        worst = std::max(worst, std::abs(v.g / v.r / .5 - 1));
      }
    std::printf("%s: umbra %.4f : %.4f : %.4f, worst point's green to red off by %.2f%%\n", nameOf(form), sum.r / 1681,
                sum.g / 1681, sum.b / 1681, 100 * worst);
    EXPECT_NEAR(sum.g / sum.r, .5, .05 * .5);
    EXPECT_NEAR(sum.b / sum.r, .25, .05 * .25);
    if (form == Form::variance) {
      EXPECT_LT(worst, .05);
    }
  }
}

TEST(ShadowMaps, SingleSidedPanesAndSolidsCountAsForRays) {
  const Camera camera = above();
  Material tinted = glass(glm::vec3(.5f));
  tinted.doubleSided = false;
  Scene scene;
  add(scene, quad(1, 2), tinted);
  scene.lights = {sun({0, -1, 0}), sun({0, 1, 0})};
  const ShadowMaps pane = mapsOf(scene, camera, Form::variance);
  EXPECT_NEAR(pane.onOpaque(0, glm::vec3(viewOf(camera, {0, 0, 0}))).r, .5f, 3e-4);
  EXPECT_NEAR(pane.onOpaque(1, glm::vec3(viewOf(camera, {0, 2, 0}))).r, .5f, 3e-4);
  Scene ball;
  add(ball, sphere({0, 1, 0}, .5f), tinted);
  ball.lights = {sun({0, -1, 0})};
  EXPECT_NEAR(mapsOf(ball, camera, Form::variance).onOpaque(0, glm::vec3(viewOf(camera, {.1, 0, .1}))).r, .5f, 3e-4);
}

// A lid above the floor, known to the scene or only seen by the camera: casters below it, and points in its shadow.
TEST(ShadowMaps, OpaqueCastersComeFromTheSceneOrFromThePicture) {
  const Camera camera = above();
  Material paint = glass(glm::vec3(.5f));
  paint.transmission = 0.0f;
  Scene scene;
  Primitive below = quad(.5f, 1.5f);
  add(scene, below, glass(glm::vec3(.5f)));
  scene.lights = {sun({0, -1, 0})};
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 256, 256};
  gbuffer.viewZ = Image<float>(256, 256, 4.0f);
  for (int y = 96; y < 160; ++y)  // a lid of 1.5 m at a height of 1 m, below it the floor at 0
    for (int x = 96; x < 160; ++x) gbuffer.viewZ.at(x, y) = 3.0f;
  Scene whole = scene;
  add(whole, quad(1, .75f), paint);
  add(whole, quad(0, 4.0f), paint);
  GlContext context;
  ShadowMapSettings settings;
  settings.size = 1024;
  settings.opaqueSize = 512;
  const ShadowMaps fromScene = renderShadowMaps(context, whole, camera, nullptr, settings);
  const ShadowMaps fromPicture = renderShadowMaps(context, scene, camera, &gbuffer, settings);
  for (const ShadowMaps* maps : {&fromScene, &fromPicture}) {
    const auto at = [&](double x, double y, double z) {
      return maps->visibility(0, glm::vec3(viewOf(camera, {x, y, z}))).r;
    };
    EXPECT_EQ(at(.3, .2, .3), 0.0f);         // under the lid
    EXPECT_EQ(at(.3, .7, .3), 0.0f);         // between the lid and the pane
    EXPECT_EQ(at(.3, 1.2, .3), 1.0f);        // above the lid
    EXPECT_EQ(at(1.2, .8, 0), 1.0f);         // beside it, above the pane
    EXPECT_NEAR(at(1.2, .2, 0), .5f, 1e-3);  // below the pane
    EXPECT_EQ(at(.3, 1.001, .3), 1.0f);      // on the lid: no acne
    // The pane lies behind the lid as the light sees it: the lid itself is not shadowed by it.
    EXPECT_EQ(maps->onOpaque(0, glm::vec3(viewOf(camera, {.3, 1, .3}))).r, 1.0f);
  }
}

TEST(ShadowMaps, SameSeedSameBitsWhateverTheOrderAndChunks) {
  const Camera camera = above();
  Scene scene;
  add(scene, sphere({0, 1, 0}, .5f), glass({.9f, .5f, .1f}));
  add(scene, quad(2, 1), glass(glm::vec3(.7f)));
  scene.lights = {sun({.2, -1, .1})};
  GlContext context;
  for (const Form form : {Form::variance, Form::stratified}) {
    ShadowMapSettings settings;
    settings.form = form;
    settings.size = 512;
    const ShadowMaps one = renderShadowMaps(context, scene, camera, nullptr, settings);
    ShadowMapSettings other = settings;
    other.order = {SubmissionOrder::shuffle, 3};
    other.budgetBytes = 64 << 10;
    const ShadowMaps two = renderShadowMaps(context, scene, camera, nullptr, other);
    ASSERT_EQ(one.texels.size(), two.texels.size());
    EXPECT_EQ(0, std::memcmp(one.texels.data(), two.texels.data(), one.texels.size() * sizeof(glm::vec4)));
    settings.seed = 1;
    const ShadowMaps three = renderShadowMaps(context, scene, camera, nullptr, settings);
    EXPECT_NE(0, std::memcmp(one.texels.data(), three.texels.data(), one.texels.size() * sizeof(glm::vec4)));
  }
}

TEST(ShadowMaps, NothingThereIsNoShadow) {
  const Camera camera = above();
  Scene scene;
  scene.lights = {sun({0, -1, 0}), lampAt({0, 1, 0})};
  EXPECT_EQ(mapsOf(scene, camera, Form::variance).visibility(1, {0, 0, -3}), glm::vec3(1.0f));
  Material flame = glass(glm::vec3(.5f)), ghost = glass(glm::vec3(.5f));
  flame.additive = true;
  ghost.castsShadow = false;
  add(scene, quad(1, 1), flame);
  add(scene, quad(2, 1), ghost);
  const ShadowMaps maps = mapsOf(scene, camera, Form::variance);
  EXPECT_TRUE(maps.texels.empty());
  EXPECT_EQ(maps.onOpaque(0, {0, 0, -4}), glm::vec3(1.0f));
}

// The bound on casters alone is the bound on all texels when empty ones lie at the receiver, as PT17 fills them.
TEST(ShadowMaps, EmptyTexelsMayLieAtTheReceiver) {
  for (int i = 1; i < 50; ++i) {
    const double hit = .02 * i, near = -.3, spread = .2, t = .4 + .01 * i;
    const glm::vec4 texel(0.0f, static_cast<float>(hit), static_cast<float>(hit * near),
                          static_cast<float>(hit * (near * near + spread * spread)));
    const double mean = hit * near + (1 - hit) * t;
    const double variance = hit * (near * near + spread * spread) + (1 - hit) * t * t - mean * mean;
    const double chebyshev = variance / (variance + (t - mean) * (t - mean));
    EXPECT_NEAR(1 - hit * static_cast<double>(shading::casterShare(texel, static_cast<float>(t))), chebyshev, 1e-5);
  }
}

// Every square of 2, 4, 8 and 16 texels holds rho of the coins, rounded; two casters' coins are independent.
TEST(ShadowMaps, StratifiedCoinsAreStratifiedUniformAndIndependent) {
  const float rho = .3f;
  double both = 0, first = 0;
  for (std::uint32_t block = 0; block < 400; ++block) {
    const glm::uvec2 corner(16 * (block % 20), 16 * (block / 20));
    for (const std::uint32_t edge : {2u, 4u, 8u, 16u}) {
      int covered = 0;
      for (std::uint32_t i = 0; i < edge * edge; ++i)
        covered += shading::casts(rho, shading::stratifiedXi(corner + glm::uvec2(i % edge, i / edge), 77u)) ? 1 : 0;
      EXPECT_LT(std::abs(covered - static_cast<double>(rho) * edge * edge), 1.0) << edge;
    }
    for (std::uint32_t i = 0; i < 256; ++i) {
      const glm::uvec2 texel = corner + glm::uvec2(i % 16, i / 16);
      const bool a = shading::casts(rho, shading::stratifiedXi(texel, 77u));
      const bool b = shading::casts(.6f, shading::stratifiedXi(texel, 78u));
      first += a ? 1 : 0;
      both += a && b ? 1 : 0;
    }
  }
  // 102,400 texels; a naive coin's standard error of the joint share is .0012.
  EXPECT_NEAR(first / 102400, .3, .0005);
  EXPECT_NEAR(both / 102400, .18, .004);
}

}  // namespace
}  // namespace pellucid
