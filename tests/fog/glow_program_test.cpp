// Several grids, emission and diffusion of fog as a user meets them.
#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/blackbody.h"
#include "tests/fog/fog_program.h"

namespace pellucid {
namespace {

using namespace test;

// How much longer than its depth a ray of the 64 pixels is.
double stretchAt(int x, int y) {
  const double across = (x + .5 - 32) / 64, down = (y + .5 - 32) / 64;
  return std::sqrt(1 + across * across + down * down);
}

class GlowingFog : public FogProgram {
 protected:
  // Smoke of .3 a metre and flames of .5 from 2 to 5 m, heat from 4 to 5 m.
  void SetUp() override {
    FogProgram::SetUp();
    openvdb::initialize();
    writeGrids("fire.vdb",
               {evenGrid("density", .3f, 2, 5), evenGrid("flames", .5f, 2, 5), evenGrid("temperature", 1.5f, 4, 5)});
    writeGrids("near.vdb", {evenGrid("density", .3f, 2, 3)});
    writeGrids("far.vdb", {evenGrid("density", .3f, 3, 5)});
  }
  // What fire.vdb gives with emission=E and albedo=0, closed form: a metre before the pane's depth, two behind.
  static double fire(int x, int y, double emission, double wall) {
    const double s = stretchAt(x, y);
    const bool inPane = 3 * std::abs(x + .5 - 32) / 64 < 1 && 3 * std::abs(y + .5 - 32) / 64 < 1;
    const auto flames = [&](double metres) { return .5 * emission * -std::expm1(-.3 * metres * s) / .3; };
    const double behind = flames(2) + std::exp(-.3 * 2 * s) * wall;  // as it leaves 3 m
    return flames(1) + std::exp(-.3 * s) * (inPane ? .5 * .2 + .5 * behind : behind);
  }
};

const std::vector<std::string> kFire{
    "--fog-grid", "fire.vdb:density", "--fog-grid", "fire.vdb:flames", "--fog", "albedo=0,emission=4:2:1,steps=48"};

std::vector<std::string> with(std::vector<std::string> flags, const std::vector<std::string>& more) {
  flags.insert(flags.end(), more.begin(), more.end());
  return flags;
}

TEST_F(GlowingFog, FlamesShineThroughSmokeAndPane) {
  ASSERT_EQ(run(with(kFire, {"--method", "over"})).code, 0);
  const Image<glm::vec4> out = picture();
  for (const int x : {3, 31, 40})
    for (const int y : {10, 32}) EXPECT_NEAR(out.at(x, y).r, fire(x, y, 4.0, .25), 2e-5) << x << ' ' << y;
}

TEST_F(GlowingFog, EveryMethodTierAndNumberOfPassesShowsIt) {
  const double alone = fire(2, 2, 4.0, .25);
  for (const char* method : {"phenomenological", "weighted", "blended", "average", "over", "unsorted", "front+tail",
                             "wavelet:2", "moments:4", "mlab:4", "stochastic"})
    for (const char* passes : {"1", "8"}) {
      const Ended ended = run(with(kFire, {"--method", method, "--aa", passes}));
      ASSERT_EQ(ended.code, 0) << method << ended.err;
      const bool noisy = std::string(method) == "stochastic";
      EXPECT_NEAR(picture().at(2, 2).r, alone,
                  noisy                        ? 1.0
                  : std::string(passes) == "1" ? 2e-5
                                               : .01)
          << method << passes;
    }
  for (const char* precision : {"float", "exact", "published"}) {
    ASSERT_EQ(run(with(kFire, {"--method", "phenomenological", "--precision", precision})).code, 0);
    // Halves and transmittance in 256 steps.
    EXPECT_NEAR(picture().at(2, 2).r, alone, std::string(precision) == "published" ? .02 : 2e-5) << precision;
  }
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--systems", "file"},
           {"--tolerance", "0.001"},
           {"--method", "auto", "--tolerance", "0.01"},
           {"--method", "phenomenological", "--resolve", "gl"},
           {"--method", "phenomenological", "--weight", "auto"},
           {"--method", "phenomenological", "--fog", "albedo=0,emission=4:2:1,steps=48,order=sums"}}) {
    const Ended ended = run(with(more.back().find("order=sums") == std::string::npos
                                     ? kFire
                                     : std::vector<std::string>(kFire.begin(), kFire.begin() + 4),
                                 more));
    ASSERT_EQ(ended.code, 0) << more[0] << ended.err;
    EXPECT_NEAR(picture().at(2, 2).r, alone, 2e-5) << more[0] << more.back();
  }
}

