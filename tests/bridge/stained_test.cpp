// The sample host's shadows against `pellucid composite` of the same panes over the same floor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

constexpr int kReach = 5;  // pixels: more than the tent, 12 texels of the map, covers on the nearest floor

// What the offline picture has left of the floor: the same all around a pixel that no edge is near, of a shadow or a
// pane.
bool isFarFromEdges(const Image<glm::vec4>& picture, const Image<glm::vec4>& open, int x, int y) {
  for (int j = -kReach; j <= kReach; ++j)
    for (int i = -kReach; i <= kReach; ++i)
      for (int c = 0; c < 3; ++c)
        if (std::abs(picture.at(x + i, y + j)[c] / open.at(x + i, y + j)[c] - picture.at(x, y)[c] / open.at(x, y)[c]) >
            .004f)
          return false;
  return true;
}

TEST(BridgeStained, ShadowsEqualTheOfflineProgram) {
  const std::string folder = freshFolder("bridge-stained");
  RunOptions options, host;
  options.folder = host.folder = folder;
  host.program = "pellucid_stained";
  const Ended drawn = runProgram({".", "480x270"}, host);
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  const Image<glm::vec4> frame = readOpaque(folder + "/frame.exr", {}).gbuffer.beauty,
                         open = readOpaque(folder + "/opaque.exr", {}).gbuffer.beauty;
  for (const char* shadows : {"exact", "stochastic"}) {
    std::vector<std::string> arguments{
        "composite",       "opaque.exr",     "glass.glb",      "-o",      "offline.exr", "--aa",  "1",
        "--environment",   "0.35,0.38,0.42", "--weight-range", "0.1:100", "--shadows",   shadows, "--method",
        "phenomenological"};
    if (std::string(shadows) == "stochastic") arguments.insert(arguments.end(), {"--shadow-size", "2048"});
    const Ended offline = runProgram(arguments, options);
    ASSERT_EQ(offline.code, 0) << offline.err;
    const Image<glm::vec4> expected = readOpaque(folder + "/offline.exr", {}).gbuffer.beauty;
    ASSERT_EQ(frame.size(), expected.size());
    std::size_t touched = 0, apart = 0, inside = 0;
    double worst = 0, sum = 0;
    for (int y = kReach; y < frame.height() - kReach; ++y)
      for (int x = kReach; x < frame.width() - kReach; ++x) {
        if (expected.at(x, y) == open.at(x, y) && frame.at(x, y) == open.at(x, y)) continue;
        double off = 0;
        for (int c = 0; c < 3; ++c)
          off = std::max(off,
                         std::abs(static_cast<double>(frame.at(x, y)[c]) - static_cast<double>(expected.at(x, y)[c])));
        ++touched;
        sum += off;
        apart += off > .02;
        if (!isFarFromEdges(expected, open, x, y)) continue;
        ++inside;
        worst = std::max(worst, off);
      }
    std::printf(
        "stained against composite --shadows %s: of %zu pixels in shadow or under glass %zu lie %d pixels from every "
        "edge and are off by %.2g at most; "
        "%.2f%% of all are off by more than .02, all by %.2g on the average\n",
        shadows, touched, inside, kReach, worst, 100.0 * static_cast<double>(apart) / static_cast<double>(touched),
        sum / static_cast<double>(touched));
    EXPECT_GT(touched, 8000u);
    EXPECT_GT(inside, 2000u);
    EXPECT_LT(worst, 1e-4);  // steps of 1/4096 of optical depth, rounded at random, the mean of 225 texels
  }
}

TEST(BridgeStained, TheHostKnowsThePublicHeaderAlone) {
  const std::string text = slurp(PELLUCID_SOURCE_DIR "/samples/stained/stained.cpp");
  for (const char* ours : {"gbuffer/", "shaders/", "composite/", "engine_bridge/", "samples/generate/"})
    EXPECT_EQ(text.find(std::string("#include \"") + ours), std::string::npos);
  EXPECT_NE(text.find("#include <pellucid/pellucid.h>"), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
