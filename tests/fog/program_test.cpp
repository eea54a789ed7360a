// --fog and --fog-grid as a user meets them.
#include <cmath>
#include <fstream>

#include "tests/fog/fog_program.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;

// Fog before and behind a pane: `over` is the closed form, and so is every tier where nothing reflects but the fog.
TEST_F(FogProgram, OverIsTheClosedForm) {
  ASSERT_EQ(run({"--fog", "density=0.2,albedo=0.9:0.8:0.7", "--method", "over"}).code, 0);
  const Image<glm::vec4> out = picture();
  const double ambient[] = {.6, .7, .8}, albedo[] = {.9, .8, .7}, pane[] = {.2, .4, .6}, wall[] = {.25, .5, .75};
  for (const int x : {5, 31, 40})
    for (const int y : {10, 32}) {
      const double across = (x + .5 - 32) / 64, down = (y + .5 - 32) / 64;  // the picture is z metres high at z
      const double stretch = std::sqrt(1 + across * across + down * down);
      const bool inPane = std::abs(3 * across) < 1 && std::abs(3 * down) < 1;
      for (int c = 0; c < 3; ++c) {
        const double half = std::exp(-.2 * 3 * stretch), light = ambient[c] * albedo[c];
        double wanted = light * (1 - half) + half * wall[c];
        if (inPane) wanted = .5 * pane[c] + .5 * wanted;
        wanted = light * (1 - half) + half * wanted;
        EXPECT_NEAR(out.at(x, y)[c], wanted, 2e-6) << x << ' ' << y;
      }
    }
}

TEST_F(FogProgram, EveryMethodAndTierTakesIt) {
  for (const char* method : {"phenomenological", "weighted", "blended", "average", "sum", "over", "unsorted",
                             "front+tail", "wavelet:2", "moments:4", "mlab:4", "stochastic"}) {
    const Ended ended = run({"--fog", "density=0.2", "--method", method});
    ASSERT_EQ(ended.code, 0) << method << ended.err;
    const glm::vec4 out = picture().at(2, 2);  // beside the pane: fog alone
    const double across = 29.5 / 64, beta = std::exp(-.2 * 6 * std::sqrt(1 + 2 * across * across));
    const bool noisy = std::string(method) == "stochastic";
    EXPECT_NEAR(out.r, .6 * (1 - beta) + beta * .25, noisy ? .2 : 1e-5) << method;
  }
  for (const char* precision : {"float", "exact"}) {
    ASSERT_EQ(run({"--fog", "density=0.2", "--method", "phenomenological", "--precision", precision}).code, 0);
    const Image<glm::vec4> out = picture();
    static Image<glm::vec4> first;
    if (first.empty()) first = out;
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i].r, first[i].r, 2e-6f);
  }
  EXPECT_EQ(run({"--fog", "density=0.2", "--tolerance", "0.001"}).code, 0);
  EXPECT_EQ(run({"--fog", "density=0.2", "--measure"}).code, 0);
}

TEST_F(FogProgram, TwoStepsAreOne) {
  ASSERT_EQ(run({"--fog", "density=0.2,height=2", "--method", "phenomenological"}).code, 0);
  const Image<glm::vec4> once = picture();
  ASSERT_EQ(run({"--fog", "density=0.2,height=2"}, "accumulate").code, 0);
  ASSERT_EQ(std::rename((folder + "/out.exr").c_str(), (folder + "/planes.exr").c_str()), 0);
  ASSERT_EQ(runProgram({"resolve", "shot.exr", "planes.exr", "-o", "out.exr"}, options).code, 0);
  const Image<glm::vec4> twice = picture();
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i], twice[i]);
}

TEST_F(FogProgram, FragmentsFlattenToOver) {
  ASSERT_EQ(run({"--fog", "density=0.2", "--method", "over"}).code, 0);
  const Image<glm::vec4> over = picture();
  ASSERT_EQ(run({"--fog", "density=0.2"}, "fragments").code, 0);
  ASSERT_EQ(std::rename((folder + "/out.exr").c_str(), (folder + "/deep.exr").c_str()), 0);
  ASSERT_EQ(runProgram({"composite", "shot.exr", "deep.exr", "-o", "out.exr", "--method", "over"}, options).code, 0);
  const Image<glm::vec4> again = picture();
  for (std::size_t i = 0; i < over.size(); ++i) EXPECT_NEAR(over[i].g, again[i].g, 2e-6f);
}

