// What the reference says of bent rays and of lamps is so narrow that numbers off by a part in a hundred are found.
#include <gtest/gtest.h>

#include <functional>

#include "tests/pictures/scene_finish.h"
#include "tests/pictures/trial.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

using Change = std::function<void(reference::PictureScene&)>;

class Telling : public ::testing::Test {
 protected:
  // A slab of glass before a striped wall, under a lamp, and a pane between the two.
  bool isRight(const Change& change) {
    Random random(7);
    SceneMaker maker("refracting", random, 5.0);
    maker.keepProportions();
    maker.look(32, 24, 0.4);
    reference::PictureScene& numbers = maker.scene().numbers;
    reference::Solid& wall = numbers.solids[static_cast<std::size_t>(maker.plane(maker.at(0, 0, 8.0), {0.1, 0.2, 1}))];
    wall.stripes = 0.8 * wall.colour;
    wall.across = glm::dmat3(maker.worldFromEye()) * Vec3(1.5, 0.7, 0.0);
    PlacedMesh& slab = maker.place(quadSheet(1.5, 1.2), maker.at(0, 0, 4.0), facing({0.3, -0.4, 1}, 0.2));
    slab.coat.glass = slab.coat.bothSides = slab.coat.finish.lit = true;
    slab.coat.colour = {0.9, 0.8, 0.7, 0.75};
    slab.coat.filling = {1.5, 0.5, 0.6, 2.0, {0.5, 0.7, 0.9}, true};
    slab.coat.finish.roughness = 0.5;
    PlacedMesh& pane = maker.place(quadSheet(2.0, 2.0), maker.at(0.1, 0.5, 5.0), facing({0, 0.2, 1}, 0.0));
    pane.coat.finish = {true, 0.4, 0.5, 1.0};
    pane.coat.colour = {0.3, 0.6, 0.9, 0.5};
    pane.coat.filling.index = 1.5;
    pane.coat.filling.mirrors = pane.coat.bothSides = true;
    reference::PunctualLamp lamp;
    lamp.at = Vec3(maker.worldFromEye() * Vec4(maker.at(0.3, 1.2, 3.0), 1.0));
    lamp.intensity = Vec3(8.0);
    numbers.lamps = {lamp};
    numbers.shadows = shadows_;
    numbers.bending.until = until_;
    DrawnFlags flags;
    flags.passes = 8;
    flags.words = {"--aa=8", "--environment=0,0,0", "--diffusion=off", "--occlusion=off"};
    if (until_ == reference::Bending::Until::slab) flags.words.emplace_back("--refract=thickness");
    if (shadows_) {
      numbers.solids.pop_back();
      flags.words.emplace_back("--shadows=exact");
    }
    DrawnScene scene = maker.finish();
    change(scene.numbers);
    const Outcome outcome = compositeAndJudge(scene, flags, freshFolder("pictures-telling"), kept_);
    EXPECT_EQ(outcome.refusal, "");
    return outcome.right();
  }

  reference::Bending::Until until_ = reference::Bending::Until::slab;
  bool shadows_ = false;
  std::shared_ptr<KeptWork> kept_ = std::make_shared<KeptWork>(-1);
};

TEST_F(Telling, BentRays) {
  for (const auto until : {reference::Bending::Until::slab, reference::Bending::Until::depth}) {
    until_ = until;
    EXPECT_TRUE(isRight([](reference::PictureScene&) {}));
    EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[0].coat.filling.index *= 1.01; }));
    EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[0].coat.filling.dispersion *= 1.2; }));
    EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[0].coat.filling.thickness *= 1.01; }));
    EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[0].coat.filling.clearness *= 1.01; }));
  }
}

TEST_F(Telling, Lamps) {
  EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[1].coat.colour.r *= 1.01; }));
  EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[0].coat.finish.roughness *= 1.01; }));
  EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[1].coat.finish.metal *= 1.01; }));
}

TEST_F(Telling, Shadows) {
  shadows_ = true;
  EXPECT_TRUE(isRight([](reference::PictureScene&) {}));
  EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.shadows = false; }));
  EXPECT_FALSE(isRight([](reference::PictureScene& scene) { scene.meshes[1].corners[0].at += Vec3(0.02); }));
}

}  // namespace
}  // namespace pellucid::test