TEST_F(GlowingFog, LowResolutionDeepPicturesAndTwoSteps) {
  nlohmann::json pane = unlit(.2f, .4f, .6f, .5f);
  pane["name"] = "pane";
  writeGlb(folder + "/pane.glb", {Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, pane}});
  for (const char* method : {"over", "phenomenological"}) {
    const Ended low = run(with(kFire, {"--method", method, "--set", "pane.lowResolution=true"}));
    ASSERT_EQ(low.code, 0) << low.err;
    EXPECT_NEAR(picture().at(2, 2).r, fire(2, 2, 4.0, .25), 2e-5) << method;
  }
  ASSERT_EQ(run(with(kFire, {"--method", "phenomenological"})).code, 0);
  const Image<glm::vec4> once = picture();
  ASSERT_EQ(run(kFire, "accumulate").code, 0);
  ASSERT_EQ(std::rename((folder + "/out.exr").c_str(), (folder + "/planes.exr").c_str()), 0);
  ASSERT_EQ(runProgram({"resolve", "shot.exr", "planes.exr", "-o", "out.exr"}, options).code, 0);
  const Image<glm::vec4> twice = picture();
  for (std::size_t i = 0; i < once.size(); ++i) ASSERT_EQ(once[i], twice[i]);
  // The fragments as a deep file, composited by `over`, and as the deep picture behind nothing else.
  ASSERT_EQ(run(with(kFire, {"--method", "over"})).code, 0);
  const Image<glm::vec4> over = picture();
  ASSERT_EQ(run(kFire, "fragments").code, 0);
  ASSERT_EQ(std::rename((folder + "/out.exr").c_str(), (folder + "/deep.exr").c_str()), 0);
  ASSERT_EQ(runProgram({"composite", "shot.exr", "deep.exr", "-o", "out.exr", "--method", "over"}, options).code, 0);
  const Image<glm::vec4> again = picture();
  for (std::size_t i = 0; i < over.size(); ++i) ASSERT_NEAR(over[i].r, again[i].r, 2e-5f);
}

TEST_F(GlowingFog, StudyMeasuresIt) {
  const Ended ended =
      runProgram(with({"study", "shot.exr", "pane.glb", "-o", "study", "--repeats", "1"}, kFire), options);
  EXPECT_EQ(ended.code, 0) << ended.err;
}

// Two files are the smoke of one; and so is one file twice at half the density.
TEST_F(GlowingFog, DensitiesOfFilesAddUp) {
  ASSERT_EQ(run({"--fog-grid", "fire.vdb:density", "--fog", "steps=48"}).code, 0);
  const Image<glm::vec4> one = picture();
  ASSERT_EQ(run({"--fog-grid", "near.vdb", "--fog-grid", "far.vdb", "--fog", "steps=48"}).code, 0);
  const Image<glm::vec4> two = picture();
  ASSERT_EQ(run({"--fog-grid", "fire.vdb", "--fog-grid", "fire.vdb", "--fog", "steps=48,density=0.5"}).code, 0);
  const Image<glm::vec4> twice = picture();
  double worst = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    worst = std::max({worst, static_cast<double>(std::abs(one[i].b - two[i].b)),
                      static_cast<double>(std::abs(one[i].b - twice[i].b))});
  EXPECT_LT(worst, 2e-6);
}

