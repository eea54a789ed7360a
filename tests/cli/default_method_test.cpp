// composite without --method gives the file of --method over; what asks for sums is said.
#include <gtest/gtest.h>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class DefaultMethod : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder = freshFolder("default-method");
    writeOpaque(options.folder + "/opaque.exr");
    // Lit glass and smoke that cross, so that no two methods agree.
    writeGlb(options.folder + "/glass.glb", {Quad{{-1, -1, -4}, {2, 0, 1}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
                                             Quad{{-1, -1, -3}, {2, 0, -1}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)},
                                             Quad{{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, unlit(.2f, .2f, 1, .6f)}});
  }
  Ended run(const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments{"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--aa", "2"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return runProgram(arguments, options);
  }
  std::string file(const std::vector<std::string>& flags) const {
    const Ended ended = run(flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return slurp(options.folder + "/out.exr");
  }
  RunOptions options;
};

TEST_F(DefaultMethod, IsOver) {
  const std::string usual = file({});
  EXPECT_TRUE(usual == file({"--method", "over"}));
  EXPECT_FALSE(usual == file({"--method", "phenomenological"}));
}

TEST_F(DefaultMethod, FlagsOfTheSumsTakeThemAndSaySo) {
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--weight", "eq7"},
                                                {"--weight", "auto"},
                                                {"--weight-range", "1:20"},
                                                {"--normalisation", "published"},
                                                {"--self-modulation"},
                                                {"--precision", "float"},
                                                {"--precision", "exact"},
                                                {"--precision", "published"},
                                                {"--resolve", "gl"}}) {
    const Ended ended = run(flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.err.find(flags[0] + ": found no --method, taken phenomenological"), std::string::npos)
        << flags[0] << '\n'
        << ended.err;
    const std::string implied = slurp(options.folder + "/out.exr");
    std::vector<std::string> asked = flags;
    asked.insert(asked.end(), {"--method", "phenomenological"});
    const Ended said = run(asked);
    EXPECT_EQ(said.err.find("found no --method"), std::string::npos) << said.err;
    EXPECT_TRUE(implied == slurp(options.folder + "/out.exr")) << flags[0];
  }
}

TEST_F(DefaultMethod, ExplainTellsTheDecision) {
  EXPECT_NE(run({"--explain"}).out.find("over (the default: exact)"), std::string::npos);
  EXPECT_NE(run({"--explain", "--weight", "eq7"}).out.find("phenomenological (--weight is given: "), std::string::npos);
  EXPECT_NE(run({"--explain", "--tolerance", ".1"}).out.find("phenomenological (--tolerance is given: "),
            std::string::npos);
  EXPECT_NE(run({"--explain", "--method", "sum"}).out.find("method      sum\n"), std::string::npos);
}

// What over has no use for is refused where it is asked for by name.
TEST_F(DefaultMethod, IsNotTakenAgainstAName) {
  for (const char* flag : {"--weight", "--normalisation", "--precision"}) {
    const bool weight = std::string(flag) == "--weight";
    const Ended ended = run({"--method", "over", flag, weight ? "eq7" : "published"});
    EXPECT_EQ(ended.code, 2) << flag;
    EXPECT_NE(ended.err.find(flag), std::string::npos) << ended.err;
  }
}

TEST_F(DefaultMethod, TwoStepsStaySums) {
  ASSERT_EQ(runProgram({"accumulate", "opaque.exr", "glass.glb", "-o", "planes.exr", "--aa", "2"}, options).code, 0);
  ASSERT_EQ(runProgram({"resolve", "opaque.exr", "planes.exr", "-o", "two.exr"}, options).code, 0);
  file({"--method", "phenomenological"});
  const Ended same =
      runProgram({"compare", "out.exr", "two.exr", "--fail", "0", "--warn", "0", "--metadata", "ignore"}, options);
  EXPECT_EQ(same.code, 0) << same.out << same.err;
}

}  // namespace
}  // namespace pellucid
