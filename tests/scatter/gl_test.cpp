// Refraction and diffusion through the transparent pass, and its planes against the CPU's fold.
#include <gtest/gtest.h>

#include <cstring>

#include "composite/fold.h"
#include "composite/gather.h"
#include "composite/resolve.h"
#include "gbuffer/planes_io.h"
#include "tests/gl/builder.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

template <class T>
std::size_t differing(const Image<T>& a, const Image<T>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  return a.size() == 0 || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0 ? 0 : 1;
}

Material glassOf(float ior, float roughness, bool volume) {
  Material material;
  material.name = "glass";
  material.transmission = 1.0f;
  material.metallic = 0.0f;
  material.roughness = roughness;
  material.ior = ior;
  material.volume = volume;
  material.thickness = volume ? 0.1f : 0.0f;
  material.doubleSided = true;
  return material;
}

TEST(ScatterGl, ReplayedFragmentsGiveTheBitsOfTheFold) {
  Random random(21);
  FragmentLists lists;
  lists.window = {0, 0, 64, 64};
  lists.solid = Image<glm::vec4>(64, 64, glm::vec4(0, 0, 0, kSky));
  lists.offsets = {0};
  for (int pixel = 0; pixel < 64 * 64; ++pixel) {
    for (int i = 0; i < 16; ++i) {
      Fragment fragment{};
      fragment.radiance = glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
      fragment.coverage = random.uniformf();
      fragment.transmission =
          glm::vec3(random.uniformf(), random.uniformf(), random.below(3) ? random.uniformf() : 1.0f);
      fragment.z = 1.0f + 20.0f * random.uniformf();
      if (random.below(2)) fragment.offset = glm::vec2(200 * random.uniformf() - 100, 9 * random.uniformf());
      if (random.below(2)) fragment.variance = 400.0f * random.uniformf();
      lists.fragments.push_back(fragment);
    }
    lists.offsets.push_back(lists.fragments.size());
  }
  const shading::WeightSettings weight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};
  GlContext context;
  const OitPlanes gl = replayFragments(context, lists, weight, shading::PLD_NORMALISE_SPECTRAL);
  OitPlanes cpu = emptyPlanes(lists.window, lists.window);
  foldFragments(lists, weight, shading::PLD_NORMALISE_SPECTRAL, cpu);
  ASSERT_TRUE(gl.scatters());
  ASSERT_TRUE(cpu.scatters());
  EXPECT_EQ(differing(gl.refraction, cpu.refraction), 0u);
  EXPECT_EQ(differing(gl.diffuseZ, cpu.diffuseZ), 0u);
  EXPECT_EQ(differing(gl.light, cpu.light), 0u);
  EXPECT_EQ(differing(gl.radiance, cpu.radiance), 0u);
}

TEST(ScatterGl, FrostedPaneHasTheSpreadOfTheEquation) {
  Stage stage(64, 64);
  stage.gbuffer.viewZ = Image<float>(64, 64, 9.0f);
  Material material = glassOf(1.5f, 0.6f, false);
  stage.quad(0, 0, 64, 64, 4.0, stage.add(material));
  const OitPlanes planes = stage.accumulate();
  ASSERT_TRUE(planes.scatters());
  const double focal = 2.0 * 32, c = 1 - 0.6 * 0.6;
  const double s = focal * 0.3 * (1 - c) * (1 - 1 / (1 + 5.0 / 0.5)) / 4.0;
  // Interpolated depth and roughness in float: 1e-5 of the value each.
  EXPECT_NEAR(static_cast<double>(planes.refraction.at(20, 30).w), s * s, 1e-4 * s * s);
  EXPECT_NEAR(planes.diffuseZ.at(20, 30), 4.0f, 1e-4f);
  EXPECT_EQ(planes.refraction.at(20, 30).z, 0.0f);
}

TEST(ScatterGl, RoughFacetsOfIndexOneSpreadNothing) {
  Stage stage(32, 32);
  stage.gbuffer.viewZ = Image<float>(32, 32, 9.0f);
  stage.quad(0, 0, 32, 32, 4.0, stage.add(glassOf(1.0f, 0.6f, false)));
  EXPECT_FALSE(stage.accumulate().scatters());
  stage.scene.materials[0].ior = 1.25f;  // half of the roughness
  const double s = 32.0 * 0.3 * 0.09 * (1 - 1 / (1 + 5.0 / 0.5)) / 4.0;
  EXPECT_NEAR(static_cast<double>(stage.accumulate().refraction.at(9, 9).w), s * s, 1e-3 * s * s);
}

