// Every sample resolved by the CPU and by the device: the same file.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/program.h"

namespace pellucid::test {
namespace {

TEST(ResolveGl, GivesTheFileOfTheCpuOnEverySample) {
  RunOptions options;
  options.folder = freshFolder("resolve-gl-samples");
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "all", "90"}, generator).code, 0);
  std::size_t samples = 0;
  for (const std::string& file : filesIn(options.folder)) {
    if (file.size() < 5 || file.substr(file.size() - 4) != ".glb") continue;
    const std::string name = file.substr(0, file.size() - 4);
    for (const std::string resolver : {"cpu", "gl"}) {
      const Ended ended = runProgram({"composite", name + ".exr", name + ".glb", "-o",
                                      name + "-" + resolver + ".out.exr", "--aa", "2", "--resolve", resolver},
                                     options);
      ASSERT_EQ(ended.code, 0) << name << ": " << ended.err;
    }
    const std::string cpu = slurp(options.folder + "/" + name + "-cpu.out.exr"),
                      gl = slurp(options.folder + "/" + name + "-gl.out.exr");
    EXPECT_GT(cpu.size(), 1000u);
    EXPECT_TRUE(cpu == gl) << name;
    std::printf("GL resolve of %s: %s\n", name.c_str(), cpu == gl ? "the file of the CPU, to the bit" : "differs");
    ++samples;
  }
  EXPECT_GE(samples, 8u);
}

TEST(ResolveGl, RefusesWhatHasNoSums) {
  RunOptions options;
  options.folder = freshFolder("resolve-gl-refused");
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "bars", "90"}, generator).code, 0);
  const Ended ended = runProgram(
      {"composite", "bars.exr", "bars.glb", "-o", "out.exr", "--resolve", "gl", "--method", "over"}, options);
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("--resolve: found gl with --method over, expected cpu"), std::string::npos) << ended.err;
}

// --low-res: unmarked scenes, and what draws every fragment, cannot honour it.
TEST(LowResolutionProgram, FlagsThatCannotBeHonouredAreUsageErrors) {
  RunOptions options;
  options.folder = freshFolder("low-res-flags");
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "smoke", "90"}, generator).code, 0);
  const auto run = [&](std::vector<std::string> flags) {
    std::vector<std::string> arguments{"composite", "smoke.exr", "smoke.glb", "-o", "out.exr", "--aa", "1"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return runProgram(arguments, options);
  };
  const Ended unmarked = run({"--low-res", "4"});
  EXPECT_EQ(unmarked.code, 2);
  EXPECT_NE(unmarked.err.find("no transparent material is marked"), std::string::npos) << unmarked.err;
  EXPECT_EQ(run({"--low-res", "3"}).code, 2);
  const std::vector<std::string> mark{"--set", "puff 0.lowResolution=true", "--set", "puff 1.lowResolution=true"};
  for (const std::vector<std::string>& every :
       {std::vector<std::string>{"--method", "over"}, {"--precision", "exact"}, {"--tolerance", "0.1"}}) {
    std::vector<std::string> flags = mark;
    flags.insert(flags.end(), every.begin(), every.end());
    const Ended passedOver = run(flags);
    EXPECT_EQ(passedOver.code, 0) << passedOver.err;
    EXPECT_NE(passedOver.err.find("drawn at full resolution"), std::string::npos) << passedOver.err;
    flags.insert(flags.end(), {"--low-res", "4"});
    const Ended refused = run(flags);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("--low-res: found 4"), std::string::npos) << refused.err;
  }
  // One factor is the default of marked materials; 1 draws them like the others, to the bit.
  ASSERT_EQ(run({}).code, 0);
  const std::string plain = slurp(options.folder + "/out.exr");
  std::vector<std::string> flags = mark;
  flags.insert(flags.end(), {"--low-res", "1"});
  ASSERT_EQ(run(flags).code, 0);
  EXPECT_TRUE(slurp(options.folder + "/out.exr") == plain);
  ASSERT_EQ(run(mark).code, 0);
  const std::string quarter = slurp(options.folder + "/out.exr");
  EXPECT_FALSE(quarter == plain);
  flags.back() = "4";
  ASSERT_EQ(run(flags).code, 0);
  EXPECT_TRUE(slurp(options.folder + "/out.exr") == quarter);
}

}  // namespace
}  // namespace pellucid::test
