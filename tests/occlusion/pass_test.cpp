// Occlusion inferred inside the transparent pass.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "composite/fold.h"
#include "composite/occlusion.h"
#include "composite/picture_occluders.h"
#include "engine_bridge/gl/permutation.h"
#include "tests/occlusion/leaf_stage.h"
#include "tests/occlusion/plants_scene.h"

namespace pellucid {
namespace {

using namespace test;

constexpr float kOpenSky = std::numeric_limits<float>::infinity();

template <class T>
bool sameBits(const Image<T>& a, const Image<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool sameBits(const OitPlanes& a, const OitPlanes& b) {
  return sameBits(a.radiance, b.radiance) && sameBits(a.weight, b.weight) && sameBits(a.opacity, b.opacity) &&
         sameBits(a.depth, b.depth) && sameBits(a.light, b.light) && sameBits(a.frontZ, b.frontZ) &&
         sameBits(a.solid, b.solid) && a.refraction.size() == b.refraction.size();
}

// Leaves beside each other, turned every way, none before another, with lamp and surroundings.
LeafStage spreadLeaves() {
  const Window window{0, 0, 240, 160};
  Camera camera;
  camera.focal = {2.0 * 160 / 240, 2.0};
  LeafStage stage(window, window, camera);
  std::vector<samples::Card> cards;
  for (int i = 0; i < 15; ++i) {
    const double turn = 0.7 * i, lean = 0.5 * std::sin(2.1 * i);
    const glm::dvec3 right(0.5 * std::cos(turn), 0.5 * std::sin(turn), lean * 0.2),
        up(-0.6 * std::sin(turn), 0.6 * std::cos(turn), 0.0);
    const glm::dvec3 centre(-1.3 + 0.65 * (i % 5), 0.75 - 0.75 * (i / 5), -3.0 - 0.05 * i);
    cards.push_back({centre - 0.5 * (right + up), right, up});
  }
  stage.addCards(cards, stage.addMask(samples::leafMask(128)));
  Light lamp;
  lamp.kind = LightKind::directional;
  lamp.intensity = 1.5f;
  lamp.direction = glm::normalize(glm::dvec3(0.3, -0.4, -1.0));
  stage.scene.lights.push_back(lamp);
  return stage;
}

PassSettings lit() {
  PassSettings settings;
  settings.surroundings = {0.8f, 0.9f, 1.1f};
  return settings;
}

// Leaves in the G-buffer, with occlusion that changes from pixel to pixel.
void putLeavesIntoGBuffer(LeafStage& stage, const Image<float>& solidZ) {
  stage.gbuffer.occlusion = Image<float>(solidZ.width(), solidZ.height(), 1.0f);
  for (int y = 0; y < solidZ.height(); ++y)
    for (int x = 0; x < solidZ.width(); ++x) {
      stage.gbuffer.viewZ.at(x, y) = std::isfinite(solidZ.at(x, y)) ? solidZ.at(x, y) : 6.0f;
      stage.gbuffer.occlusion.at(x, y) =
          0.5f + 0.4f * std::sin(0.21f * static_cast<float>(x)) * std::cos(0.17f * static_cast<float>(y));
    }
}

struct Leaves {
  LeafStage stage;
  PassSettings settings;
};

Leaves leavesWithOcclusion() {
  Leaves leaves{spreadLeaves(), lit()};
  {
    GlContext context;
    TransparentPass pass(context, leaves.stage.scene, leaves.stage.gbuffer, leaves.stage.camera);
    EXPECT_TRUE(pass.wantsOccluders(leaves.settings));
    putLeavesIntoGBuffer(leaves.stage, pass.solidDepth(leaves.settings));
  }
  OccluderPlanes planes{leaves.stage.gbuffer.data, leaves.stage.gbuffer.viewZ, leaves.stage.gbuffer.occlusion};
  leaves.settings.occlusion.occluders = std::make_shared<OccluderPlanes>(std::move(planes));
  return leaves;
}

// What a renderer leaves of the leaves: solid insides occluded, rims open.
TEST(OcclusionPass, StandaloneStepOnALayerEqualsThePass) {
  for (const float directShare : {0.0f, 0.5f}) {
    Leaves leaves = leavesWithOcclusion();
    leaves.settings.occlusion.directShare = directShare;
    PassSettings open = leaves.settings;
    open.occlusion.rims = false;
    const Veil inferred = leaves.stage.veil(leaves.settings);
    const OitPlanes planes = leaves.stage.accumulate(open);
    const Veil layer = resolve(planes, {});
    LeafStage dark = leaves.stage;
    dark.scene.lights.clear();
    const Veil ambient = dark.veil(open);

    FoliagePlanes foliage;
    foliage.data = leaves.stage.gbuffer.data;
    foliage.viewZ = layer.frontZ;
    foliage.coverage = Image<float>(layer.frontZ.width(), layer.frontZ.height());
    Image<glm::vec4> beauty(layer.frontZ.width(), layer.frontZ.height());
    for (std::size_t i = 0; i < beauty.size(); ++i) {
      foliage.coverage[i] = layer.touched[i] ? shading::alphaOver(layer.transmission[i], 0.0f) : 0.0f;
      beauty[i] = glm::vec4(layer.light[i], foliage.coverage[i]);
    }
    const Image<float> occlusion =
        inferOcclusion(foliage, *leaves.settings.occlusion.occluders, shading::PLD_OCCLUSION_RELATIVE).occlusion;
    Image<std::uint8_t> touched;
    applyOcclusion(occlusion, ambient.light, directShare, beauty, touched);

    std::size_t rims = 0, solids = 0, changed = 0;
    float most = 0.0f, darkest = 1.0f;
    for (std::size_t i = 0; i < beauty.size(); ++i) {
      const glm::vec3 step(beauty[i]), pass = inferred.light[i], before = layer.light[i];
      if (!shading::isRim(foliage.coverage[i])) {
        solids += foliage.coverage[i] == 1.0f;
        EXPECT_EQ(step, before);
        EXPECT_EQ(pass, before);
        continue;
      }
      ++rims;
      darkest = std::min(darkest, occlusion[i]);
      changed += pass != before;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(step[c] - pass[c]));
    }
    printf("[ figure ] direct share %.1f: %zu rims, %zu solids: standalone step and pass differ by at most %.2g\n",
           static_cast<double>(directShare), rims, solids, static_cast<double>(most));
    ASSERT_GT(rims, 800u);
    ASSERT_GT(solids, 3000u);
    EXPECT_GT(changed, rims * 9 / 10);
    EXPECT_LT(darkest, 0.3f);
    EXPECT_LE(most, 2e-3f);
  }
}

TEST(OcclusionPass, SumsAndListsInferTheSame) {
  const Leaves leaves = leavesWithOcclusion();
  const OitPlanes sums = leaves.stage.accumulate(leaves.settings);
  GlContext context;
  TransparentPass pass(context, leaves.stage.scene, leaves.stage.gbuffer, leaves.stage.camera);
  OitPlanes folded = emptyPlanes(sums.display, sums.data);
  pass.fragments(leaves.settings, [&](const FragmentLists& lists) {
    foldFragments(lists, leaves.settings.weight, leaves.settings.normalisation, folded);
  });
  float most = 0.0f;
  for (std::size_t i = 0; i < sums.radiance.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      most = std::max(most, std::abs(sums.radiance[i][c] - folded.radiance[i][c]));
      most = std::max(most, std::abs(sums.solid[i][c] - folded.solid[i][c]));
    }
  EXPECT_LE(most, 1e-5f);
}

// Leaves that the G-buffer lacks: their insides are as occluded as their own depth says, and rims follow.
TEST(OcclusionPass, LeavesThatTheGBufferLacksAreOccludedByTheirOwnDepth) {
  LeafStage stage = spreadLeaves();
  PassSettings settings = lit();
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  const NearestSolids solids = nearestSolids(stage.gbuffer, pass.solidDepth(settings));
  ASSERT_GT(solids.lacked, 3000u);
  std::size_t pixels = 0;
  OccluderPlanes planes = occludersOf(stage.gbuffer, stage.camera, solids, {}, nullptr, pixels);
  EXPECT_EQ(pixels, solids.lacked);
  for (std::size_t i = 0; i < planes.occlusion.size(); ++i)
    if (solids.lacking[i]) planes.occlusion[i] = 0.25f;
  const OitPlanes before = pass.accumulate(settings);
  settings.occlusion.occluders = std::make_shared<OccluderPlanes>(planes);
  const OitPlanes after = pass.accumulate(settings);
  stage.scene.lights.clear();
  TransparentPass unlit(context, stage.scene, stage.gbuffer, stage.camera);
  settings.occlusion.occluders = nullptr;
  const OitPlanes ambient = unlit.accumulate(settings);
  for (std::size_t i = 0; i < before.solid.size(); ++i) {
    if (!std::isfinite(before.solid[i].a)) continue;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(after.solid[i][c], before.solid[i][c] - 0.75f * ambient.solid[i][c], 1e-5f);
  }
}

// Away from pixel centres the planes are read where the same leaf lies.
TEST(OcclusionPass, JitteredSamplesKeepTheOcclusionOfTheirLeaf) {
  Leaves leaves = leavesWithOcclusion();
  leaves.stage.scene.lights.clear();
  auto planes = std::make_shared<OccluderPlanes>(*leaves.settings.occlusion.occluders);
  for (std::size_t i = 0; i < planes->occlusion.size(); ++i)
    planes->occlusion[i] = planes->viewZ[i] < 5.0f ? 0.25f : 1.0f;
  PassSettings open = leaves.settings;
  open.occlusion.occluders = nullptr;
  leaves.settings.occlusion.occluders = planes;
  leaves.settings.sample = open.sample = {0.06, 0.91};
  const Veil bright = leaves.stage.veil(open), dark = leaves.stage.veil(leaves.settings);
  std::size_t count = 0, off = 0;
  for (std::size_t i = 0; i < bright.light.size(); ++i) {
    if (!bright.touched[i] || shading::alphaOver(bright.transmission[i], 0.0f) < 0.02f) continue;
    ++count;
    off += std::abs(dark.light[i].g / bright.light[i].g - 0.25f) > 0.05f;
  }
  printf("[ figure ] sample (.06, .91): %zu of %zu pixels see another occlusion than their leaf's\n", off, count);
  ASSERT_GT(count, 3000u);
  EXPECT_LE(off, count / 50);
}

// The truth tests measure a model of the pass: GL infers the same.
TEST(OcclusionPass, GlInfersWhatTheTruthTestsMeasure) {
  PlantScene plants = treeScene();
  crop(plants.view, 540, 216);
  const LeafPicture picture = plants.world->picture(plants.view);
  const OccluderPlanes occluders = tracedOccluders(plants, picture, 16);
  LeafStage stage(picture.display, picture.data, picture.camera);
  stage.addCards(samples::crown({0.0, 1.5, 0.0}, 0.75, 650, 0.2, 7), stage.addMask(samples::leafMask(256)));
  PassSettings settings;
  settings.surroundings = glm::vec3(1.0f);
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  const auto nearest = [&](const PassSettings& how) {
    Image<glm::vec3> front(occluders.viewZ.width(), occluders.viewZ.height(), glm::vec3(0, 0, kOpenSky));
    pass.fragments(how, [&](const FragmentLists& lists) {
      for (int y = lists.window.y0; y < lists.window.y1; ++y)
        for (int x = lists.window.x0; x < lists.window.x1; ++x) {
          const auto pixel =
              static_cast<std::size_t>(y - lists.window.y0) * static_cast<std::size_t>(lists.window.width()) +
              static_cast<std::size_t>(x - lists.window.x0);
          glm::vec3& here = front.at(x - picture.data.x0, y - picture.data.y0);
          for (std::uint64_t k = lists.offsets[pixel]; k < lists.offsets[pixel + 1]; ++k) {
            const Fragment& fragment = lists.fragments[k];
            if (fragment.z < here.z) here = {fragment.radiance.g, fragment.coverage, fragment.z};
          }
        }
    });
    return front;
  };
  const Image<glm::vec3> open = nearest(settings);
  settings.occlusion.occluders = std::make_shared<OccluderPlanes>(occluders);
  const Image<glm::vec3> inferred = nearest(settings);
  double sum = 0.0, none = 0.0;
  std::size_t count = 0;
  for (int y = 0; y < open.height(); ++y)
    for (int x = 0; x < open.width(); ++x) {
      if (!shading::isRim(open.at(x, y).y) || !shading::isRim(picture.rims.coverage.at(x, y))) continue;
      if (std::abs(open.at(x, y).z - picture.rims.viewZ.at(x, y)) > 1e-3f) continue;
      const double modelled =
          static_cast<double>(inferredInPass(picture, occluders, x, y, shading::PLD_OCCLUSION_RELATIVE));
      const double drawn = static_cast<double>(inferred.at(x, y).x / open.at(x, y).x);
      sum += std::abs(drawn - modelled);
      none += 1.0 - modelled;
      ++count;
    }
  const double mean = sum / static_cast<double>(count), occluded = none / static_cast<double>(count);
  printf("[ figure ] %zu rims: GL and the model of it differ by mean %.4f (mean occlusion %.3f)\n", count, mean,
         occluded);
  ASSERT_GT(count, 2000u);
  ASSERT_GT(occluded, 0.2);
  // Their texture filters differ: where the gradient is small it turns, and with it the line of taps.
  EXPECT_LE(mean, 0.02);
}

TEST(OcclusionPass, NothingAtAllWithoutCutOutMaterials) {
  LeafStage stage = spreadLeaves();
  Material& material = stage.scene.materials[0];
  for (const bool smoke : {false, true}) {
    // Unlit leaves, then a soft texture that is blended.
    material.unlit = !smoke;
    if (smoke) {
      material.alphaMode = AlphaMode::blend;
      Image<glm::vec4>& texels = stage.scene.textures[0].texels;
      for (std::size_t i = 0; i < texels.size(); ++i) texels[i].a = 0.4f + 0.1f * texels[i].a;
    }
    GlContext context;
    TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
    PassSettings settings = lit();
    EXPECT_FALSE(pass.wantsOccluders(settings));
    const OitPlanes without = pass.accumulate(settings);
    const PassStatistics before = pass.statistics();
    settings.occlusion.occluders = std::make_shared<OccluderPlanes>(
        OccluderPlanes{stage.gbuffer.data, Image<float>(240, 160, 3.0f), Image<float>(240, 160, 0.1f)});
    const OitPlanes with = pass.accumulate(settings);
    EXPECT_TRUE(sameBits(without, with));
    EXPECT_EQ(pass.statistics().bitsPerPixel, before.bitsPerPixel);
    EXPECT_EQ(pass.statistics().passes, before.passes);
    gl::FrameFeatures frame;
    frame.lights = frame.surroundings = true;
    gl::FrameFeatures occluding = frame;
    occluding.occludes = true;
    occluding.rimForm = shading::PLD_OCCLUSION_RELATIVE;
    EXPECT_EQ(gl::surfaceDefines(material, false, frame), gl::surfaceDefines(material, false, occluding, false));
  }
}

// Leaves as open as can be look as if nothing were inferred, to the bit.
TEST(OcclusionPass, OpenNeighboursChangeNoBit) {
  Leaves leaves = leavesWithOcclusion();
  auto planes = std::make_shared<OccluderPlanes>(*leaves.settings.occlusion.occluders);
  std::fill(planes->occlusion.data(), planes->occlusion.data() + planes->occlusion.size(), 1.0f);
  leaves.settings.occlusion.occluders = planes;
  PassSettings off = leaves.settings;
  off.occlusion.occluders = nullptr;
  EXPECT_TRUE(sameBits(leaves.stage.accumulate(leaves.settings), leaves.stage.accumulate(off)));
}

}  // namespace
}  // namespace pellucid
