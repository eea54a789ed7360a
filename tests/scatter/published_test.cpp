// The `published` tier: its encodings, GL against CPU, what it clamps, and what it loses by design.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/fold_published.h"
#include "composite/resolve.h"
#include "gbuffer/planes_io.h"
#include "tests/gl/builder.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr shading::WeightSettings kEq5Weight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

// All finite halves from 0 up, in order, from their definition.
std::vector<float> halves() {
  std::vector<float> values;
  for (int exponent = 0; exponent < 31; ++exponent)
    for (int mantissa = 0; mantissa < 1024; ++mantissa)
      values.push_back(
          static_cast<float>(exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25)));
  return values;
}

TEST(Published, HalvesRoundToTheNearestTiesToEven) {
  const std::vector<float> all = halves();
  for (const float value : all) ASSERT_EQ(shading::roundedToHalf(value), value);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const float tie = 0.5f * (all[i] + all[i + 1]);  // exact in float
    ASSERT_EQ(shading::roundedToHalf(tie), all[i % 2 == 0 ? i : i + 1]) << tie;
    ASSERT_EQ(shading::roundedToHalf(std::nextafter(tie, 0.0f)), all[i]) << tie;
    ASSERT_EQ(shading::roundedToHalf(-std::nextafter(tie, 1e9f)), -all[i + 1]) << tie;
  }
  EXPECT_EQ(shading::roundedToHalf(65519.0f), 65504.0f);
  EXPECT_TRUE(std::isinf(shading::roundedToHalf(65520.0f)));
}

TEST(Published, StepsComeBack) {
  for (int step = 0; step < 256; ++step) EXPECT_EQ(shading::unormOf(shading::fromUnorm(step)), step);
  for (int step = -127; step < 128; ++step) EXPECT_EQ(shading::snormOf(shading::fromSnorm(step)), step);
  EXPECT_EQ(shading::unormOf(-1.0f), 0);
  EXPECT_EQ(shading::unormOf(7.0f), 255);
  EXPECT_EQ(shading::snormOf(-7.0f), -127);
}

Fragment randomFragment(Random& random) {
  Fragment fragment{};
  fragment.coverage = random.uniformf();
  fragment.transmission = glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
  fragment.radiance = fragment.coverage * glm::vec3(random.uniformf(), 4 * random.uniformf(), random.uniformf());
  fragment.z = 0.5f + 40.0f * random.uniformf();
  fragment.offset = glm::vec2(60 * random.uniformf() - 30, 60 * random.uniformf() - 30);
  fragment.variance = 600.0f * random.uniformf();
  return fragment;
}

FragmentLists onePixel(const std::vector<Fragment>& fragments) {
  FragmentLists lists;
  lists.window = {0, 0, 1, 1};
  lists.solid = Image<glm::vec4>(1, 1, glm::vec4(0, 0, 0, kSky));
  lists.fragments = fragments;
  lists.offsets = {0, fragments.size()};
  return lists;
}

OitPlanes folded(const std::vector<Fragment>& fragments, PublishedClamps& clamps) {
  OitPlanes planes = emptyPublishedPlanes({0, 0, 1, 1}, {0, 0, 1, 1});
  foldPublished(onePixel(fragments), kEq5Weight, planes, clamps);
  return planes;
}

