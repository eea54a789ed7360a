// --shadows exact on transparent things: a ray for each light and fragment, drawn by GL, against closed forms and
// against fragments by rays.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "composite/fold.h"
#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/embree/surface_shadows.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "tests/shadow/scenes.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;

Material smoke(float alpha) {
  Material material = glass(glm::vec3(1.0f));
  material.transmission = 0.0f;
  material.alphaMode = alpha < 1.0f ? AlphaMode::blend : AlphaMode::mask;
  material.roughness = 1.0f;
  material.baseColor.a = alpha;
  return material;
}

// Looks down on the scene from a height of 4 m, as its sun does.
struct Stage {
  explicit Stage(int edge = 24) {
    camera.viewFromWorld = glm::dmat4(glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0));
    camera.viewFromWorld[3] = {0, 0, -4, 1};
    camera.focal = {2, 2};
    gbuffer.display = gbuffer.data = {0, 0, edge, edge};
    gbuffer.viewZ = Image<float>(edge, edge, std::numeric_limits<float>::infinity());
  }
  PassSettings traced() const {
    PassSettings settings;
    settings.filter = TextureFilter::bilinear;
    settings.shadowRays = std::make_shared<const SurfaceVisibility>(
        surfaceShadows(scene, camera, gbuffer, std::make_shared<const ShadowRays>(scene, camera)));
    return settings;
  }
  std::vector<FragmentLists> lists(const PassSettings& settings) const {
    TransparentPass pass(context, scene, gbuffer, camera);
    std::vector<FragmentLists> tiles;
    pass.fragments(settings, [&](const FragmentLists& tile) { tiles.push_back(tile); });
    rays = pass.statistics().shadowRays;
    return tiles;
  }
  Scene scene;
  GBuffer gbuffer;
  Camera camera;
  mutable GlContext context;
  mutable std::size_t rays = 0;
};

// By pixel and triangle.
std::map<std::pair<std::size_t, std::uint32_t>, Fragment> byName(const std::vector<FragmentLists>& tiles) {
  std::map<std::pair<std::size_t, std::uint32_t>, Fragment> named;
  std::size_t pixel = 0;
  for (const FragmentLists& tile : tiles)
    for (std::size_t i = 0; i + 1 < tile.offsets.size(); ++i, ++pixel)
      for (std::uint64_t k = tile.offsets[i]; k < tile.offsets[i + 1]; ++k)
        named.emplace(std::pair(pixel, tile.fragments[k].identity), tile.fragments[k]);
  return named;
}

// Of sheets under a sun each gets what those above it leave: to the bit of the coverage.
TEST(TracedLight, StackOfSheetsIsTheClosedForm) {
  Stage stage;
  constexpr int kSheets = 6;
  for (int i = 0; i < kSheets; ++i) add(stage.scene, quad(.2f * static_cast<float>(i), 1.5f), smoke(.3f));
  stage.scene.lights = {sun({0, -1, 0})};
  PassSettings open;
  open.filter = TextureFilter::bilinear;
  const auto lit = byName(stage.lists(open)), shadowed = byName(stage.lists(stage.traced()));
  ASSERT_EQ(lit.size(), shadowed.size());
  ASSERT_GT(lit.size(), 2000u);
  EXPECT_EQ(stage.rays, lit.size());
  double worst = 0;
  for (const auto& [name, fragment] : shadowed) {
    const double above = std::round((4.0 - .2 * (kSheets - 1) - static_cast<double>(fragment.z)) / -.2);
    const double found = static_cast<double>(fragment.radiance.g / lit.at(name).radiance.g);
    worst = std::max(worst, std::abs(found - std::pow(1 - static_cast<double>(.3f), above)));
  }
  std::printf("%zu fragments of %d sheets: off by %.2g of the light\n", lit.size(), kSheets, worst);
  EXPECT_LT(worst, 1e-6);
}

