// WB13 beyond its equations: listings 3 and 4, the monochrome packing, moving a scene in depth, one pass per system.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "composite/methods/method.h"
#include "tests/support/exr_shots.h"
#include "tests/support/layers.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"
#include "tests/truth/sets.h"

namespace pellucid {
namespace {

using namespace test;

Veil veilOf(const std::string& name, const FragmentLists& lists, const shading::WeightSettings& weight) {
  Veil veil(lists.window.width(), 1);
  compositeBy(*chooseMethod(name), {0, weight, shading::PLD_NORMALISE_SPECTRAL}, lists, lists.window, veil);
  return veil;
}

glm::vec3 overGrey(const Veil& veil, std::size_t i) {
  return veil.light[i] + .5f * veil.transmission[i];
}

double largest(const Veil& a, const Veil& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.light.size(); ++i)
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, static_cast<double>(std::abs(overGrey(a, i)[c] - overGrey(b, i)[c])));
  return worst;
}

double rms(const Veil& a, const Veil& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.light.size(); ++i) {
    const glm::dvec3 d(overGrey(a, i) - overGrey(b, i));
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.light.size())));
}

FragmentLists grey(FragmentLists lists) {
  for (Fragment& fragment : lists.fragments) fragment.radiance = glm::vec3(fragment.radiance.g);
  return lists;
}

const shading::WeightSettings kWb13Eq9 = weightOf(shading::PLD_WEIGHT_EQ9);

TEST(Listings, AllThreeLayoutsHoldTheSamePicture) {
  for (const char set : {'A', 'B', 'D', 'E'}) {
    const FragmentLists lists = listsOfSet(set, 400, false, 500), mono = grey(lists);
    EXPECT_EQ(largest(veilOf("listing3", lists, kWb13Eq9), veilOf("listing4", lists, kWb13Eq9)), 0.0);
    EXPECT_EQ(largest(veilOf("listing4", mono, kWb13Eq9), veilOf("monochrome", mono, kWb13Eq9)), 0.0);
    EXPECT_GT(largest(veilOf("listing4", lists, kWb13Eq9), veilOf("monochrome", lists, kWb13Eq9)),
              .05);  // colour is lost
    const double halves = largest(veilOf("listing3", lists, kWb13Eq9), veilOf("weighted", lists, kWb13Eq9));
    std::printf("[ figure ] set %c: listing 3 in half floats against float sums: largest %.4f\n", set, halves);
    EXPECT_LT(halves, .01);  // a few roundings of 2^-11
  }
}

// The clamp of listing 3: thin sums do not blow up, large ones stay finite.
TEST(Listings, ClampKeepsThinAndLargeSums) {
  EXPECT_EQ(listingColour(glm::vec3(1e-7f), 1e-7f), glm::vec3(1e-3f));  // 1e-7 / 1e-4
  EXPECT_EQ(listingColour(glm::vec3(2e-4f), 2e-4f), glm::vec3(1.0f));
  EXPECT_EQ(listingColour(glm::vec3(3e4f), 3e4f), glm::vec3(1.0f));
  EXPECT_EQ(listingColour(glm::vec3(5e4f), 1e30f), glm::vec3(1.0f));
  EXPECT_EQ(listingColour(glm::vec3(0.0f), 0.0f), glm::vec3(0.0f));
  // Forty near layers at the largest weight: their sums leave the range of halves.
  std::vector<Fragment> near(40);
  for (Fragment& fragment : near) {
    fragment.coverage = .9f;
    fragment.radiance = glm::vec3(.9f * .5f);
    fragment.z = .2f;
  }
  const shading::WeightSettings strong = weightOf(shading::PLD_WEIGHT_EQ7Z);
  for (const char* name : {"listing3", "listing4", "monochrome"}) {
    const Veil veil = veilOf(name, listsOf({near}), strong);
    std::printf("[ figure ] %s, sums of 1e5 in half floats: colour %.4f of .5\n", name,
                static_cast<double>(veil.light[0].g));
    EXPECT_TRUE(std::isfinite(veil.light[0].g));
    EXPECT_NEAR(veil.light[0].g, .5f * 1e5f / 5e4f, .35f);  // saturated, not black and not infinite
  }
}