// One layer, encoded and decoded: each number within half a step of its target.
TEST(Published, OneLayerComesBackToHalfAStep) {
  Random random(61);
  double worst[4] = {};
  for (int i = 0; i < 5000; ++i) {
    const Fragment fragment = randomFragment(random);
    PublishedClamps clamps;
    const OitPlanes planes = folded({fragment}, clamps);
    ASSERT_EQ(clamps.total(), 0u);
    const glm::dvec3 o = static_cast<double>(fragment.coverage) * (1.0 - glm::dvec3(fragment.transmission));
    const double mean = (o.r + o.g + o.b) / 3;
    const double w = static_cast<double>(shading::layerWeight(kEq5Weight, fragment.z, static_cast<float>(mean)));
    for (int c = 0; c < 3; ++c) {
      const double a = w * static_cast<double>(fragment.radiance[c]);
      if (a > 1e-4) worst[0] = std::max(worst[0], std::abs(static_cast<double>(planes.radiance[0][c]) / a - 1));
      worst[1] = std::max(worst[1], std::abs(static_cast<double>(planes.depth[0][c]) - (1 - o[c])));
    }
    for (int c = 0; c < 2; ++c) {
      const double offset = mean * static_cast<double>(fragment.offset[c]);
      worst[2] = std::max(worst[2], std::abs(static_cast<double>(planes.refraction[0][c]) - offset));
    }
    // Spread below one step takes one: that it is not lost matters more.
    const double variance = std::max(static_cast<double>(fragment.variance), 63.0 * 63.0 / 255);
    worst[3] = std::max(worst[3], std::abs(static_cast<double>(planes.refraction[0].w) - variance));
  }
  std::printf("round trip, largest errors: A %.2g relative, beta %.2g, delta %.2g px, D2 %.2g px^2\n", worst[0],
              worst[1], worst[2], worst[3]);
  const double slack = 1.001;  // float arithmetic before the step is taken
  EXPECT_LE(worst[0], slack * 0x1p-11);
  EXPECT_LE(worst[1], slack * 0.5 / 255);
  EXPECT_LE(worst[2], slack * 0.5 * 63 / 127);
  EXPECT_LE(worst[3], slack * 0.5 * 63 * 63 / 255);
}

TEST(Published, TheLeastSpreadIsNotLost) {
  Fragment fragment{};
  fragment.coverage = 1.0f;
  fragment.transmission = glm::vec3(0.5f);
  fragment.z = 2.0f;
  fragment.variance = 1e-3f;
  PublishedClamps clamps;
  EXPECT_NEAR(folded({fragment}, clamps).refraction[0].w, 63.0f * 63.0f / 255.0f, 1e-3f);
}

Material plastic(glm::vec3 colour, float roughness, bool volume) {
  Material material;
  material.transmission = 0.8f;
  material.metallic = 0.0f;
  material.roughness = roughness;
  material.volume = volume;
  material.thickness = volume ? 0.1f : 0.0f;
  material.doubleSided = true;
  material.baseColor = glm::vec4(colour, 1.0f);
  return material;
}