// Glass balls, panes and leaves under a sun and a lamp: the same fragments, shaded by Embree alone.
TEST(TracedLight, GlAgreesWithFragmentsByRays) {
  Stage stage(64);
  Random random(3);
  for (int i = 0; i < 3; ++i)
    add(stage.scene, sphere({random.between(-.8, .8), random.between(0, 1), random.between(-.8, .8)}, .4f),
        glass({.9f, .5f, .2f}, 1.4f, true));
  add(stage.scene, quad(1.6f, .5f), smoke(.5f));
  add(stage.scene, quad(-.6f, 1.5f), smoke(1.0f));  // hides everything: a solid
  for (Material& material : stage.scene.materials) material.roughness = .6f;
  Light lamp = sun({0, -1, 0});
  lamp.kind = LightKind::point;
  lamp.position = {.5, 2.5, .3};
  Light dark = lamp;
  dark.intensity = 0.0f;
  stage.scene.lights = {dark, sun({.3, -1, .1}), lamp};
  const PassSettings settings = stage.traced();
  const std::vector<FragmentLists> tiles = stage.lists(settings);
  RayFragments traced(stage.scene, stage.gbuffer, stage.camera);
  traced.shadowBy(std::make_shared<const ShadowRays>(stage.scene, stage.camera));
  std::vector<FragmentLists> bands;
  traced.fragments(settings, [&](const FragmentLists& band) { bands.push_back(band); });
  const auto gl = byName(tiles), truth = byName(bands);
  std::size_t compared = 0, apart = 0;
  double worst = 0;
  for (const auto& [name, fragment] : gl) {
    const auto other = truth.find(name);
    if (other == truth.end()) continue;
    ++compared;
    double difference = 0;
    for (int c = 0; c < 3; ++c)
      difference =
          std::max(difference, std::abs(static_cast<double>(fragment.radiance[c] - other->second.radiance[c])) /
                                   (.05 + static_cast<double>(other->second.radiance[c])));
    if (difference > 1e-3)
      ++apart;
    else
      worst = std::max(worst, difference);
  }
  std::printf("%zu of %zu fragments: %zu further apart than .001, the others at most %.2g\n", compared, gl.size(),
              apart, worst);
  EXPECT_GT(compared, 1500u);
  EXPECT_GT(compared, gl.size() * 97 / 100);  // silhouettes of balls, in floats here and in doubles there
  // Where the depth that GL rounds to a float decides on which side of another triangle a ray starts.
  EXPECT_LE(apart, compared / 100);
  // Solids are lit past the balls as well.
  const auto solidsOf = [](const std::vector<FragmentLists>& parts) {
    std::vector<glm::vec4> all;  // whole rows from the top
    for (const FragmentLists& part : parts)
      for (std::size_t i = 0; i < part.solid.size(); ++i) all.push_back(part.solid[i]);
    return all;
  };
  const std::vector<glm::vec4> solid = solidsOf(tiles), other = solidsOf(bands);
  ASSERT_EQ(solid.size(), other.size());
  float brightest = 0.0f;
  for (const glm::vec4& each : solid) brightest = std::max(brightest, std::isfinite(each.a) ? each.g : 0.0f);
  int darker = 0, equal = 0, number = 0;
  for (std::size_t i = 0; i < solid.size(); ++i)
    if (std::isfinite(solid[i].a)) {
      ++number;
      darker += solid[i].g < .8f * brightest ? 1 : 0;
      equal += std::abs(solid[i].g - other[i].g) < 1e-4f ? 1 : 0;
    }
  std::printf("solids: %d, %d of them in some shadow, %d alike\n", number, darker, equal);
  EXPECT_GT(darker, 200);
  EXPECT_GT(equal, number * 99 / 100);
}

// Sums and lists look their light up with different programs.
TEST(TracedLight, SumsAreThoseOfTheLists) {
  Stage stage;
  for (int i = 0; i < 5; ++i)
    add(stage.scene, quad(.2f * static_cast<float>(i), 1.4f - .2f * static_cast<float>(i)), smoke(.4f));
  add(stage.scene, sphere({.2f, 1.4f, 0}, .3f), glass({.9f, .5f, .2f}, 1.0f));
  stage.scene.lights = {sun({.4, -1, .2})};
  PassSettings settings = stage.traced();
  settings.sample = {.3, .8};
  settings.tile = 7;  // scissors: the table is the super-tile's
  TransparentPass pass(stage.context, stage.scene, stage.gbuffer, stage.camera);
  const OitPlanes sums = pass.accumulate(settings);
  OitPlanes folded = emptyPlanes(stage.gbuffer.display, stage.gbuffer.data);
  pass.fragments(settings, [&](const FragmentLists& tile) {
    foldFragments(tile, settings.weight, settings.normalisation, folded);
  });
  double worst = 0, brightest = 0;
  for (std::size_t i = 0; i < sums.radiance.size(); ++i) {
    brightest = std::max(brightest, static_cast<double>(sums.radiance[i].g));
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(sums.radiance[i][c] - folded.radiance[i][c])));
  }
  std::printf("sums apart by %.2g of %.2g\n", worst, brightest);
  EXPECT_GT(brightest, 0.0);
  EXPECT_LT(worst, 2e-6 * brightest);  // the order of additions
}

// A lid that only the picture knows shades the pane under it, and not the pane that stands a little above it.
TEST(TracedLight, ThePicturesSurfaceIsInTheWay) {
  Stage stage(64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) stage.gbuffer.viewZ.at(x, y) = x < 32 ? 3.0f : 4.0f;  // the lid is 1 m above the floor
  add(stage.scene, quad(.5f, 1.5f), smoke(.5f));                                       // seen beside the lid alone
  add(stage.scene, quad(1.05f, 1.5f), smoke(.5f));  // 5 cm above the lid; a pixel has 5 cm there
  stage.scene.lights = {sun({1, -1, 0})};           // the lid's shadow falls to the right
  const std::vector<FragmentLists> open = stage.lists({}), shadowed = stage.lists(stage.traced());
  const auto lit = byName(open), traced = byName(shadowed);
  int dark = 0, upper = 0, beyond = 0;
  for (const auto& [name, fragment] : traced) {
    const double share = static_cast<double>(fragment.radiance.g / lit.at(name).radiance.g);
    const int x = static_cast<int>(name.first % 64);
    const double metres = ((x + .5) / 32.0 - 1.0) * static_cast<double>(fragment.z) / 2.0;  // right of the lid's rim
    if (fragment.z < 3.2f) {
      upper += share == 1.0 ? 1 : 0;
      EXPECT_EQ(share, 1.0) << x;
    } else if (metres > .05 && metres < .35) {
      dark += share == 0.0 ? 1 : 0;
      EXPECT_EQ(share, 0.0) << x;
    } else if (metres > .7) {
      ++beyond;
      EXPECT_GT(share, 0.0) << x;
    }
  }
  EXPECT_GT(upper, 1000);
  EXPECT_GT(dark, 100);
  EXPECT_GT(beyond, 100);
}

}  // namespace
}  // namespace pellucid