TEST_F(GlowingFog, TemperatureIsABlackBody) {
  const Ended ended =
      run({"--fog-grid", "fire.vdb:temperature", "--fog", "kelvin=1000,blackbody=0.05", "--method", "over"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("as temperature"), std::string::npos) << ended.err;
  const glm::vec4 got = picture().at(2, 2);
  const glm::dvec3 body = glm::max(blackbodyRadiance(1500.0), 0.0);
  EXPECT_NEAR(got.r, .25 + .05 * body.r * stretchAt(2, 2), 1e-5 * body.r);
  EXPECT_NEAR(got.b, .75 + .05 * body.b * stretchAt(2, 2), 1e-5);
  EXPECT_GT(body.r, body.g);
  // The same by its role, whatever it is called.
  ASSERT_EQ(run({"--fog-grid", "fire.vdb:flames=temperature", "--fog", "kelvin=3000,blackbody=0.05"}).code, 0);
  EXPECT_NEAR(picture().at(2, 2).r, .25 + 3 * (static_cast<double>(got.r) - .25), 1e-5 * body.r);  // 3 m of it
}

TEST_F(GlowingFog, WrongGridsAreRefused) {
  const auto refused = [&](const std::vector<std::string>& extra, int code, const std::string& says) {
    const Ended ended = run(extra);
    EXPECT_EQ(ended.code, code) << extra.back() << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
  };
  refused({"--fog-grid", "fire.vdb:flames=heat"}, 2, "expected density, emission or temperature");
  refused({"--fog-grid", "fire.vdb=emission"}, 4, "a float grid `emission`");
  refused({"--fog-grid", "fire.vdb:flames", "--fog", "density=2"}, 2, "density");
  refused({"--fog-grid", "fire.vdb:flames", "--fog", "collimation=0.5"}, 2, "collimation");
  refused({"--fog-grid", "fire.vdb", "--fog", "kelvin=1000"}, 2, "kelvin");
  refused({"--fog-grid", "fire.vdb:temperature", "--fog", "emission=2"}, 2, "emission");
  refused({"--fog", "density=1,emission=-1"}, 2, "emission=-1");
  refused({"--fog", "density=1,collimation=1.5"}, 2, "collimation=1.5");
  refused({"--fog-grid", "fire.vdb", "--fog-grid", "none.vdb"}, 3, "none.vdb");
}

// Left half dark, right half bright, fog before it: the edge is as wide as eq. 7 says.
class DiffusingFog : public FogProgram {
 protected:
  static constexpr int kWidth = 256, kHeight = 64;
  void SetUp() override {
    FogProgram::SetUp();
    writeShot("step.exr", [](int x) { return x < kWidth / 2 ? 0.0f : 1.0f; });
    writeShot("white.exr", [](int) { return 1.0f; });
    // A pane beside the picture, so that there is a scene.
    writeGlb(folder + "/pane.glb", {Quad{{500, 500, -3}, {2, 0, 0}, {0, 2, 0}, unlit(.2f, .4f, .6f, .5f)}});
  }
  void writeShot(const std::string& name, float (*light)(int x)) const {
    Image<float> lit(kWidth, kHeight, 0.0f), ones(kWidth, kHeight, 1.0f), depth(kWidth, kHeight, 6.0f);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) lit.at(x, y) = light(x);
    const Window window{0, 0, kWidth, kHeight};
    writeLayers(folder + "/" + name, window, window,
                {{"", {{"R", lit}, {"G", lit}, {"B", lit}, {"A", ones}, {"Z", depth}}}});
  }
  // The step seen through the layers, and where all behind is white.
  Image<glm::vec4> seen(const std::string& name, const std::vector<std::string>& flags) const {
    EXPECT_EQ(std::rename((folder + "/" + name).c_str(), (folder + "/shot.exr").c_str()), 0);
    const Ended ended = run(flags);
    EXPECT_EQ(ended.code, 0) << flags.back() << ended.err;
    EXPECT_EQ(std::rename((folder + "/shot.exr").c_str(), (folder + "/" + name).c_str()), 0);
    return picture();
  }
  // Standard deviation of the middle row's edge, pixels: of the line spread, which is how the profile rises from pixel
  // to pixel. What the layers leave of the light differs along the row, and is divided by.
  double widthOf(const std::vector<std::string>& flags) const {
    const Image<glm::vec4> step = seen("step.exr", flags), white = seen("white.exr", flags);
    double mass = 0, mean = 0, square = 0, before = 0;
    for (int x = 0; x < kWidth; ++x) {
      const double here =
          static_cast<double>(step.at(x, kHeight / 2).r) / static_cast<double>(white.at(x, kHeight / 2).r);
      mass += here - before;
      mean += (here - before) * x;
      square += (here - before) * x * x;
      before = here;
    }
    mean /= mass;
    return std::sqrt(square / mass - mean * mean);
  }
  // PT17 eq. 7 of even fog from the eye to 6 m, near the axis.
  static double expected(double density, double collimation) {
    const double beta = std::exp(-density * 6.0), hides = 1.0 - beta;
    const double z = 1.0 / density - 6.0 * beta / hides;  // mean depth of what is seen of it
    const double behind = 6.0 - z;
    const double focal = kHeight;  // the picture is z metres high at z
    return focal * 0.3 * hides * (1.0 - collimation) * (behind / (behind + 0.5)) / z;
  }
};