// Layers of low resolution cut the fog as those of full resolution do: it lay behind all of them.
TEST_F(FogProgram, LayersOfLowResolutionStandInIt) {
  int sheets = 0;
  const auto write = [&](int count) {  // that fill the view, 2 m away and more
    sheets = count;
    std::vector<Quad> quads;
    for (int k = 0; k < count; ++k) {
      const float z = 2.0f + static_cast<float>(k);
      quads.push_back({{-2 * z, -2 * z, -z}, {4 * z, 0, 0}, {0, 4 * z, 0}, unlit(.9f, .2f * z, .1f, .4f)});
    }
    writeGlb(folder + "/pane.glb", quads);
  };
  const auto differs = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> given{"--fog", "density=0.2"};
    given.insert(given.end(), flags.begin(), flags.end());
    EXPECT_EQ(run(given).code, 0);
    const Image<glm::vec4> full = picture();
    for (int k = 0; k < sheets; ++k)
      given.insert(given.end(), {"--set", "material_" + std::to_string(k) + ".lowResolution=true"});
    EXPECT_EQ(run(given).code, 0);
    const Image<glm::vec4> low = picture();
    float worst = 0.0f;
    for (std::size_t i = 0; i < low.size(); ++i)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(low[i][c] - full[i][c]));
    return worst;
  };
  write(1);
  for (const char* method : {"over", "weighted", "average", "front+tail", "mlab:4"}) {
    std::vector<std::string> flags{"--method", method};
    if (flags[1] == "weighted") flags.insert(flags.end(), {"--weight", "uniform"});
    EXPECT_LE(differs(flags), 2e-6f) << method;
  }
  write(4);
  EXPECT_LE(differs({}), 2e-6f);
  EXPECT_LE(differs({"--aa", "4"}), 2e-6f);
  EXPECT_LE(differs({"--tolerance", "0.001"}), 0.002f);  // of each
}

TEST_F(FogProgram, JsonIsTheSameAsTheList) {
  ASSERT_EQ(run({"--fog", "density=0.2,albedo=0.9:0.8:0.7,box=-1:-1:-5:1:1:-1,g=-0.3"}).code, 0);
  const Image<glm::vec4> list = picture();
  std::ofstream(folder + "/fog.json")
      << R"({"density": 0.2, "albedo": [0.9, 0.8, 0.7], "box": [-1, -1, -5, 1, 1, -1], "g": -0.3})";
  ASSERT_EQ(run({"--fog", "fog.json"}).code, 0);
  const Image<glm::vec4> json = picture();
  for (std::size_t i = 0; i < list.size(); ++i) EXPECT_EQ(list[i], json[i]);
}

TEST_F(FogProgram, WrongFogIsRefused) {
  const auto refused = [&](const std::vector<std::string>& extra, int code, const std::string& says) {
    const Ended ended = run(extra);
    EXPECT_EQ(ended.code, code) << extra.back() << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
    EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"bad.json", "list.json", "pane.glb", "shot.exr"}))
        << extra.back();
  };
  std::ofstream(folder + "/bad.json") << "{\"density\": ";
  std::ofstream(folder + "/list.json") << "{\"density\": -1}";
  refused({"--fog", "density"}, 2, "key=value");
  refused({"--fog", "thickness=1"}, 2, "thickness");
  refused({"--fog", "density=-1"}, 2, "density=-1");
  refused({"--fog", "density=1,g=0.1,density=2"}, 2, "density twice");
  refused({"--fog", "density=nan"}, 2, "expected numbers");
  refused({"--fog", "density=1e999"}, 2, "expected numbers");
  refused({"--fog", "g=0.5"}, 2, "density of 0");
  refused({"--fog", "density=1,g=1"}, 2, "g=1");
  refused({"--fog", "density=1,steps=2.5"}, 2, "whole");
  refused({"--fog", "density=1,steps=0"}, 2, "steps=0");
  refused({"--fog", "density=1,albedo=0.5:0.5"}, 2, "albedo");
  refused({"--fog", "density=1,box=0:0:0:1:1:0"}, 2, "box");
  refused({"--fog", "none.json"}, 3, "no such file");
  refused({"--fog", "bad.json"}, 3, "bad.json");
  refused({"--fog", "list.json"}, 3, "density=-1");
  refused({"--fog-grid", "none.vdb"}, 3, "none.vdb");
  refused({"--fog-grid", "shot.exr"}, 3, "shot.exr");
  refused({"--fog-grid", "shot.exr", "--fog", "height=3"}, 2, "height");
}