// The driver blends 8 and 16 bit targets in its own arithmetic: a step per layer and target is what may differ.
TEST(Published, GlAndCpuAgreeToAStepALayer) {
  Stage stage(64, 48);
  stage.gbuffer.viewZ = Image<float>(64, 48, 12.0f);
  Random random(62);
  const int materials[] = {stage.add(plastic({0.9f, 0.3f, 0.2f}, 0.3f, true)),
                           stage.add(plastic({0.2f, 0.8f, 0.3f}, 0.5f, false)),
                           stage.add(unlitBlend({0.7f, 0.4f, 2.0f}, 0.4f))};
  for (int i = 0; i < 12; ++i) {
    const double x = random.between(0, 40), y = random.between(0, 30), z = random.between(1, 9);
    stage.slanted(x, y, x + random.between(10, 40), y + random.between(10, 30), z, z * 1.2, materials[i % 3]);
  }
  PassSettings settings;
  settings.weight = kEq5Weight;
  settings.surroundings = glm::vec3(0.4f);
  settings.tier = SumsTier::published;
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  const OitPlanes gl = pass.accumulate(settings);
  const PublishedClamps glClamps = pass.statistics().clamps;
  EXPECT_EQ(pass.statistics().bitsPerPixel, 112);
  OitPlanes cpu = emptyPublishedPlanes(stage.gbuffer.display, stage.gbuffer.data);
  PublishedClamps cpuClamps;
  std::vector<float> layers(64 * 48);
  pass.fragments(settings, [&](const FragmentLists& lists) {
    foldPublished(lists, settings.weight, cpu, cpuClamps);
    for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i)
      layers[static_cast<std::size_t>(lists.window.y0 * 64) + i] =
          static_cast<float>(lists.offsets[i + 1] - lists.offsets[i]);
  });
  ASSERT_TRUE(gl.scatters() && cpu.scatters());
  EXPECT_EQ(glClamps.written, cpuClamps.written);
  double worst[4] = {};
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const double n = std::max(1.0, static_cast<double>(layers[i]));
    ASSERT_EQ(gl.weight[i].a, cpu.weight[i].a) << i;
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<double>(gl.radiance[i][c]), b = static_cast<double>(cpu.radiance[i][c]);
      worst[0] = std::max(worst[0], std::abs(a - b) / std::max(b, 1e-4) * 0x1p10 / n);
      worst[1] = std::max(worst[1], 255 * std::abs(static_cast<double>(gl.depth[i][c] - cpu.depth[i][c])) / n);
    }
    for (int c = 0; c < 2; ++c)
      worst[2] = std::max(worst[2],
                          127.0 / 63 * std::abs(static_cast<double>(gl.refraction[i][c] - cpu.refraction[i][c])) / n);
    worst[3] =
        std::max(worst[3], 255.0 / 3969 * std::abs(static_cast<double>(gl.refraction[i].w - cpu.refraction[i].w)) / n);
  }
  std::printf("published, GL against CPU, steps a layer: A %.2f, beta %.2f, delta %.2f, D2 %.2f\n", worst[0], worst[1],
              worst[2], worst[3]);
  for (const double steps : worst) EXPECT_LE(steps, 1.0 + 1e-3);
}

TEST(Published, WithoutScatteringItTakes88Bits) {
  Stage stage(16, 16);
  stage.quad(0, 0, 16, 16, 3.0, stage.add(unlitBlend({0.7f, 0.4f, 0.2f}, 0.4f)));
  PassSettings settings;
  settings.tier = SumsTier::published;
  stage.accumulate(settings);
  EXPECT_EQ(stage.statistics.bitsPerPixel, 88);
  settings.scatter.prune = false;
  stage.accumulate(settings);
  EXPECT_EQ(stage.statistics.bitsPerPixel, 112);
}

// What does not fit is cut, counted, and never becomes infinite; the listing's rescue keeps a plausible colour.
TEST(Published, ClampsAreCountedAndFinite) {
  for (const bool onGl : {true, false}) {
    Stage stage(8, 8);
    stage.camera.focal = {200.0, 200.0};
    stage.gbuffer.viewZ = Image<float>(8, 8, 400.0f);
    Material lamp = unlitBlend({1e6f, 10.0f, 0.0f}, 0.9f);
    for (int i = 0; i < 3; ++i) stage.quad(0, 0, 8, 8, 0.2 + 0.01 * i, stage.add(lamp));
    stage.quad(0, 0, 8, 8, 0.15, stage.add(plastic({0.5f, 0.5f, 0.5f}, 1.0f, false)));
    stage.slanted(0, 0, 8, 8, 0.1, 0.6, stage.add(plastic({0.1f, 0.1f, 0.1f}, 0.0f, true)));
    PassSettings settings;
    settings.weight = kEq5Weight;
    settings.tier = SumsTier::published;
    settings.scatter.k0 = 100.0f;
    settings.scatter.refract = shading::PLD_REFRACT_FIXED;
    settings.scatter.refractDistance = 100.0f;
    GlContext context;
    TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
    OitPlanes planes = emptyPublishedPlanes(stage.gbuffer.display, stage.gbuffer.data);
    PublishedClamps clamps;
    if (onGl) {
      planes = pass.accumulate(settings);
      clamps = pass.statistics().clamps;
    } else {
      pass.fragments(settings,
                     [&](const FragmentLists& lists) { foldPublished(lists, settings.weight, planes, clamps); });
    }
    std::printf("%s: clamped %llu numbers; pixels: radiance %llu, diffusion %llu, refraction %llu\n",
                onGl ? "GL" : "CPU", static_cast<unsigned long long>(clamps.written),
                static_cast<unsigned long long>(clamps.radiance), static_cast<unsigned long long>(clamps.diffusion),
                static_cast<unsigned long long>(clamps.refraction));
    EXPECT_GE(clamps.written, 3 * 64u);
    EXPECT_EQ(clamps.radiance, 64u);
    EXPECT_EQ(clamps.diffusion, 64u);
    EXPECT_GT(clamps.refraction, 0u);
    const Veil veil = resolve(planes, {});
    for (std::size_t i = 0; i < veil.light.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(planes.radiance[i][c]) && std::isfinite(planes.weight[i][c]));
        ASSERT_TRUE(std::isfinite(veil.light[i][c]) && veil.light[i][c] >= 0.0f);
      }
  }
}

