// The least budget: whatever smaller one is asked for, the picture is that of the ordinary budget and comes as soon.
#include <gtest/gtest.h>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// Chunks of one triangle each, times bands of a few fragments: without a floor this takes minutes.
TEST(Budget, SmallerThanTheLeastIsSaidAndEnds) {
  RunOptions options;
  options.folder = freshFolder("budget-least");
  writeOpaque(options.folder + "/opaque.exr");
  std::vector<Quad> panes;
  for (int i = 0; i < 150; ++i) {
    const float across = 0.01f * static_cast<float>(i % 30), z = -2.0f - 0.02f * static_cast<float>(i);
    panes.push_back(Quad{{-1.5f + across, -1.5f, z}, {2.7f, 0, 0.1f}, {0, 3, 0}, unlit(.9f, .5f, .2f, .03f)});
  }
  writeGlb(options.folder + "/panes.glb", panes);
  const auto picture = [&](const std::string& budget, const std::string& name) {
    const Ended ended = runProgram(
        {"composite", "opaque.exr", "panes.glb", "-o", name, "--aa", "1", "--method", "over", "--budget", budget},
        options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err.find("--budget") != std::string::npos, budget != "256M") << ended.err;
    std::printf("--budget %s: %.1f s of CPU\n", budget.c_str(), ended.cpuSeconds);
    EXPECT_LT(ended.cpuSeconds, 60);
    return readOpaque(options.folder + "/" + name, {}).gbuffer.beauty;
  };
  const Image<glm::vec4> ordinary = picture("256M", "a.exr");
  for (const char* budget : {"1", "1K", "1023K"}) {
    const Image<glm::vec4> least = picture(budget, "b.exr");
    for (std::size_t i = 0; i < ordinary.size(); ++i) ASSERT_EQ(least[i], ordinary[i]) << budget << ", pixel " << i;
  }
  // Named once, with the least.
  const Ended ended = runProgram({"accumulate", "opaque.exr", "panes.glb", "-o", "c.exr", "--budget", "2K"}, options);
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::size_t said = ended.err.find("--budget 2K");
  ASSERT_NE(said, std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("1M", said), std::string::npos) << ended.err;
  EXPECT_EQ(ended.err.find("--budget", said + 1), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace pellucid
