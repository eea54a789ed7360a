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
      const Ended ended =
          runProgram({"composite", name + ".exr", name + ".glb", "-o", name + "-" + resolver + ".out.exr", "--aa", "2",
                      "--method", "phenomenological", "--resolve", resolver},
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

// --low-res: every method and tier draws marked layers at low resolution; unmarked scenes cannot honour it.
TEST(LowResolutionProgram, EveryMethodAndTierHonoursIt) {
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
  const auto picture = [&](const std::vector<std::string>& flags) {
    const Ended ended = run(flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return slurp(options.folder + "/out.exr");
  };
  const Ended unmarked = run({"--low-res", "4"});
  EXPECT_EQ(unmarked.code, 2);
  EXPECT_NE(unmarked.err.find("no transparent material is marked"), std::string::npos) << unmarked.err;
  EXPECT_EQ(run({"--low-res", "3"}).code, 2);
  for (const std::vector<std::string>& every : {std::vector<std::string>{},
                                                {"--method", "phenomenological"},
                                                {"--method", "wavelet:2"},
                                                {"--method", "phenomenological", "--precision", "exact"},
                                                {"--method", "phenomenological", "--precision", "published"},
                                                {"--tolerance", "0.1"}}) {
    SCOPED_TRACE(every.empty() ? "default" : every.back());
    const std::string plain = picture(every);
    std::vector<std::string> flags = every;
    for (const char* mark : {"puff 0.lowResolution=true", "puff 1.lowResolution=true"})
      flags.insert(flags.end(), {"--set", mark});
    const std::string quarter = picture(flags);
    EXPECT_FALSE(quarter == plain);
    // One factor is the default of marked materials; 1 draws them like the others, to the bit.
    flags.insert(flags.end(), {"--low-res", "4"});
    EXPECT_TRUE(picture(flags) == quarter);
    flags.back() = "1";
    EXPECT_TRUE(picture(flags) == plain);
  }
}

}  // namespace
}  // namespace pellucid::test
