// The sample engine's frame against `pellucid composite` of its own G-buffer and the same glTF.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

struct Shot {
  const char* sample;
  const char* method;
  double mean;   // difference over the other pixels, at most
  double stray;  // part of the pixels that may be off by more than .01; four may anyway
  const char* why;
};
// 198 rows: at 180, edges of the bars pass through pixel centres, where the side that rows run to decides who owns
// them. Attributes are interpolated by other shaders, so edges and footprints of lookups fall differently on a few
// pixels.
const Shot kShots[] = {
    {"bars", "weighted", 1e-7, 1e-4, "pixels at edges"},
    {"bars", "front+tail", 1e-7, 1e-4, "pixels at edges"},
    {"ball", "phenomenological", 3e-6, 2e-4, "pixels at edges, and where a refracted lookup meets one"},
    {"bars", "front+tail:exact", 1e-7, 1e-4, "pixels at edges"},
    {"ball", "phenomenological:exact", 3e-6, 2e-4, "pixels at edges, and where a refracted lookup meets one"},
    {"frosted", "phenomenological", 5e-5, 1e-4,
     "rows run up in the engine: the spread pyramid's texels lie elsewhere"}};

TEST(BridgeEngine, FrameEqualsTheOfflineComposite) {
  const std::string folder = freshFolder("bridge-engine");
  RunOptions options, generator, engine;
  options.folder = generator.folder = engine.folder = folder;
  generator.program = "pellucid_samples";
  engine.program = "pellucid_engine";
  for (const Shot& shot : kShots) {
    const std::string name = shot.sample;
    ASSERT_EQ(runProgram({".", name, "180"}, generator).code, 0);
    const Ended drawn = runProgram({name + ".glb", ".", "352x198", shot.method}, engine);
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    const std::string asked = shot.method, method = asked.substr(0, asked.find(':'));
    const bool exact = asked != method && method == "phenomenological";  // the one that the offline program has it for
    const Ended offline = runProgram(
        {"composite", "opaque.exr", name + ".glb", "-o", "offline.exr", "--aa", "1", "--precision",
         exact ? "exact" : "float", "--method", method, "--environment", "0.35,0.38,0.42", "--weight-range", "0.1:100"},
        options);
    ASSERT_EQ(offline.code, 0) << offline.err;
    const GBuffer frame = readOpaque(folder + "/frame.exr", {}).gbuffer,
                  expected = readOpaque(folder + "/offline.exr", {}).gbuffer,
                  opaque = readOpaque(folder + "/opaque.exr", {}).gbuffer;
    ASSERT_EQ(frame.beauty.size(), expected.beauty.size());
    double sum = 0, largest = 0;
    std::size_t stray = 0, same = 0, changed = 0;
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
      double worst = 0;
      for (int c = 0; c < 4; ++c)
        worst = std::max(
            worst, std::abs(static_cast<double>(frame.beauty[i][c]) - static_cast<double>(expected.beauty[i][c])));
      if (worst <= 0.01) sum += worst;
      largest = std::max(largest, worst);
      stray += worst > 0.01;
      same += worst == 0;
      changed += frame.beauty[i] != opaque.beauty[i];
    }
    const auto pixels = static_cast<double>(frame.beauty.size());
    std::printf(
        "%s, %s: engine against composite: %.4f%% of the pixels off by more than .01 (largest %.2g), the others by "
        "%.2g on the average, %.1f%% the same "
        "bits, %.1f%% under glass (%s)\n",
        shot.sample, shot.method, 100 * static_cast<double>(stray) / pixels, largest, sum / pixels,
        100 * static_cast<double>(same) / pixels, 100 * static_cast<double>(changed) / pixels, shot.why);
    EXPECT_LT(sum / pixels, shot.mean);
    EXPECT_LT(static_cast<double>(stray), std::max(4.0, shot.stray * pixels));
    EXPECT_GT(static_cast<double>(changed), 0.05 * pixels);
  }
}

// The sample is what its promise says: short, and of ours it includes the public header alone.
TEST(BridgeEngine, TheSampleIsShortAndKnowsThePublicHeaderAlone) {
  const std::string text = slurp(PELLUCID_SOURCE_DIR "/samples/engine/engine.cpp");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  std::printf("samples/engine/engine.cpp: %ld lines\n", static_cast<long>(lines));
  EXPECT_LT(lines, 600);
  for (const char* ours : {"gbuffer/", "shaders/", "composite/", "engine_bridge/"})
    EXPECT_EQ(text.find(std::string("#include \"") + ours), std::string::npos);
  EXPECT_NE(text.find("#include <pellucid/pellucid.h>"), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
