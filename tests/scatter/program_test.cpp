// Refraction, diffusion and precision as a user asks for them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gbuffer/exr_document.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid::test {
namespace {

struct ProgramShot {
  std::string folder = freshFolder("scatter-program");
  std::string opaque = folder + "/opaque.exr", glass = folder + "/glass.glb";
  ProgramShot() {
    writeOpaque(opaque);
    Quad frosted;
    frosted.material = {
        {"pbrMetallicRoughness",
         {{"metallicFactor", 0.0}, {"roughnessFactor", 0.5}, {"baseColorFactor", {0.9, 0.6, 0.3, 1.0}}}},
        {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}};
    Quad smoke;
    smoke.corner = {-0.5f, -0.5f, -2.0f};
    smoke.across = {1.0f, 0.0f, -0.5f};
    smoke.up = {0.0f, 1.0f, 0.0f};
    smoke.material = unlit(0.4f, 0.5f, 0.6f, 0.3f);
    writeGlb(glass, {frosted, smoke, smoke});
  }
  Ended composite(const std::string& out, std::vector<std::string> flags) const {
    std::vector<std::string> arguments{"composite", opaque, glass, "-o", folder + "/" + out, "--aa", "2"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return runProgram(arguments);
  }
};

TEST(ScatterProgram, FlagsThatCannotBeHonouredAreUsageErrors) {
  const ProgramShot shot;
  const std::vector<std::vector<std::string>> wrong = {
      {"--refract", "sideways"},
      {"--refract", "fixed:-1"},
      {"--refract", "fixed:"},
      {"--diffusion-scale", "0.3"},
      {"--diffusion-scale", "0:1"},
      {"--diffusion-kernel", "disc", "--gather", "exact"},
      {"--precision", "exact", "--method", "unsorted"},
      {"--precision", "published", "--method", "weighted"},
      {"--precision", "published", "--method", "over"},
      {"--method", "phenomenological", "--precision", "published", "--normalisation", "spectral"},
      {"--precision", "published", "--tolerance", "0.1"}};
  for (const auto& flags : wrong) {
    const Ended ended = shot.composite("wrong.exr", flags);
    EXPECT_EQ(ended.code, 2) << flags[1] << '\n' << ended.err;
    EXPECT_NE(ended.err.find("expected"), std::string::npos) << ended.err;
  }
}

TEST(ScatterProgram, ExactGivesTheSameFileForEveryOrderBudgetAndThreadCount) {
  const ProgramShot shot;
  ASSERT_EQ(shot.composite("a.exr", {"--method", "phenomenological", "--precision", "exact"}).code, 0);
  ASSERT_EQ(shot.composite("b.exr", {"--method", "phenomenological", "--precision", "exact", "--order", "reverse",
                                     "--threads", "1"})
                .code,
            0);
  ASSERT_EQ(shot.composite("c.exr", {"--method", "phenomenological", "--precision", "exact", "--order", "shuffle:5",
                                     "--budget", "64K"})
                .code,
            0);
  const std::string a = slurp(shot.folder + "/a.exr");
  EXPECT_TRUE(a == slurp(shot.folder + "/b.exr"));
  EXPECT_TRUE(a == slurp(shot.folder + "/c.exr"));
}

// A shot whose picture holds NaN and infinity, seen through frosted glass: each stays in its pixel, and is reported.
TEST(ScatterProgram, NotFiniteColourIsContainedAndReported) {
  const ProgramShot shot;
  const Window window{0, 0, 64, 64};
  Image<float> red(64, 64, 0.25f), green(64, 64, 0.5f);
  red.at(30, 31) = std::numeric_limits<float>::quiet_NaN();
  green.at(40, 20) = std::numeric_limits<float>::infinity();
  writeLayers(shot.opaque, window, window,
              {{"",
                {{"R", red},
                 {"G", green},
                 {"B", green},
                 {"A", Image<float>(64, 64, 1.0f)},
                 {"Z", Image<float>(64, 64, 10.0f)}}}},
              {}, nullptr, false);
  const Ended ended = shot.composite("out.exr", {});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("2 pixels"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("(40, 20)"), std::string::npos) << ended.err;  // the first, row by row
  const GBuffer out = readOpaque(shot.folder + "/out.exr", {}).gbuffer;
  std::size_t notFinite = 0;
  for (std::size_t i = 0; i < out.beauty.size(); ++i)
    for (int c = 0; c < 4; ++c)
      if (!std::isfinite(out.beauty[i][c])) {
        ++notFinite;
        EXPECT_TRUE(i == 31 * 64 + 30 || i == 20 * 64 + 40) << i;
      }
  std::printf("2 pixels that are not finite, behind frosted glass: %zu values of the picture are\n", notFinite);
}

TEST(ScatterProgram, PruningIsReportedAndChangesNoBit) {
  const ProgramShot shot;
  const Ended pruned = shot.composite("pruned.exr", {"--method", "phenomenological", "--stats"}),
              full = shot.composite("full.exr", {"--method", "phenomenological", "--no-prune"});
  ASSERT_EQ(pruned.code, 0) << pruned.err;
  ASSERT_EQ(full.code, 0) << full.err;
  EXPECT_TRUE(slurp(shot.folder + "/pruned.exr") == slurp(shot.folder + "/full.exr"));
  EXPECT_NE(pruned.out.find("bits per pixel"), std::string::npos) << pruned.out;
  EXPECT_NE(pruned.out.find("refraction: no material transmits through a volume"), std::string::npos) << pruned.out;
}

TEST(ScatterProgram, PublishedTierKeepsNoDepth) {
  const ProgramShot shot;
  const Ended ended =
      shot.composite("wrong.exr", {"--method", "phenomenological", "--precision", "published", "--layers", "depth"});
  EXPECT_EQ(ended.code, 2) << ended.err;
  EXPECT_NE(ended.err.find("--layers"), std::string::npos) << ended.err;
}

TEST(ScatterProgram, PublishedTierReportsItsBitsAndItsClamps) {
  const ProgramShot shot;
  const Ended plain =
      shot.composite("plain.exr", {"--method", "phenomenological", "--precision", "published", "--stats"});
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_NE(plain.out.find("112 bits per pixel"), std::string::npos) << plain.out;
  EXPECT_EQ(plain.err.find("clamped"), std::string::npos) << plain.err;
  const Ended wide = shot.composite("wide.exr", {"--method", "phenomenological", "--precision", "published", "--stats",
                                                 "--diffusion-scale", "90:0.5"});
  ASSERT_EQ(wide.code, 0) << wide.err;
  EXPECT_NE(wide.out.find("clamped"), std::string::npos) << wide.out;
  EXPECT_NE(wide.err.find("clamped"), std::string::npos) << wide.err;
}

// In two steps through a file, or in one: the same picture, and self-modulation is on in both.
TEST(ScatterProgram, PublishedPlanesResolveToTheSamePicture) {
  const ProgramShot shot;
  const std::string planes = shot.folder + "/planes.exr";
  ASSERT_EQ(runProgram({"accumulate", shot.opaque, shot.glass, "-o", planes, "--precision", "published"}).code, 0);
  const Ended ended = runProgram({"resolve", shot.opaque, planes, "-o", shot.folder + "/two.exr"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  for (const std::string name : {"one", "other"}) {
    std::vector<std::string> arguments{
        "composite",       shot.opaque, shot.glass, "-o", shot.folder + "/" + name + ".exr",
        "--precision",     "published", "--aa",     "1",  "--method",
        "phenomenological"};
    if (name == "other") arguments.emplace_back("--no-self-modulation");
    ASSERT_EQ(runProgram(arguments).code, 0);
  }
  const ExrDocument one = readExr(shot.folder + "/one.exr"), two = readExr(shot.folder + "/two.exr"),
                    other = readExr(shot.folder + "/other.exr");
  for (const char* name : {"R", "G", "B"}) {
    EXPECT_TRUE(one.parts[0].find(name)->bytes == two.parts[0].find(name)->bytes) << name;
  }
  EXPECT_FALSE(one.parts[0].find("R")->bytes == other.parts[0].find("R")->bytes &&
               one.parts[0].find("B")->bytes == other.parts[0].find("B")->bytes);
}

// Planes written, read and resolved give the picture of one run; the debug planes are those of the pass.
TEST(ScatterProgram, AccumulateThenResolveIsComposite) {
  const ProgramShot shot;
  const std::string planes = shot.folder + "/planes.exr", resolved = shot.folder + "/resolved.exr";
  ASSERT_EQ(runProgram({"accumulate", shot.opaque, shot.glass, "-o", planes}).code, 0);
  const Ended ended = runProgram({"resolve", shot.opaque, planes, "-o", resolved, "--layers", "D,delta,weight,count"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Ended one = runProgram({"composite", shot.opaque, shot.glass, "-o", shot.folder + "/one.exr", "--aa", "1",
                                "--method", "phenomenological", "--layers", "D,delta,weight,count"});
  ASSERT_EQ(one.code, 0) << one.err;
  const ExrDocument a = readExr(resolved), b = readExr(shot.folder + "/one.exr");
  ASSERT_EQ(a.parts[0].channels.size(), b.parts[0].channels.size());
  EXPECT_TRUE(a.parts[0].find("oit.D") && a.parts[0].find("oit.delta.X") && a.parts[0].find("oit.count"));
  for (const ExrChannel& channel : a.parts[0].channels) {
    const ExrChannel* other = b.parts[0].find(channel.name);
    ASSERT_TRUE(other) << channel.name;
    EXPECT_TRUE(channel.bytes == other->bytes) << channel.name;
  }
}

}  // namespace
}  // namespace pellucid::test