TEST_F(DiffusingFog, TheWidthOfAnEdgeIsThatOfTheEquation) {
  // Optical depth of even fog is a closed form, whatever the steps.
  for (const double density : {0.1, 0.4})
    for (const double collimation : {0.2, 0.6}) {
      const std::string fog = fmt::format("density={},collimation={},albedo=0,steps=16", density, collimation);
      const double wanted = expected(density, collimation);
      const bool everyWay = density == 0.1 && collimation == 0.2;
      std::size_t tried = 0;
      for (const std::vector<std::string>& way :
           std::vector<std::vector<std::string>>{{"--method", "over"},
                                                 {"--method", "phenomenological"},
                                                 {"--method", "phenomenological", "--precision", "exact"},
                                                 {"--method", "phenomenological", "--resolve", "gl"},
                                                 {"--method", "phenomenological", "--aa", "4"},
                                                 {"--method", "over", "--aa", "4", "--edges", "off"},
                                                 {"--method", "front+tail"},
                                                 {"--method", "moments:4"},
                                                 {"--systems", "file"},
                                                 {"--tolerance", "0.001"},
                                                 {"--gather", "exact"}}) {
        if (!everyWay && ++tried > 2) break;
        const double width = widthOf(with({"--fog", fog}, way));
        std::string all;
        for (const std::string& each : way) all += " " + each;
        std::printf("[ figure ] density %.1f, collimation %.1f,%s: %.3f px, by eq. 7 %.3f\n", density, collimation,
                    all.c_str(), width, wanted);
        // Rays beside the axis are longer: by 2% two of the widest standard deviations away.
        EXPECT_NEAR(width / wanted, 1.0, 0.01) << all;
      }
    }
}

// Fog that diffuses nothing is the fog that says nothing of it.
TEST_F(DiffusingFog, CollimatedFogKeepsItsBits) {
  const Image<glm::vec4> sharp = seen("step.exr", {"--fog", "density=0.3"});
  const Image<glm::vec4> same = seen("step.exr", {"--fog", "density=0.3,collimation=1"});
  const Image<glm::vec4> off = seen("step.exr", {"--fog", "density=0.3,collimation=0.3", "--diffusion", "off"});
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    ASSERT_EQ(sharp[i], same[i]);
    ASSERT_EQ(sharp[i], off[i]);
  }
}

// Panes cut the fog into runs for methods from lists: its spread stays that of all of it, in one of them.
TEST_F(DiffusingFog, PanesDoNotChangeHowFarItSpreads) {
  const std::vector<std::string> fog{"--fog", "density=0.4,collimation=0.5,albedo=0,steps=256"};
  const double alone = widthOf(with(fog, {"--method", "over"}));
  writeGlb(folder + "/pane.glb", {Quad{{-20, -20, -1.5}, {40, 0, 0}, {0, 40, 0}, unlit(0, 0, 0, .5f)},
                                  Quad{{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, unlit(0, 0, 0, .2f)}});
  for (const char* method : {"over", "phenomenological"}) {
    EXPECT_NEAR(widthOf(with(fog, {"--method", method})), alone, 1e-3 * alone) << method;
  }
}

}  // namespace
}  // namespace pellucid
