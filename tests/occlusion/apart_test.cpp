// The rims' light from around kept apart by `accumulate`, darkened by `resolve`: the same picture as in the pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gbuffer/exr_document.h"
#include "gbuffer/planes_io.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

struct Foliage {
  std::string folder = freshFolder("occlusion_apart"), stem = folder + "/foliage";
  Foliage() {
    RunOptions options;
    options.program = "pellucid_samples";
    const Ended made = runProgram({folder, "foliage", "270"}, options);
    EXPECT_EQ(made.code, 0) << made.err;
  }
  Ended accumulate(const std::string& name, std::vector<std::string> more) const {
    // One weight for all: each would be fitted to what it draws.
    std::vector<std::string> arguments{"accumulate", stem + ".exr", stem + ".glb", "-o", folder + "/" + name + ".exr",
                                       "--weight",   "eq5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }
  Ended resolve(const std::string& name, std::vector<std::string> more) const {
    std::vector<std::string> arguments{"resolve", stem + ".exr", folder + "/" + name + ".exr", "-o",
                                       folder + "/picture.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }
  std::vector<float> pictureOf(const std::string& name, std::vector<std::string> more = {}) const {
    const Ended ended = resolve(name, std::move(more));
    EXPECT_EQ(ended.code, 0) << ended.err;
    const ExrDocument document = readExr(folder + "/picture.exr");
    const ExrPart& part = document.parts[0];
    std::vector<float> values;
    for (const char* channel : {"R", "G", "B"})
      for (std::size_t i = 0;
           i < static_cast<std::size_t>(part.data.width()) * static_cast<std::size_t>(part.data.height()); ++i)
        values.push_back(part.find(channel)->at(i));
    return values;
  }
};

const std::vector<std::string> kSkyFlags{"--environment", "0.34,0.37,0.42"};

std::vector<std::string> with(std::vector<std::string> more) {
  more.insert(more.end(), kSkyFlags.begin(), kSkyFlags.end());
  return more;
}

TEST(RimsApart, ResolveDarkensThemAsThePassDoes) {
  const Foliage foliage;
  for (const std::string direct : {"0", "0.5"}) {
    ASSERT_EQ(foliage.accumulate("inferred", with({"--occlusion-direct", direct})).code, 0);
    ASSERT_EQ(foliage.accumulate("solid", with({"--occlusion", "solid", "--occlusion-direct", direct})).code, 0);
    ASSERT_EQ(foliage.accumulate("apart", with({"--occlusion", "apart", "--occlusion-direct", direct})).code, 0);
    const std::vector<float> pass = foliage.pictureOf("inferred"), open = foliage.pictureOf("solid"),
                             apart = foliage.pictureOf("apart");
    EXPECT_EQ(foliage.pictureOf("apart", {"--occlusion", "off"}), open) << "no bit of the sums is another";

    RimPlanes rims;
    const OitPlanes planes = readPlanes(foliage.folder + "/apart.exr", &rims);
    ASSERT_FALSE(rims.empty());
    double worstAlone = 0, worst = 0, sum = 0, darkened = 0;
    std::size_t alone = 0, pixels = 0;
    for (std::size_t i = 0; i < rims.averaged.size(); ++i) {
      if (!(rims.averaged[i].a > 0.0f)) continue;
      ++pixels;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = c * rims.averaged.size() + i;
        const double off = std::abs(static_cast<double>(apart[at]) - static_cast<double>(pass[at]));
        worst = std::max(worst, off);
        sum += off;
        darkened += std::abs(static_cast<double>(open[at]) - static_cast<double>(pass[at]));
        if (planes.weight[i].a == 1.0f) worstAlone = std::max(worstAlone, off);
      }
      alone += planes.weight[i].a == 1.0f ? 1 : 0;
    }
    std::printf(
        "[ figure ] direct %s: %zu pixels of rims, %zu of one layer: resolve against the pass at most %.2g there, "
        "%.3f among all; mean %.5f of %.5f\n",
        direct.c_str(), pixels, alone, worstAlone, worst, sum / static_cast<double>(3 * pixels),
        darkened / static_cast<double>(3 * pixels));
    EXPECT_GT(alone, 100u);
    EXPECT_LE(worstAlone, 0x1p-12) << "half a unit of the half floats that the picture is written in, of each";
    EXPECT_LT(sum, 0.1 * darkened) << "several rims in a pixel share one answer";
    // Elsewhere nothing changes.
    for (std::size_t i = 0; i < rims.averaged.size(); ++i)
      if (!(rims.averaged[i].a > 0.0f)) {
        ASSERT_EQ(apart[i], open[i]);
      }
  }
}

TEST(RimsApart, SumsOfRimsAddAndWhatCannotBeHonouredIsRefused) {
  const Foliage foliage;
  ASSERT_EQ(foliage.accumulate("apart", with({"--occlusion", "apart"})).code, 0);
  ASSERT_EQ(foliage.accumulate("off", with({"--occlusion", "off"})).code, 0);
  RimPlanes once, twice;
  readPlanes(foliage.folder + "/apart.exr", &once);
  twice = once;
  twice.add(once);
  twice.add(RimPlanes());
  for (std::size_t i = 0; i < once.averaged.size(); ++i) ASSERT_EQ(twice.averaged[i], 2.0f * once.averaged[i]);

  EXPECT_EQ(foliage.resolve("off", {"--occlusion-radius", "0.1"}).code, 2);
  EXPECT_EQ(foliage.resolve("apart", {"--occlusion", "off", "--occlusion-radius", "0.1"}).code, 2);
  EXPECT_EQ(foliage.accumulate("x", with({"--occlusion", "apart", "--precision", "exact"})).code, 2);
  EXPECT_EQ(foliage.accumulate("x", with({"--occlusion", "apart", "--occlusion-inference", "published"})).code, 2);
  const Ended screen = foliage.resolve("apart", {"--occlusion-source", "screen", "--occlusion-inference", "published"});
  EXPECT_EQ(screen.code, 0) << screen.err;
  // No surroundings, nothing to occlude: said, and no planes.
  const Ended dark = foliage.accumulate("dark", {"--occlusion", "apart", "--environment", "0,0,0"});
  EXPECT_EQ(dark.code, 0) << dark.err;
  EXPECT_NE(dark.err.find("carry no rims"), std::string::npos) << dark.err;
  RimPlanes none;
  readPlanes(foliage.folder + "/dark.exr", &none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace pellucid
