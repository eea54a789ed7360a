// One index per channel: offsets against the equations in double, through the GL pass, in files, in lookups.
#include <gtest/gtest.h>

#include <cstring>

#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/resolve.h"
#include "gbuffer/planes_io.h"
#include "tests/gl/builder.h"
#include "tests/scatter/backdrop.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

Material prism(float dispersion) {
  Material material;
  material.name = "prism";
  material.transmission = 1.0f;
  material.metallic = material.roughness = 0.0f;
  material.ior = 1.5f;
  material.dispersion = dispersion;
  material.volume = material.doubleSided = true;
  material.thickness = 0.1f;
  return material;
}

bool same(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
}

// KHR_materials_dispersion: n(lambda) about the ior of green, (n - 1) * 0.025 * dispersion to either side; 20 / Abbe.
TEST(Dispersion, IndicesAreThoseOfTheExtension) {
  const glm::vec3 eta = shading::dispersedEta(1.5f, 20.0f / 30.0f);
  EXPECT_NEAR(1 / eta.g, 1.5f, 1e-6f);
  EXPECT_NEAR(1 / eta.b - 1 / eta.r, (1.5f - 1.0f) / 30.0f, 1e-6f);  // the Abbe number's own definition
  EXPECT_EQ(shading::dispersedEta(1.5f, 0.0f), glm::vec3(1 / 1.5f));
  EXPECT_EQ(shading::dispersedEta(1.0f, 5.0f), glm::vec3(1.0f));
  const glm::vec3 extreme = shading::dispersedEta(1.1f, 1e4f);  // red would be below vacuum's
  EXPECT_EQ(extreme.r, 1.0f);
  EXPECT_GT(extreme.b, 0.0f);
}

// A tilted entering face through GL, each channel against double.
TEST(Dispersion, EveryChannelBendsAsInDouble) {
  Stage stage(64, 64);
  stage.gbuffer.viewZ = Image<float>(64, 64, 12.0f);
  stage.slanted(0, 0, 64, 64, 4.0, 5.0, stage.add(prism(1.2f)));
  const glm::dvec3 a(stage.at(0, 64, 4)), b(stage.at(64, 64, 5)), d(stage.at(0, 0, 4));
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, d - a));
  const double spread = 0.5 * 0.025 * 1.2, index[] = {1.5 - spread, 1.5, 1.5 + spread};
  double worst = 0, widest = 0;
  std::size_t seen = 0;
  for (const FragmentLists& lists : stage.fragments()) {
    ASSERT_TRUE(lists.disperses());
    for (int y = 0; y < lists.window.height(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel = static_cast<std::size_t>(y * lists.window.width() + x);
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i, ++seen) {
          const Fragment& fragment = lists.fragments[i];
          const glm::vec4 apart = lists.dispersion[i];
          const auto z = static_cast<double>(fragment.z);
          const glm::dvec3 p(stage.at(lists.window.x0 + x + 0.5, lists.window.y0 + y + 0.5, z));
          const glm::dvec2 found[] = {glm::dvec2(fragment.offset) + glm::dvec2(apart.x, apart.y),
                                      glm::dvec2(fragment.offset),
                                      glm::dvec2(fragment.offset) + glm::dvec2(apart.z, apart.w)};
          for (int c = 0; c < 3; ++c) {
            const glm::dvec3 ray = glm::refract(glm::normalize(p), normal, 1 / index[c]);
            const glm::dvec3 hit = p + ray * ((12.0 - z) / -ray.z);
            const glm::dvec2 truth = 64.0 * glm::dvec2(hit.x / -hit.z - p.x / -p.z, -(hit.y / -hit.z - p.y / -p.z));
            worst = std::max(worst, glm::length(found[c] - truth));
          }
          widest = std::max(widest, glm::length(found[2] - found[0]));
        }
      }
  }
  EXPECT_EQ(seen, 64u * 64u);
  std::printf("dispersion: red to blue up to %.2f px apart, largest error %.2g px\n", widest, worst);
  EXPECT_GT(widest, 0.2);
  EXPECT_LE(worst, 0.01);
}