TEST_F(FogProgram, AGridLiesWhereItsFileSays) {
  writeVdb("ball.vdb");
  ASSERT_EQ(run({"--fog-grid", "ball.vdb", "--fog", "density=2,steps=256", "--method", "over"}).code, 0);
  const Image<glm::vec4> out = picture();
  // A ball of radius .8 to .85 m about (0, 0, -4), density 2: through its middle 17 voxels.
  const double beta = std::exp(-2 * 1.7);
  const double behind = .5 * .6 + .5 * ((1 - beta) * .8 + beta * .75);  // the pane stands at 3 m, before it
  EXPECT_NEAR(out.at(32, 32).b, behind, .003);
  EXPECT_EQ(out.at(2, 2), glm::vec4(.25f, .5f, .75f, 1));  // beside it, to the bit
  // The same with z up, which puts it elsewhere.
  ASSERT_EQ(run({"--fog-grid", "ball.vdb:density", "--fog", "density=2,up=z", "--method", "over"}).code, 0);
  EXPECT_NEAR(picture().at(32, 32).b, .5 * .6 + .5 * .75, 1e-6);
}

TEST_F(FogProgram, OddGridsAreRefusedOrRepaired) {
  const auto code = [&](const std::string& name, const std::string& says) {
    const Ended ended = run({"--fog-grid", name});
    EXPECT_NE(ended.err.find(says), std::string::npos) << name << ended.err;
    return ended.code;
  };
  writeVdb("level.vdb", [](openvdb::FloatGrid& grid) { grid.setGridClass(openvdb::GRID_LEVEL_SET); });
  EXPECT_EQ(code("level.vdb", "level set"), 4);
  writeVdb("empty.vdb", [](openvdb::FloatGrid& grid) { grid.clear(); });
  EXPECT_EQ(code("empty.vdb", "no active voxel"), 4);
  writeVdb("huge.vdb", [](openvdb::FloatGrid& grid) { grid.tree().setValue({1 << 20, 1 << 20, 1 << 20}, 1.0f); });
  EXPECT_EQ(code("huge.vdb", "voxels"), 6);
  EXPECT_EQ(code("huge.vdb:heat", "heat"), 4);
  writeVdb("bent.vdb", [](openvdb::FloatGrid& grid) {
    grid.setTransform(
        openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 1.0, 1.0));
  });
  EXPECT_EQ(code("bent.vdb", "transform"), 4);
  writeVdb("odd.vdb", [](openvdb::FloatGrid& grid) {
    grid.tree().setValue({0, 0, -40}, -1.0f);
    grid.tree().setValue({0, 1, -40}, std::nanf(""));
    grid.tree().setValue({1, 1, -40}, INFINITY);
  });
  EXPECT_EQ(code("odd.vdb", "not finite"), 0);
  for (const Image<glm::vec4> out = picture();
       const glm::vec4& pixel : std::vector<glm::vec4>(out.data(), out.data() + out.size()))
    ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
}

// Cut short anywhere, or with bytes changed: never more than an error of one sentence.
TEST_F(FogProgram, DamagedGridsEndInAnError) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP()
      << "OpenVDB's own reader leaks when it throws, and asks for sizes of damaged files that the sanitizer refuses";
#else
  writeVdb("ball.vdb");
  const std::string whole = slurp(folder + "/ball.vdb");
  Random random(7);
  for (int i = 0; i < 12; ++i) {
    std::string broken = whole.substr(0, i < 8 ? whole.size() * static_cast<std::size_t>(i) / 8 : whole.size());
    if (i >= 8)
      for (int k = 0; k < 3; ++k)
        broken[random.below(static_cast<std::uint32_t>(std::min<std::size_t>(whole.size(), 600)))] ^= 0x5a;
    std::ofstream(folder + "/broken.vdb", std::ios::binary) << broken;
    const Ended ended = run({"--fog-grid", "broken.vdb"});
    EXPECT_TRUE(ended.code == 0 || ended.code == 3 || ended.code == 4 || ended.code == 6)
        << i << ": " << ended.code << ended.err;
    if (i < 8) {
      EXPECT_EQ(ended.code, 3) << i << ended.err;
    }
  }
#endif
}

}  // namespace
}  // namespace pellucid
