// The samples are what they say, the same in every run, and the main job runs on each.
#include <gtest/gtest.h>
#include <sched.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

class Samples : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("samples-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
  }
  // Writes NAME.exr and NAME.glb below `to`.
  Ended generate(const std::string& name, const std::string& to = ".", const std::vector<std::string>& more = {}) {
    RunOptions generator = options;
    generator.program = "pellucid_samples";
    std::vector<std::string> arguments = {to, name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, generator);
  }
  // The error against sorted truth that `composite NAME --measure` reports.
  nlohmann::json measured(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"composite",         name + ".exr", name + ".glb", "-o",
                                          name + "-glass.exr", "--measure",   "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const nlohmann::json report = nlohmann::json::parse(ended.out, nullptr, false);
    EXPECT_TRUE(report.is_object() && report.contains("error")) << ended.out;
    return report.value("error", nlohmann::json::object());
  }
  GBuffer read(const std::string& file) { return readOpaque(folder + "/" + file, {}).gbuffer; }

  std::string folder;
  RunOptions options;
};

TEST_F(Samples, TwoRunsWriteTheSameBytes) {
  ASSERT_EQ(generate("all", "first", {"180"}).code, 0);
  // The second run on one core: oneTBB takes as many threads as its process may use cores.
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof(all), &all), 0);
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
    if (CPU_ISSET(core, &all)) CPU_SET(core, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  const Ended second = generate("all", "second", {"180"});
  ASSERT_EQ(sched_setaffinity(0, sizeof(all), &all), 0);
  ASSERT_EQ(second.code, 0) << second.err;

  const std::vector<std::string> files = filesIn(folder + "/first");
  ASSERT_GE(files.size(), 6u);
  ASSERT_EQ(files, filesIn(folder + "/second"));
  for (const std::string& file : files) {
    const std::string bytes = slurp(folder + "/first/" + file);
    std::printf("%s: %zu bytes\n", file.c_str(), bytes.size());
    EXPECT_GT(bytes.size(), 1000u) << file;
    EXPECT_TRUE(bytes == slurp(folder + "/second/" + file)) << file;
  }
}

TEST_F(Samples, AnUnknownNameIsRefused) {
  const Ended ended = generate("no-such-sample");
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("no-such-sample"), std::string::npos) << ended.err;
  EXPECT_TRUE(filesIn(folder).empty());
}

// And no folder of that name is made.
TEST_F(Samples, AFlagIsNoFolder) {
  const Ended ended = generate("bars", "--help");
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("expected OUTDIR"), std::string::npos) << ended.err;
  EXPECT_TRUE(filesIn(folder).empty());
}

TEST_F(Samples, AnUnfitHeightIsRefused) {
  for (const char* height : {"0", "-9", "9999999999", "90x", "", "100"}) {
    const Ended ended = generate("bars", ".", {height});
    EXPECT_EQ(ended.code, 2) << height;
    EXPECT_NE(ended.err.find("HEIGHT"), std::string::npos) << ended.err;
  }
  EXPECT_TRUE(filesIn(folder).empty());
  ASSERT_EQ(generate("bars", ".", {"90"}).code, 0);
  const GBuffer small = read("bars.exr");
  EXPECT_EQ(small.beauty.width(), 160);
  EXPECT_EQ(small.beauty.height(), 90);
}

TEST_F(Samples, AsManyHairsAsAsked) {
  for (const char* hairs : {"0", "-1", "200000", "5x", ""}) {
    const Ended ended = generate("hair", ".", {"90", "--hairs", hairs});
    EXPECT_EQ(ended.code, 2) << hairs;
    EXPECT_NE(ended.err.find("--hairs"), std::string::npos) << ended.err;
  }
  EXPECT_EQ(generate("bars", ".", {"90", "--hairs", "5"}).code, 2);
  EXPECT_TRUE(filesIn(folder).empty());
  std::size_t bytes[2];
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(generate("hair", ".", {"90", "--hairs", i == 0 ? "1" : "11"}).code, 0);
    bytes[i] = slurp(folder + "/hair.glb").size();
  }
  // 480 triangles of 12 bytes and 482 vertices of 40 each, but for a digit here and there in the JSON.
  EXPECT_NEAR(static_cast<double>(bytes[1] - bytes[0]), 10.0 * (480 * 12 + 482 * 40), 64.0);
}

// The wall behind the bars faces the camera, so its planar depth is one number: 3 m to z = 0, 1.2 m on to the wall.
TEST_F(Samples, DepthIsPlanar) {
  ASSERT_EQ(generate("bars").code, 0);
  const GBuffer bars = read("bars.exr");
  ASSERT_TRUE(bars.camera.has_value());
  for (int y = 0; y < bars.viewZ.height(); ++y)
    for (int x = 0; x < bars.viewZ.width(); ++x) {
      ASSERT_NEAR(bars.viewZ.at(x, y), 4.2f, 1e-6f) << x << " " << y;  // two roundings to float
      ASSERT_EQ(bars.normal.at(x, y), glm::vec3(0, 0, 1)) << x << " " << y;
    }
}