// WB13 section 3.4.1: blended does not care where the scene is; weights do, and far away they approach it.
TEST(Weights, TranslationOfTheWholeSceneInDepth) {
  const FragmentLists lists = listsOfSet('A', 300, false, 43);
  std::printf("[ figure ] scene moved by 0, 10, 100, 1000, 10000 m: change, distance to blended (RMSE x 1000)\n");
  const Veil blended = veilOf("blended", lists, kWb13Eq9);
  const std::pair<const char*, shading::WeightSettings> weights[] = {
      {"eq7z", weightOf(shading::PLD_WEIGHT_EQ7Z)},
      {"eq8z", weightOf(shading::PLD_WEIGHT_EQ8Z)},
      {"eq9z", weightOf(shading::PLD_WEIGHT_EQ9Z)},
      {"eq10z", weightOf(shading::PLD_WEIGHT_EQ10Z, .1f, 500.0f)},
      {"eq5", weightOf(shading::PLD_WEIGHT_EQ5, .1f, 1000.0f)}};
  for (const auto& [name, weight] : weights) {
    const Veil here = veilOf("weighted", lists, weight);
    double last = 0;
    std::printf("[ figure ]   %-6s", name);
    for (const float metres : {0.0f, 10.0f, 100.0f, 1000.0f, 10000.0f}) {
      FragmentLists moved = lists;
      for (Fragment& fragment : moved.fragments) fragment.z += metres;
      EXPECT_EQ(largest(veilOf("blended", moved, weight), blended), 0.0);
      const Veil there = veilOf("weighted", moved, weight);
      last = 1000 * rms(there, blended);
      std::printf("  %.2f, %.2f", 1000 * rms(there, here), last);
      if (metres == 10.0f) {
        EXPECT_GT(rms(there, here), 1e-3) << name;
      }
    }
    std::printf("\n");
    // Eq. 5 cubes coverage: floored everywhere, as the others are, but for the nearest.
    EXPECT_LT(last, .5) << name;
  }
}

// Two tight clusters, mixed colours in each: what one pass per system is for.
TEST(Systems, OnePassEachIsNearerToTheTruth) {
  const std::string folder = freshFolder("systems");
  RunOptions options;
  options.folder = folder;
  OpaqueShot far;
  far.depth = 60.0f;
  writeOpaque(folder + "/opaque.exr", far);
  Random random(12);
  for (const bool near : {true, false}) {
    std::vector<Quad> quads;
    for (int i = 0; i < 6; ++i) {
      const float z = (near ? 30.0f : 40.0f) + .3f * random.uniformf();
      quads.push_back({{-20 + 8 * random.uniformf(), -20 + 8 * random.uniformf(), -z},
                       {30, 0, 0},
                       {0, 30, 0},
                       near ? unlit(.8f + .2f * random.uniformf(), .1f, .1f, .4f)
                            : unlit(.1f, .3f, .8f + .2f * random.uniformf(), .4f)});
    }
    // A solid in the far system stands in front of some of it.
    if (!near) quads.push_back({{-5, -5, -39}, {6, 0, 0}, {0, 6, 0}, unlit(.9f, .9f, .2f, 1)});
    GlbOptions glb;
    glb.camera = near;
    writeGlb(folder + (near ? "/near.glb" : "/far.glb"), quads, glb);
  }
  const auto rmse = [&](const std::string& systems) {
    const Ended ended = runProgram({"composite", "opaque.exr", "near.glb", "far.glb", "-o", systems + ".exr", "--aa",
                                    "1", "--method", "phenomenological", "--systems", systems, "--measure", "--json"},
                                   options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out)["error"]["rmse"].get<double>();
  };
  const double off = rmse("off"), file = rmse("file"), node = rmse("node");
  std::printf("[ figure ] rmse in one pass %.5f, one a file %.5f, one a node %.2g\n", off, file, node);
  EXPECT_LT(file, .5 * off);
  EXPECT_LT(node, 2e-6);  // quads that face the camera: every system is one layer, and sorted
  const Ended refused = runProgram(
      {"composite", "opaque.exr", "near.glb", "-o", "no.exr", "--systems", "file", "--tolerance", ".1"}, options);
  EXPECT_EQ(refused.code, 2) << refused.err;
}

}  // namespace
}  // namespace pellucid