// Sums of the pass, replayed lists, the CPU's folds and the file: one plane.
TEST(Dispersion, PlanesAreTheSameFromEveryVoice) {
  Stage stage(32, 24);
  stage.gbuffer.viewZ = Image<float>(32, 24, 12.0f);
  stage.slanted(2, 2, 28, 20, 4.0, 5.0, stage.add(prism(0.8f)));
  stage.slanted(8, 0, 30, 24, 6.0, 5.5, stage.add(prism(0.0f)));
  stage.quad(0, 0, 32, 24, 3.0, stage.add(unlitBlend(glm::vec3(0.5f), 0.3f)));
  const OitPlanes planes = stage.accumulate();
  ASSERT_TRUE(planes.disperses());
  EXPECT_EQ(planes.dispersion.at(0, 0), glm::vec4(0.0f));
  EXPECT_NE(planes.dispersion.at(16, 12), glm::vec4(0.0f));

  FragmentLists lists = stage.fragments()[0];
  OitPlanes folded = emptyPlanes(planes.display, planes.data), exact = folded;
  foldFragments(lists, planes.info.weight, planes.info.normalisation, folded);
  foldExact(lists, planes.info.weight, planes.info.normalisation, exact);
  GlContext context;
  const OitPlanes replayed = replayFragments(context, lists, planes.info.weight, planes.info.normalisation);
  EXPECT_TRUE(same(folded.dispersion, replayed.dispersion));
  EXPECT_TRUE(same(folded.refraction, replayed.refraction));
  for (std::size_t i = 0; i < exact.dispersion.size(); ++i)
    for (int c = 0; c < 4; ++c) {
      EXPECT_NEAR(exact.dispersion[i][c], planes.dispersion[i][c], 1e-6f);
      EXPECT_NEAR(exact.dispersion[i][c], folded.dispersion[i][c], 1e-6f);
    }

  const std::string path = freshFolder("dispersion-planes") + "/planes.exr";
  writePlanes(path, planes);
  OitPlanes back = readPlanes(path);
  EXPECT_TRUE(same(planes.dispersion, back.dispersion));
  mergePlanes(back, planes);
  EXPECT_EQ(back.dispersion.at(16, 12), 2.0f * planes.dispersion.at(16, 12));
}

TEST(Dispersion, NoneOrSwitchedOffNeedsNoPlane) {
  for (const bool off : {true, false}) {
    Stage stage(16, 16);
    stage.gbuffer.viewZ = Image<float>(16, 16, 12.0f);
    stage.slanted(0, 0, 16, 16, 4.0, 5.0, stage.add(prism(off ? 1.0f : 0.0f)));
    PassSettings settings;
    settings.scatter.dispersion = !off;
    const OitPlanes planes = stage.accumulate(settings);
    EXPECT_TRUE(planes.scatters());
    EXPECT_FALSE(planes.disperses());
    settings.scatter.prune = false;
    EXPECT_TRUE(same(stage.accumulate(settings).refraction, planes.refraction));
  }
}

// Colour is position: each channel says where it was looked up.
TEST(Dispersion, LookupsLandWhereEachChannelPoints) {
  Random random(41);
  ScatterScene scene(96, 64);
  addPlane(scene.planes, PlaneSum::dispersion);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      scene.backdrop.colour.at(x, y) = glm::vec4(glm::vec3(static_cast<float>(x) + 0.5f), 1);
      scene.refract(x, y, glm::vec2(48 - x, 32 - y) + 20.0f * glm::vec2(random.uniformf(), random.uniformf()));
      const float weight = 0.25f + random.uniformf();
      scene.planes.refraction.at(x, y) *= glm::vec4(weight, weight, weight, 1);
      scene.planes.light.at(x, y).a *= weight;
      scene.planes.dispersion.at(x, y) =
          weight * glm::vec4(-3 * random.uniformf(), 2 * random.uniformf(), 4 * random.uniformf(), random.uniformf());
    }
  const Image<glm::vec4> seen = scene.look(false);
  float worst = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const glm::vec4 sum = scene.planes.refraction.at(x, y), apart = scene.planes.dispersion.at(x, y) / sum.z;
      const float green = static_cast<float>(x) + 0.5f + sum.x / sum.z;
      const float truth[] = {green + apart.x, green, green + apart.z};
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(seen.at(x, y)[c] - truth[c]));
    }
  std::printf("dispersed lookups: largest error %.2g px\n", static_cast<double>(worst));
  EXPECT_LE(worst, 0.01f);
}

// A post in front shows in no channel, though only one of them lands on it.
TEST(Dispersion, PostInFrontShowsInNoChannel) {
  ScatterScene scene(64, 8, glm::vec4(0.2f, 0.2f, 0.2f, 1), 20.0f);
  addPlane(scene.planes, PlaneSum::dispersion);
  for (int y = 0; y < 8; ++y) {
    for (int x = 30; x < 34; ++x) scene.backdrop.colour.at(x, y) = glm::vec4(1), scene.backdrop.z.at(x, y) = 2.0f;
    for (int x = 0; x < 30; ++x) {
      scene.refract(x, y, glm::vec2(4.3f, 0.0f), 5.0f);
      scene.planes.dispersion.at(x, y) = glm::vec4(-6, 0, 9, 0);
    }
  }
  const Image<glm::vec4> seen = scene.look(false);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 30; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen.at(x, y)[c], 0.2f, 1e-6f) << x;
}

}  // namespace
}  // namespace pellucid::test
