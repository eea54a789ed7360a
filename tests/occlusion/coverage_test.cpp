// Solid insides and rims together against 64 rays per pixel: as much is covered, and no seam lies between the two. A
// single pixel of one sample is off by several times the mean: its edge is where the mip level puts it, by up to a
// texel of that level. The exact area of a half plane in place of the linear ramp does not help (.070 instead of .067).
// More samples read finer levels; at 64 of them what is left is the noise of the rays (.015).
#include <gtest/gtest.h>

#include "composite/antialias.h"
#include "tests/occlusion/leaf_stage.h"
#include "tests/occlusion/plants_scene.h"

namespace pellucid {
namespace {

using namespace test;

void holdCoverage(PlantScene scene, const std::vector<samples::Card>& cards, const Image<glm::vec4>& mask, int lines,
                  int cropLines, const char* name) {
  crop(scene.view, lines, cropLines);
  const Image<float> rays = scene.world->coverage(scene.view, 8);
  const LeafPicture picture = scene.world->picture(scene.view);  // for its windows and camera
  LeafStage stage(picture.display, picture.data, picture.camera);
  stage.addCards(cards, stage.addMask(mask));
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  for (const int samples : {1, 8, 64}) {
    VeilMean mean;
    for (int i = 0; i < samples; ++i) {
      PassSettings settings;
      settings.sample = samplePosition(i, samples);
      settings.footprint = 1.0f / std::sqrt(static_cast<float>(samples));
      mean.add(resolve(pass.accumulate(settings), {}));
    }
    const Veil veil = mean.finish();
    double sum = 0.0, bias = 0.0;
    std::size_t rims = 0, seams = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float drawn = veil.touched[i] ? shading::alphaOver(veil.transmission[i], 0.0f) : 0.0f;
      seams += drawn == 0.0f && rays[i] > 0.5f;
      if (!shading::isRim(drawn) && !shading::isRim(rays[i])) continue;
      ++rims;
      sum += std::abs(static_cast<double>(drawn - rays[i]));
      bias += static_cast<double>(drawn - rays[i]);
    }
    const auto count = static_cast<double>(rims);
    printf(
        "[ figure ] %s, %d lines, %d samples: %zu rim pixels cover %+.4f too much on average, single ones are off by "
        "%.4f; seams %zu\n",
        name, lines, samples, rims, bias / count, sum / count, seams);
    ASSERT_GT(rims, 200u);
    EXPECT_EQ(seams, 0u);
    EXPECT_LE(std::abs(bias / count), 0.02);
    EXPECT_LE(sum / count, samples == 1 ? 0.1 : samples == 8 ? 0.04 : 0.02);
  }
}

// Leaves that stand apart: where rims of several leaves share a pixel, coverages multiply as if they were unrelated.
std::vector<samples::Card> apart() {
  std::vector<samples::Card> cards;
  for (int i = 0; i < 12; ++i) {
    const double turn = 0.55 * i;
    const glm::dvec3 right(0.36 * std::cos(turn), 0.36 * std::sin(turn), 0.1 * std::sin(3.0 * i)),
        up = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), right)) * 0.45;
    const glm::dvec3 centre(-0.9 + 0.6 * (i % 4), 1.9 - 0.5 * (i / 4), 0.05 * i);
    cards.push_back({centre - 0.5 * (right + up), right, up});
  }
  return cards;
}

TEST(FoliageCoverage, SolidAndRimsCoverWhatRaysCover) {
  const Image<glm::vec4> mask = samples::leafMask(256);
  for (const int lines : {180, 540}) {
    PlantScene scene;
    scene.world = std::make_unique<LeafWorld>(std::vector<LeafWorld::Group>{{apart(), mask}});
    scene.view = treeScene().view;
    holdCoverage(std::move(scene), apart(), mask, lines, lines * 2 / 3, "leaves apart");
  }
  std::vector<samples::Card> pickets = samples::fence({-0.9, 0.0, 0.0}, 1.8, 1.1, 3, 0.05);
  pickets.resize(3);  // the front row
  // Leaning, so that edges meet pixels at every place: an upright one is off by the same amount in a whole column.
  for (samples::Card& card : pickets) {
    card.right += glm::dvec3(0.0, 0.08 * card.right.x, 0.0);
    card.up += glm::dvec3(-0.08 * card.up.y, 0.0, 0.0);
  }
  PlantScene scene = fenceScene();
  scene.world = std::make_unique<LeafWorld>(std::vector<LeafWorld::Group>{{pickets, samples::slatMask(512)}});
  holdCoverage(std::move(scene), pickets, samples::slatMask(512), 540, 270, "fence");
}

}  // namespace
}  // namespace pellucid
