// --system-weight: each system's layers by a weight of their own.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// Two tight clusters of cards of mixed colours, a file each, before a wall.
class SystemWeights : public ::testing::Test {
 protected:
  void SetUp() override {
    folder =
        freshFolder(std::string("system-weights-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    OpaqueShot wall;
    wall.depth = 60.0f;
    writeOpaque(folder + "/wall.exr", wall);
    Random random(12);
    for (const bool near : {true, false}) {
      std::vector<Quad> quads;
      for (int i = 0; i < 8; ++i) {
        const float z = (near ? 3.0f : 30.0f) + (near ? .5f : 6.0f) * random.uniformf(), size = near ? .1f : 1.0f;
        quads.push_back({{size * (-20 + 8 * random.uniformf()), size * (-20 + 8 * random.uniformf()), -z},
                         {size * 30, 0, 0},
                         {0, size * 30, 0},
                         unlit(random.uniformf(), random.uniformf(), random.uniformf(), .4f)});
      }
      writeGlb(folder + (near ? "/near.glb" : "/far.glb"), quads);
    }
  }
  Ended composite(std::vector<std::string> arguments, const std::vector<std::string>& more) const {
    arguments.insert(arguments.begin(), "composite");
    arguments.insert(arguments.end(),
                     {"--camera", "eye=0,0,0;look=0,0,-1;up=0,1,0;fov=53.130102354155975", "--aa", "1"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  Image<glm::vec4> picture(const std::string& name) const { return readOpaque(folder + "/" + name, {}).gbuffer.beauty; }
  std::string folder;
  RunOptions options;
};

TEST_F(SystemWeights, EachIsWhatItIsAloneAndTheNearOneIsOverTheFarOne) {
  for (const char* method : {"weighted", "phenomenological", "front+tail"}) {
    const Ended both = composite({"wall.exr", "near.glb", "far.glb", "-o", "both.exr"},
                                 {"--method", method, "--systems", "file", "--system-weight", "near.glb=power:6",
                                  "--system-weight", "far.glb=eq7"});
    ASSERT_EQ(both.code, 0) << both.err;
    ASSERT_EQ(composite({"wall.exr", "far.glb", "-o", "far.exr"}, {"--method", method, "--weight", "eq7"}).code, 0);
    ASSERT_EQ(composite({"far.exr", "near.glb", "-o", "one.exr"}, {"--method", method, "--weight", "power:6"}).code, 0);
    const Image<glm::vec4> a = picture("both.exr"), b = picture("one.exr");
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c])));
    std::printf("[ figure ] %s: two systems with a weight each, off one over the other by %.2g\n", method, worst);
    EXPECT_LE(worst, 1e-6) << method;
    // They are not what one weight for both gives.
    ASSERT_EQ(composite({"wall.exr", "near.glb", "far.glb", "-o", "same.exr"},
                        {"--method", method, "--systems", "file", "--weight", "eq7"})
                  .code,
              0);
    const Image<glm::vec4> same = picture("same.exr");
    double apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      apart = std::max(apart, std::abs(static_cast<double>(a[i].r) - static_cast<double>(same[i].r)));
    EXPECT_GT(apart, 1e-3) << method;
  }
}

TEST_F(SystemWeights, AutoFitsASystemAlone) {
  const auto errorOf = [&](const std::vector<std::string>& weights) {
    std::vector<std::string> flags{"--method", "weighted", "--systems", "file", "--measure", "--json"};
    flags.insert(flags.end(), weights.begin(), weights.end());
    const Ended ended = composite({"wall.exr", "near.glb", "far.glb", "-o", "out.exr"}, flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    if (weights.size() > 2) {
      EXPECT_NE(ended.err.find("--system-weight far.glb=auto: mean error"), std::string::npos) << ended.err;
    }
    return nlohmann::json::parse(ended.out)["error"]["mean"].get<double>();
  };
  const double shared = errorOf({"--weight", "auto"});
  const double own = errorOf({"--system-weight", "near.glb=auto", "--system-weight", "far.glb=auto"});
  const double eq5 = errorOf({});
  std::printf("[ figure ] mean error: eq5 %.5f, one fitted weight %.5f, one for each system %.5f\n", eq5, shared, own);
  EXPECT_LT(own, eq5);
  EXPECT_LE(own, shared * 1.02);  // what a weight is within of the best, of one as of two
}

TEST_F(SystemWeights, GoFromHeaderToPicture) {
  ASSERT_EQ(composite({"wall.exr", "near.glb", "far.glb", "-o", "both.exr"},
                      {"--method", "weighted", "--systems", "file", "--system-weight", "near.glb=power:6",
                       "--system-weight", "far.glb=auto"})
                .code,
            0);
  ASSERT_EQ(composite({"wall.exr", "near.glb", "far.glb", "-o", "again.exr"}, {"--method-from", "both.exr"}).code, 0);
  const Image<glm::vec4> a = picture("both.exr"), b = picture("again.exr");
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i], b[i]);
}

TEST_F(SystemWeights, WrongOnesAreRefused) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& says) {
    const Ended ended = composite({"wall.exr", "near.glb", "far.glb", "-o", "out.exr"}, more);
    EXPECT_EQ(ended.code, 2) << more.back() << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
  };
  refused({"--system-weight", "near.glb=eq7"}, "--systems");
  refused({"--systems", "file", "--system-weight", "eq7"}, "NAME=WEIGHT");
  refused({"--systems", "file", "--system-weight", "near.glb=eq77"}, "eq77");
  refused({"--systems", "file", "--system-weight", "smoke.glb=eq7"}, "no system 'smoke.glb'");
  refused({"--systems", "file", "--method", "sum", "--system-weight", "near.glb=eq7"}, "not weighed");
  refused({"--systems", "file", "--system-weight", "near.glb=eq7", "--system-weight", "near.glb=eq8"}, "twice");
}

}  // namespace
}  // namespace pellucid