// Pure filters commute: where nothing reflects, no weight has a say.
TEST_F(Samples, BarsAreExact) {
  ASSERT_EQ(generate("bars").code, 0);
  for (const char* passes : {"1", "4"}) {
    const nlohmann::json error = measured("bars", {"--aa", passes, "--method", "phenomenological"});
    std::printf("bars, --aa %s: rmse %.3g, max %.3g\n", passes, error["rmse"].get<double>(),
                error["max"].get<double>());
    EXPECT_LE(error["max"].get<double>(), 1e-6);
    EXPECT_EQ(error["notFinite"].get<int>(), 0);
  }
  // The red upright bar alone, over white: one filter times the wall. Pixel (115, 80) lies between the cross bars.
  const glm::vec4 before = read("bars.exr").beauty.at(115, 80), after = read("bars-glass.exr").beauty.at(115, 80);
  const glm::vec3 red(0.9f, 0.1f, 0.1f);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(after[c], before[c] * red[c], 1e-3f) << c;  // two roundings to half, 2.5e-4 each below 1
}

TEST_F(Samples, TheCameraInTheGlbIsTheOneInTheExr) {
  ASSERT_EQ(generate("bottles").code, 0);
  measured("bottles", {"--aa", "1"});
  const GBuffer byAttribute = read("bottles-glass.exr");
  measured("bottles", {"--aa", "1", "--camera", "cam"});
  const GBuffer byNode = read("bottles-glass.exr");
  std::size_t differ = 0;
  for (std::size_t i = 0; i < byNode.beauty.size(); ++i)
    if (glm::any(glm::greaterThan(glm::abs(byNode.beauty[i] - byAttribute.beauty[i]), glm::vec4(0.01f)))) ++differ;
  std::printf("%zu of %zu pixels differ by more than 0.01\n", differ, byNode.beauty.size());
  // The attributes are floats: an edge may fall on the other side of a pixel's centre, about once in ten thousand.
  EXPECT_LE(differ, byNode.beauty.size() / 2000);
}

TEST_F(Samples, SortedTruthMeasuresNothingAgainstItself) {
  ASSERT_EQ(generate("bottles").code, 0);
  const nlohmann::json error = measured("bottles", {"--aa", "1"});
  EXPECT_EQ(error["max"].get<double>(), 0.0);
}

// 1 million triangles take no more memory than 200 thousand, where 8 MiB of them may be resident: the file alone has
// 50 MB, decoded it would be 80.
TEST_F(Samples, HairWithinItsBudget) {
  constexpr double kMiB = 1024.0 * 1024.0, kBudget = 8.0, kAllowance = 64.0;
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  double alone = 0;
  for (const char* hairs : {"1", "417", "2084"}) {
    ASSERT_EQ(runProgram({".", "hair", "90", "--hairs", hairs}, generator).code, 0);
    const Ended ended = runProgram(
        {"composite", "hair.exr", "hair.glb", "-o", "out.exr", "--aa", "1", "--budget", "8M", "--stats", "--json"},
        options);
    ASSERT_EQ(ended.code, 0) << ended.err;
    const nlohmann::json statistics = nlohmann::json::parse(ended.out)["statistics"];
    EXPECT_EQ(statistics["triangles"].get<int>(), 480 * std::stoi(hairs));
    const double peak = static_cast<double>(ended.peakBytes) / kMiB;
    if (alone == 0) alone = peak;
    std::printf("%d triangles: peak %.1f MiB, with one hair %.1f\n", statistics["triangles"].get<int>(), peak, alone);
    EXPECT_LE(peak, alone + kBudget + kAllowance);
    // What grows by the triangles is one bit a vertex and a few notes on each thousand triangles.
    if (std::string(hairs) == "2084") {
      EXPECT_LE(peak, alone + kBudget + 24.0);
    }
  }
  const Ended refused = generate("bars", ".", {"90", "--hairs", "5"});
  EXPECT_EQ(refused.code, 2) << refused.err;
}

TEST_F(Samples, TheMainJobRunsOnEach) {
  for (const std::string name : {"bottles", "smoke", "cad"}) {
    ASSERT_EQ(generate(name).code, 0);
    const nlohmann::json error = measured(name, {"--aa", "1", "--method", "phenomenological"});
    std::printf("%s: mean %.3g, rmse %.3g, max %.3g\n", name.c_str(), error["mean"].get<double>(),
                error["rmse"].get<double>(), error["max"].get<double>());
    EXPECT_EQ(error["notFinite"].get<int>(), 0);
    EXPECT_GT(error["rmse"].get<double>(), 0.0);  // layers that reflect: no weighted method is exact here
    const GBuffer before = read(name + ".exr"), after = read(name + "-glass.exr");
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before.beauty.size(); ++i)
      if (before.beauty[i] != after.beauty[i]) ++changed;
    std::printf("%s: %.0f%% of the pixels changed\n", name.c_str(),
                100.0 * static_cast<double>(changed) / static_cast<double>(before.beauty.size()));
    EXPECT_GT(changed, before.beauty.size() / 10);
    EXPECT_LT(changed, before.beauty.size());
    for (const std::string& file : filesIn(folder)) EXPECT_EQ(file.find(".tmp"), std::string::npos) << file;
  }
}

}  // namespace
}  // namespace pellucid