// The losses that README lists: the tier is the papers' picture, not a better one.
TEST(Published, LosesWhatItsLayoutLoses) {
  PublishedClamps clamps;
  Fragment flame{};
  flame.radiance = glm::vec3(3, 2, 1);
  flame.transmission = glm::vec3(1);
  flame.z = 4;
  EXPECT_EQ(resolve(folded({flame}, clamps), {}).light[0], glm::vec3(0));  // additive light without coverage

  Fragment glass = flame;
  glass.radiance = glm::vec3(0.2f);  // a highlight
  glass.coverage = 1.0f;
  glass.offset = glm::vec2(9, 4);
  const OitPlanes clear = folded({glass}, clamps);
  EXPECT_FALSE(clear.scatters() && clear.refraction[0].z > 0.0f);  // clear glass does not refract
  EXPECT_EQ(resolve(clear, {}).light[0], glm::vec3(0));            // and has no highlight

  Fragment thin{};
  thin.coverage = 0.001f;
  thin.z = 4;
  const OitPlanes smoke = folded(std::vector<Fragment>(1000, thin), clamps);
  EXPECT_EQ(smoke.depth[0].r, 1.0f);  // exp(-1) is right: each layer rounds to nothing in 8 bits
}

TEST(Published, PlanesComeBackFromTheirFileAndMerge) {
  Random random(63);
  FragmentLists lists;
  lists.window = {0, 0, 12, 9};
  lists.solid = Image<glm::vec4>(12, 9, glm::vec4(0, 0, 0, kSky));
  lists.offsets = {0};
  for (int pixel = 0; pixel < 12 * 9; ++pixel) {
    for (int i = 0; i < pixel % 4; ++i) lists.fragments.push_back(randomFragment(random));
    lists.offsets.push_back(lists.fragments.size());
  }
  OitPlanes planes = emptyPublishedPlanes(lists.window, lists.window);
  PublishedClamps clamps;
  foldPublished(lists, kEq5Weight, planes, clamps);
  const std::string path = freshFolder("published-planes") + "/planes.exr";
  writePlanes(path, planes);
  const OitPlanes back = readPlanes(path);
  EXPECT_TRUE(back.published());
  OitPlanes merged = emptyPublishedPlanes(lists.window, lists.window);
  merged.info = back.info;
  merged.camera = back.camera;
  mergePlanes(merged, back);
  for (const OitPlanes* other : {&back, static_cast<const OitPlanes*>(&merged)})
    for (std::size_t i = 0; i < planes.weight.size(); ++i) {
      EXPECT_EQ(planes.radiance[i], other->radiance[i]);
      EXPECT_EQ(planes.weight[i], other->weight[i]);
      EXPECT_EQ(glm::vec3(planes.depth[i]), glm::vec3(other->depth[i]));
      EXPECT_EQ(planes.refraction[i], other->refraction[i]);
      EXPECT_EQ(planes.diffuseZ[i], other->diffuseZ[i]);
    }
}

}  // namespace
}  // namespace pellucid::test
