// --preset-model: a paper's settings by one flag are those flags, and what is given wins.
#include <gtest/gtest.h>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class PresetModel : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder = freshFolder("preset-model");
    writeOpaque(options.folder + "/opaque.exr");
    writeGlb(options.folder + "/glass.glb", {Quad{{-1, -1, -4}, {2, 0, 1}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
                                             Quad{{-1, -1, -3}, {2, 0, -1}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)}});
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

const std::vector<std::string> kPhenomenological{
    "--method",  "phenomenological",   "--precision", "published",    "--weight",    "eq5",         "--normalisation",
    "published", "--self-modulation",  "--refract",   "fixed:2",      "--diffusion", "netCoverage", "--diffusion-scale",
    "0.37:0.05", "--diffusion-kernel", "disc",        "--dispersion", "off"};

TEST_F(PresetModel, IsItsFlags) {
  const struct {
    const char* name;
    std::vector<std::string> flags;
  } rows[] = {{"pt17", kPhenomenological},
              {"wb13", {"--method", "listing3", "--weight", "eq7", "--refract", "off", "--diffusion", "off"}},
              {"st10", {"--method", "stochastic:depth", "--samples", "8", "--refract", "off", "--diffusion", "off"}}};
  for (const auto& row : rows) {
    const std::string made = file({"--preset-model", row.name});
    EXPECT_TRUE(made == file(row.flags)) << row.name;
    EXPECT_FALSE(made == file({})) << row.name;
  }
}

TEST_F(PresetModel, SaysWhatItTakesAndLeavesWhatIsGiven) {
  const Ended plain = run({"--preset-model", "pt17"});
  EXPECT_NE(plain.err.find("--refract fixed:2"), std::string::npos) << plain.err;
  const Ended given = run({"--preset-model", "pt17", "--refract", "off"});
  EXPECT_EQ(given.code, 0) << given.err;
  EXPECT_EQ(given.err.find("--refract fixed:2"), std::string::npos) << given.err;
  std::vector<std::string> flags = kPhenomenological;
  flags[10] = "off";
  const std::string asked = file(flags);
  EXPECT_TRUE(asked == file({"--preset-model", "pt17", "--refract", "off"}));
  EXPECT_EQ(run({"--preset-model", "pt99"}).code, 2);
}

}  // namespace
}  // namespace pellucid