TEST(ScatterGl, SolidBehindThePaneIsTheBackgroundThatItSpreads) {
  Stage stage(32, 32);
  stage.gbuffer.viewZ = Image<float>(32, 32, 9.0f);
  stage.quad(0, 0, 32, 32, 4.0, stage.add(glassOf(1.5f, 0.6f, false)));
  stage.quad(0, 0, 32, 32, 4.5, stage.add(unlitBlend(glm::vec3(1), 1.0f)));
  const OitPlanes planes = stage.accumulate();
  const double s = 32.0 * 0.3 * 0.36 * (1 - 1 / (1 + 0.5 / 0.5)) / 4.0;
  EXPECT_NEAR(static_cast<double>(planes.refraction.at(9, 9).w), s * s, 1e-3 * s * s);
}

TEST(ScatterGl, TiltedFaceRefractsAsInDouble) {
  Stage stage(64, 64);
  stage.gbuffer.viewZ = Image<float>(64, 64, 12.0f);
  stage.slanted(0, 0, 64, 64, 4.0, 5.0, stage.add(glassOf(1.5f, 0.0f, true)));
  for (const int mode : {shading::PLD_REFRACT_FIXED, shading::PLD_REFRACT_DEPTH}) {
    PassSettings settings;
    settings.scatter.refract = mode;
    const std::vector<FragmentLists> tiles = stage.fragments(settings);
    const glm::dvec3 a(stage.at(0, 64, 4)), b(stage.at(64, 64, 5)), d(stage.at(0, 0, 4));
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, d - a));
    double worst = 0;
    std::size_t seen = 0;
    for (const FragmentLists& lists : tiles)
      for (int y = 0; y < lists.window.height(); ++y)
        for (int x = 0; x < lists.window.width(); ++x) {
          const auto pixel = static_cast<std::size_t>(y * lists.window.width() + x);
          for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i, ++seen) {
            const Fragment& fragment = lists.fragments[i];
            const auto z = static_cast<double>(fragment.z);
            const glm::dvec3 p(stage.at(lists.window.x0 + x + 0.5, lists.window.y0 + y + 0.5, z));
            const glm::dvec3 toEye = -glm::normalize(p);
            const glm::dvec3 ray = glm::refract(-toEye, normal, 1 / 1.5);
            const double dz = mode == shading::PLD_REFRACT_FIXED ? 2.0 : 12.0 - z;
            const glm::dvec3 hit = p + ray * (dz / -ray.z);
            const glm::dvec2 truth = 64.0 * glm::dvec2(hit.x / -hit.z - p.x / -p.z, -(hit.y / -hit.z - p.y / -p.z));
            worst = std::max(worst, glm::length(glm::dvec2(fragment.offset) - truth));
          }
        }
    EXPECT_EQ(seen, 64u * 64u);
    std::printf("tilted face through GL: largest error of delta %.2g px\n", worst);
    EXPECT_LE(worst, 0.01);
  }
}

TEST(ScatterGl, BackFacesAndThinWallsDoNotRefract) {
  for (const bool back : {true, false}) {
    Stage stage(16, 16);
    stage.gbuffer.viewZ = Image<float>(16, 16, 12.0f);
    Material material = glassOf(1.5f, 0.0f, true);
    if (!back) material.thin = true;
    Instance& quad = stage.slanted(0, 0, 16, 16, 4.0, 5.0, stage.add(material));
    if (back)
      for (auto& primitive : stage.scene.primitives)
        std::swap(primitive.indices[1], primitive.indices[2]), std::swap(primitive.indices[4], primitive.indices[5]);
    (void)quad;
    const OitPlanes planes = stage.accumulate();
    EXPECT_EQ(planes.scatters(), back);  // thin glass needs no such plane at all
    if (back) {
      EXPECT_EQ(planes.refraction.at(8, 8), glm::vec4(0.0f));
      EXPECT_GT(planes.weight.at(8, 8).a, 0.0f);
    }
  }
}

