// Glass that refracts and diffuses looks the same by every method, within a tolerance, and through a deep file.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "composite/error.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class Glass : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("glass-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    // Stripes, so that what is looked up elsewhere shows.
    ExtraLayer beauty{"", {}};
    for (const char* name : {"R", "G", "B"}) {
      Image<float> plane(kSide, kSide);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) plane.at(x, y) = ((x / 4 + y / 8) % 2 ? .9f : .1f) + .001f * float(x + name[0]);
      beauty.channels.emplace_back(name, plane);
    }
    beauty.channels.emplace_back("Z", Image<float>(kSide, kSide, 10.0f));
    writeLayers(folder + "/opaque.exr", {0, 0, kSide, kSide}, {0, 0, kSide, kSide}, {beauty});
  }
  // Frosted glass over the middle, and a solid that stands behind it and beyond its edge.
  std::vector<Quad> paneAndSolid() const {
    nlohmann::json frosted = {
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"metallicFactor", 0.0}, {"roughnessFactor", 0.3}, {"baseColorFactor", {.9, .5, .7, 1}}}},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
          {"KHR_materials_volume", {{"thicknessFactor", 0.2}}}}}};
    return {Quad{{-1.2f, -1, -3}, {1.8f, 0, .8f}, {0, 2, .3f}, frosted},
            Quad{{-.6f, -.7f, -5}, {2, 0, 0}, {0, 1.2f, 0}, unlit(.2f, .9f, .3f, 1)}};
  }
  Ended run(const std::vector<std::string>& arguments) const {
    Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended;
  }
  Image<glm::vec4> picture(const std::string& name) const { return readOpaque(folder + "/" + name, {}).gbuffer.beauty; }
  ErrorStatistics difference(const std::string& a, const std::string& b) const {
    return measureError(picture(a), picture(b));
  }
  static constexpr int kSide = 64;
  std::string folder;
  RunOptions options;
};

TEST_F(Glass, OneLayerOverASolidIsTheTruthByEveryMethod) {
  writeGlb(folder + "/pane.glb", paneAndSolid());
  const std::vector<std::string> over{"composite", "opaque.exr", "pane.glb", "-o",  "over.exr",
                                      "--aa",      "1",          "--method", "over"};
  run(over);
  std::vector<std::string> off = over;
  off[4] = "off.exr";
  off.insert(off.end(), {"--refract", "off", "--diffusion", "off"});
  run(off);
  EXPECT_GT(difference("over.exr", "off.exr").mean, .01);  // there is something to look up
  const nlohmann::json rows =
      nlohmann::json::parse(run({"study", "opaque.exr", "pane.glb", "-o", "study", "--json"}).out);
  double worst = 0;
  for (const auto& row : rows) {
    EXPECT_LE(row["max"].get<double>(), 4e-6) << row["method"];  // float sums against double ones
    worst = std::max(worst, row["max"].get<double>());
  }
  run({"composite", "opaque.exr", "pane.glb", "-o", "within.exr", "--aa", "1", "--tolerance", ".004"});
  EXPECT_LE(difference("within.exr", "over.exr").maximum, 4e-6);
  std::printf("[ figure ] refracting, diffusing glass over a solid, %zu methods: worst %.3g\n", rows.size(), worst);
}

TEST_F(Glass, ThroughADeepFile) {
  writeGlb(folder + "/pane.glb", paneAndSolid());
  run({"fragments", "opaque.exr", "pane.glb", "-o", "deep.exr"});
  for (const std::string method : {"over", "phenomenological", "average", "wavelet"}) {
    run({"composite", "opaque.exr", "pane.glb", "-o", "direct.exr", "--aa", "1", "--method", method});
    run({"composite", "opaque.exr", "deep.exr", "-o", "via.exr", "--aa", "1", "--method", method});
    const double worst = difference("direct.exr", "via.exr").maximum;
    std::printf("[ figure ] %s glass through a deep file: worst difference %.3g\n", method.c_str(), worst);
    EXPECT_LE(worst, 1e-6);
  }
}

TEST_F(Glass, ToleranceHoldsBehindLookups) {
  std::vector<Quad> quads = paneAndSolid();
  for (int i = 0; i < 6; ++i) {
    const float k = static_cast<float>(i);
    quads.push_back({{-1.5f + .3f * k, -1, -2 - .3f * k},
                     {2, 0, .1f * k},
                     {0, 2, 0},
                     unlit(.3f + .1f * k, .8f - .1f * k, .4f, i < 3 ? .02f : .4f)});
  }
  writeGlb(folder + "/pane.glb", quads);
  run({"composite", "opaque.exr", "pane.glb", "-o", "over.exr", "--aa", "1", "--method", "over"});
  for (const double tolerance : {.004, .1}) {
    const nlohmann::json report =
        nlohmann::json::parse(run({"composite", "opaque.exr", "pane.glb", "-o", "within.exr", "--aa", "1",
                                   "--tolerance", std::to_string(tolerance), "--json"})
                                  .out);
    const Image<glm::vec4> x = picture("within.exr"), truth = picture("over.exr");
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, static_cast<double>(std::abs(x[i][c] - truth[i][c])) /
                                    std::max(1.0, static_cast<double>(std::abs(x[i][c]))));
    std::printf("[ figure ] tolerance %g with lookups: worst %.3g, %d certified, %d recomputed\n", tolerance, worst,
                report["tolerance"]["certified"].get<int>(), report["tolerance"]["recomputed"].get<int>());
    EXPECT_LE(worst, tolerance + 1e-6);  // the pictures' own rounding to float
    EXPECT_GT(report["tolerance"]["certified"].get<int>(), 0);
    EXPECT_GT(report["tolerance"]["recomputed"].get<int>(), 0);
  }
}

}  // namespace
}  // namespace pellucid