// A ball before a far plane whose colour is its place: what it shows lies on the other side, up for down, left for
// right.
TEST(ScatterGl, BallInvertsItsBackground) {
  constexpr int kSize = 96;
  Stage stage(kSize, kSize);
  stage.gbuffer.viewZ = Image<float>(kSize, kSize, 6.0f);
  stage.gbuffer.beauty = Image<glm::vec4>(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      stage.gbuffer.beauty.at(x, y) = glm::vec4(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 1);
  Primitive sphere;
  sphere.material = stage.add(glassOf(1.5f, 0.0f, true));
  constexpr int kRings = 48, kSegments = 96;
  constexpr double kRadius = 0.5, kZ = 3.0;
  for (int j = 0; j <= kRings; ++j)
    for (int i = 0; i <= kSegments; ++i) {
      const double polar = glm::pi<double>() * j / kRings, around = 2 * glm::pi<double>() * i / kSegments;
      Vertex vertex{};
      vertex.normal =
          glm::vec3(std::sin(polar) * std::cos(around), std::cos(polar), -std::sin(polar) * std::sin(around));
      vertex.position = static_cast<float>(kRadius) * vertex.normal - glm::vec3(0, 0, kZ);
      vertex.colour = glm::vec4(1.0f);
      sphere.vertices.push_back(vertex);
    }
  for (std::uint32_t j = 0; j < kRings; ++j)
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const std::uint32_t a = j * (kSegments + 1) + i, b = a + kSegments + 1;
      for (const std::uint32_t index : {a, b, a + 1, a + 1, b, b + 1}) sphere.indices.push_back(index);
    }
  stage.place(std::move(sphere));
  const OitPlanes planes = stage.accumulate();
  const Backdrop backdrop = backdropOf(stage.gbuffer, planes.solid);
  const Lookups lookups(backdrop, planes, {});
  const auto middle = static_cast<float>(kSize) / 2;
  int inverted = 0;
  for (const int step : {-10, -7, -4, 4, 7, 10}) {
    const int at = kSize / 2 + step;
    ASSERT_TRUE(lookups.scattersAt(at, kSize / 2)) << at;
    const float across = lookups.at(at, kSize / 2).r - middle, down = lookups.at(kSize / 2, at).g - middle;
    EXPECT_LT(across * static_cast<float>(step), 0.0f) << step;
    EXPECT_LT(down * static_cast<float>(step), 0.0f) << step;
    EXPECT_NEAR(across, down, 0.6f) << step;
    inverted += across * static_cast<float>(step) < 0;
  }
  EXPECT_EQ(inverted, 6);
}

TEST(ScatterGl, PruningChangesNoBit) {
  Stage stage(48, 48);
  stage.gbuffer.viewZ = Image<float>(48, 48, 12.0f);
  stage.slanted(4, 4, 40, 44, 4.0, 5.0, stage.add(glassOf(1.5f, 0.4f, true)));
  stage.quad(10, 0, 30, 48, 3.0, stage.add(unlitBlend(glm::vec3(0.3f, 0.5f, 0.7f), 0.4f)));
  stage.quad(0, 20, 48, 30, 7.0, stage.add(glassOf(1.5f, 0.0f, false)));
  PassSettings all;
  all.scatter.prune = false;
  const OitPlanes pruned = stage.accumulate();
  const PassStatistics before = stage.statistics;
  const OitPlanes full = stage.accumulate(all);
  EXPECT_LT(before.bitsPerPixel, stage.statistics.bitsPerPixel);
  EXPECT_FALSE(before.pruned.empty());
  EXPECT_EQ(differing(pruned.refraction, full.refraction), 0u);
  EXPECT_EQ(differing(pruned.diffuseZ, full.diffuseZ), 0u);
  EXPECT_EQ(differing(pruned.radiance, full.radiance), 0u);
  EXPECT_EQ(differing(pruned.weight, full.weight), 0u);
  EXPECT_EQ(differing(pruned.opacity, full.opacity), 0u);
  EXPECT_EQ(differing(pruned.depth, full.depth), 0u);
  EXPECT_EQ(differing(pruned.light, full.light), 0u);
}

TEST(ScatterGl, PlanesComeBackFromTheirFile) {
  Stage stage(24, 16);
  stage.gbuffer.viewZ = Image<float>(24, 16, 12.0f);
  stage.slanted(2, 2, 20, 14, 4.0, 5.0, stage.add(glassOf(1.5f, 0.4f, true)));
  const OitPlanes planes = stage.accumulate();
  const std::string path = freshFolder("scatter-planes") + "/planes.exr";
  writePlanes(path, planes);
  const OitPlanes back = readPlanes(path);
  EXPECT_EQ(differing(planes.refraction, back.refraction), 0u);
  EXPECT_EQ(differing(planes.diffuseZ, back.diffuseZ), 0u);
  EXPECT_EQ(differing(planes.light, back.light), 0u);
  // Half the layers in each file: the merge is the sum.
  OitPlanes merged = emptyPlanes(planes.display, planes.data);
  merged.info = planes.info;
  merged.camera = planes.camera;
  mergePlanes(merged, back);
  EXPECT_EQ(differing(planes.refraction, merged.refraction), 0u);
  EXPECT_EQ(differing(planes.diffuseZ, merged.diffuseZ), 0u);
}

}  // namespace
}  // namespace pellucid::test
