// Fog stands in the lamps' way: what it leaves of a light on a picture's own layers, on cards, on particles and behind
// smoke, against closed forms and marches that share nothing with it.
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>

#include "engine_bridge/scene/fog_light.h"
#include "gbuffer/opaque_io.h"
#include "tests/fog/stage.h"
#include "tests/particles/points_file.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// Where a straight way lies inside of a box, in metres from its start; false where it does not.
bool clip(const Box& box, const glm::dvec3& from, const glm::dvec3& way, double& start, double& end) {
  for (int c = 0; c < 3; ++c) {
    if (way[c] == 0.0) {
      if (from[c] < box.low[c] || from[c] > box.high[c]) return false;
      continue;
    }
    const double a = (box.low[c] - from[c]) / way[c], b = (box.high[c] - from[c]) / way[c];
    start = std::max(start, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return end > start;
}

// Optical depth of even or layered fog along a way, by Simpson's rule.
double depthAlong(const MediumSettings& medium, const glm::dvec3& from, const glm::dvec3& way, double start,
                  double end) {
  if (medium.box && !clip(*medium.box, from, way, start, end)) return 0.0;
  const auto extinction = [&](double t) {
    const double height = (from + t * way).y - medium.base;
    return medium.density * (medium.height > 0.0 ? std::exp(-height / medium.height) : 1.0);
  };
  constexpr int kParts = 400;
  double sum = 0.0;
  const double step = (end - start) / kParts;
  for (int i = 0; i < kParts; ++i)
    sum +=
        extinction(start + i * step) + 4.0 * extinction(start + (i + 0.5) * step) + extinction(start + (i + 1) * step);
  return sum * step / 6.0;
}

TEST(FogLight, IsBeerAndLambertFromInsideAndFromBeyond) {
  Random random(5);
  double worst = 0.0;
  int dimmed = 0;
  for (int i = 0; i < 4000; ++i) {
    FogStage stage(4, 4, 10.0f);
    MediumSettings medium;
    medium.density = random.between(0.01, 2.0);
    medium.height = i % 3 == 0 ? random.between(0.5, 5.0) : 0.0;
    const glm::dvec3 a(random.between(-3, 3), random.between(-3, 3), random.between(-8, 0));
    if (i % 5 > 0)
      medium.box = Box{a, a + glm::dvec3(random.between(0.5, 6), random.between(0.5, 6), random.between(0.5, 6))};
    const glm::dvec3 point(random.between(-4, 4), random.between(-4, 4), random.between(-9, 1));
    const glm::dvec3 lamp(random.between(-4, 4), random.between(-4, 4), random.between(-9, 1));
    const bool sun = medium.box && i % 2 == 0;
    if (sun)
      stage.sun(lamp - point, 2.0f);
    else
      stage.lamp(lamp, 2.0f);
    const FogLight light(std::make_shared<const Fog>(stage.fog(medium)));
    const glm::dvec3 view(stage.camera.viewFromWorld * glm::dvec4(point, 1.0));
    const double got = static_cast<double>(light.passed(lightBlocks(stage.scene.lights, stage.camera)[0], view));
    const double metres = glm::length(lamp - point);
    const double depth = depthAlong(medium, point, (lamp - point) / metres, 0.0, sun ? 1e3 : metres);
    EXPECT_LE(got, 1.0);
    EXPECT_GE(got, 0.0);
    worst = std::max(worst, std::abs(got - std::exp(-depth)));
    dimmed += depth > 0.01 ? 1 : 0;
  }
  std::printf("[ figure ] %d of 4000 ways dimmed, worst %.2g\n", dimmed, worst);
  EXPECT_GT(dimmed, 1000);  // the others pass beside their box
  EXPECT_LE(worst, 2e-5);   // a box's walls are known to float, and so is the length between them
}

// A sun above layered fog meets all of it that lies above the point; a sun over even fog without an end none.
TEST(FogLight, SunsOverFogWithoutWalls) {
  FogStage stage(4, 4, 10.0f);
  stage.sun({0.6, 0.8, 0.0}, 1.0f);
  MediumSettings medium;
  medium.density = 0.3;
  const shading::PunctualLight sun = lightBlocks(stage.scene.lights, stage.camera)[0];
  EXPECT_EQ(FogLight(std::make_shared<const Fog>(stage.fog(medium))).passed(sun, {0, 1, -5}), 1.0f);
  medium.height = 2.0;
  for (const double y : {-1.0, 0.0, 3.0}) {
    const float got = FogLight(std::make_shared<const Fog>(stage.fog(medium))).passed(sun, {0, y - 1.0, -5});
    EXPECT_NEAR(got, std::exp(-0.3 * std::exp(-y / 2.0) * 2.0 / 0.8), 1e-6);
  }
}

TEST(FogLight, MoreFogNeverGainsEnergy) {
  FogStage stage(4, 4, 10.0f);
  stage.lamp({0, 4, -5}, 1.0f);
  const shading::PunctualLight lamp = lightBlocks(stage.scene.lights, stage.camera)[0];
  float before = 1.0f;
  for (double density = 1e-6; density < 1e9; density *= 4.0) {
    MediumSettings medium;
    medium.density = density;
    medium.box = Box{{-1, 0, -6}, {1, 2, -4}};
    const float passed = FogLight(std::make_shared<const Fog>(stage.fog(medium))).passed(lamp, {0, -2, -5});
    EXPECT_LE(passed, before) << density;
    EXPECT_GE(passed, 0.0f);
    before = passed;
  }
  EXPECT_EQ(before, 0.0f);
}

// One fog before the lamp of a wall, a card or particles.
class FogAndLamps : public ::testing::Test {
 protected:
  static constexpr int kSize = 64;

  void SetUp() override {
    folder = freshFolder(std::string("lamps-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
  }
  static nlohmann::json sunNode(double turn) {
    return {{"name", "sun"},
            {"rotation", {0, -std::sin(turn / 2), 0, std::cos(turn / 2)}},
            {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  }
  static nlohmann::json sunOf(double irradiance) {
    return {{"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_ior"}},
            {"extensions",
             {{"KHR_lights_punctual",
               {{"lights", {{{"type", "directional"}, {"name", "sun"}, {"intensity", 683.0 * irradiance}}}}}}}}};
  }
  // Nothing reflects but its diffuse part.
  static nlohmann::json paper(double albedo, double alpha) {
    return {{"alphaMode", "BLEND"},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {albedo, albedo, albedo, alpha}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
            {"extensions", {{"KHR_materials_ior", {{"ior", 1}}}}}};
  }
  void writeScene(const Quad& quad, double turn, double irradiance) const {
    GlbOptions scene;
    scene.nodes = {sunNode(turn)};
    scene.extra = sunOf(irradiance);
    writeGlb(folder + "/scene.glb", {quad}, scene);
  }
  void writeShot(float depth, float beauty, float sun) const {
    const auto plane = [](float value) { return Image<float>(kSize, kSize, value); };
    const Window window{0, 0, kSize, kSize};
    writeLayers(
        folder + "/shot.exr", window, window,
        {{"", {{"R", plane(beauty)}, {"G", plane(beauty)}, {"B", plane(beauty)}, {"A", plane(1)}, {"Z", plane(depth)}}},
         {"light.sun", {{"R", plane(sun)}, {"G", plane(sun)}, {"B", plane(sun)}}}});
  }
  Image<glm::vec4> composite(std::vector<std::string> extra) const {
    std::vector<std::string> arguments{"composite", "shot.exr", "scene.glb", "-o", "out.exr", "--environment", "0,0,0"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  }
  // Of a plane z metres away, in metres: the picture is as high as it is far away.
  static double metres(int pixel, double z) { return (pixel + 0.5 - kSize / 2) / kSize * z; }

  std::string folder;
  RunOptions options;
};

TEST_F(FogAndLamps, ABoxDimsALightsOwnLayer) {
  const Quad away{{500, 500, -5}, {1, 0, 0}, {0, 1, 0}, paper(0.8, 0.5)};
  writeScene(away, 0.0, 1.0);
  writeShot(6.0f, 0.7f, 0.5f);
  const std::string fog = "density=0.8,albedo=0,box=0.5:-1:-3:1.6:1:-2";
  const Image<glm::vec4> without = composite({"--aa", "1", "--fog", fog});
  for (const auto& [method, tolerance] : {std::pair("exact", 1e-3), std::pair("stochastic", 0.02)})
    for (const char* passes : {"1", "4"}) {
      const Image<glm::vec4> out = composite({"--aa", passes, "--fog", fog, "--shadows", method});
      int past = 0, beside = 0;
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double wide = metres(x, 6.0), high = -metres(y, 6.0);
          // The box as the eye sees it begins at 1 m on the wall; its shadow reaches from .5 m to 1.6 m.
          if (wide > 0.6 && wide < 0.9 && std::abs(high) < 0.9) {
            EXPECT_NEAR(out.at(x, y).r, 0.2 + 0.5 * std::exp(-0.8), tolerance) << method << x << ' ' << y;
            EXPECT_EQ(without.at(x, y).r, 0.7f);  // nothing is cast unless it is asked for
            ++past;
          } else if (wide < 0.4 || std::abs(high) > 3.1) {
            EXPECT_EQ(out.at(x, y).r, 0.7f) << method << x << ' ' << y;
            ++beside;
          }
        }
      EXPECT_GT(past, 20);
      EXPECT_GT(beside, 1000);
    }
}

// Lamp and eye on one side of a slab, what they look at on the other.
TEST_F(FogAndLamps, ASlabDimsTheCardBehindIt) {
  writeShot(20.0f, 0.0f, 0.0f);
  writeScene({{-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, paper(0.8, 0.5)}, 0.0, 3.0);
  const double depth = 0.3 * 1.9, clear = 0.5 * 0.8 / M_PI * 3.0;
  const std::string fog = "density=0.3,albedo=0,box=-50:-50:-4.9:50:50:-3";
  for (const auto& [shadows, tolerance] : {std::pair("exact", 1e-3), std::pair("stochastic", 0.02)}) {
    const float dimmed = composite({"--aa", "1", "--method", "over", "--shadows", shadows, "--fog", fog}).at(32, 32).r;
    EXPECT_NEAR(static_cast<double>(dimmed) / clear, std::exp(-2.0 * depth), tolerance) << shadows;
  }
}

// The lamp from the side, through a box that the eye does not look through: for sums too, which know no order.
TEST_F(FogAndLamps, ABoxBesideTheEyesWayDimsTheLampAlone) {
  writeShot(20.0f, 0.0f, 0.0f);
  writeScene({{-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, paper(0.8, 0.5)}, M_PI / 4, 3.0);  // light towards (1, 0, -1)
  const double clear = 0.5 * 0.8 / M_PI * 3.0 * std::sqrt(0.5);
  const std::string fog = "density=0.6,albedo=0,box=-2:-2:-4:-1:2:-3";
  // What the pixel shows lies half a pixel from the axis, from where the way cuts a corner of the box.
  const double way = std::sqrt(2.0) * (1.0 - metres(kSize / 2, 5.0));
  for (const char* method : {"over", "phenomenological"})
    for (const auto& [shadows, tolerance] : {std::pair("exact", 1e-3), std::pair("stochastic", 0.02)}) {
      const float dimmed =
          composite({"--aa", "1", "--method", method, "--shadows", shadows, "--fog", fog}).at(32, 32).r;
      EXPECT_NEAR(static_cast<double>(dimmed) / clear, std::exp(-0.6 * way), tolerance) << method << shadows;
    }
}

// Particles are a medium of their own: a cloud behind a slab of fog is lit through it.
TEST_F(FogAndLamps, ASlabDimsTheLightInASecondMedium) {
  writeShot(20.0f, 0.0f, 0.0f);
  PointsFile points;
  for (int i = 0; i < 27; ++i) {
    points.positions.push_back({static_cast<float>(i % 3) * 0.4f - 0.4f, static_cast<float>(i / 3 % 3) * 0.4f - 0.4f,
                                -6.0f - static_cast<float>(i / 9) * 0.4f});
    points.radii.push_back(0.3f);
  }
  points.material = {{"alphaMode", "BLEND"},
                     {"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.8, 0.8, 0.3}}, {"metallicFactor", 0}}}};
  points.extra = sunOf(3.0);
  points.nodes = {sunNode(0.0)};
  writePoints(folder + "/scene.gltf", points);
  const double depth = 0.3 * 1.9;
  const std::string fog = "density=0.3,albedo=0,box=-50:-50:-4.9:50:50:-3";
  const auto draw = [&](std::vector<std::string> extra) {
    std::vector<std::string> arguments{"composite", "shot.exr", "scene.gltf", "-o",       "out.exr", "--environment",
                                       "0,0,0",     "--aa",     "1",          "--method", "over"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  };
  const Image<glm::vec4> lit = draw({}), dimmed = draw({"--fog", fog});
  int seen = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (lit.at(x, y).r < 0.01f) continue;
      ++seen;
      const double across = metres(x, 1.0), down = metres(y, 1.0);
      const double stretch = std::sqrt(1.0 + across * across + down * down);  // of the eye's way through the slab
      EXPECT_NEAR(dimmed.at(x, y).r / lit.at(x, y).r, std::exp(-depth * (1.0 + stretch)), 1e-3) << x << ' ' << y;
    }
  EXPECT_GT(seen, 50);
}

// A ball of smoke of radius 8 voxels about (0, 0, -4), .1 m a voxel, with a density that falls towards its edge.
double smokeOf(int x, int y, int z) {
  const int square = x * x + y * y + z * z;
  return square <= 64 ? 1.0 - square / 80.0 : 0.0;
}

// Between voxels, nothing beyond half a voxel about the active ones.
double smokeAt(const glm::dvec3& world) {
  const glm::dvec3 at = (world - glm::dvec3(0, 0, -4)) / 0.1;
  if (std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > 8.5) return 0.0;
  const glm::dvec3 low = glm::floor(at);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place = low + glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    const glm::dvec3 share = 1.0 - glm::abs(at - place);
    const glm::ivec3 voxel = glm::clamp(glm::ivec3(place), glm::ivec3(-8), glm::ivec3(8));
    sum += share.x * share.y * share.z * smokeOf(voxel.x, voxel.y, voxel.z);
  }
  return sum;
}

TEST_F(FogAndLamps, SmokeOfAGridThrowsAShadow) {
  openvdb::initialize();
  openvdb::FloatGrid::Ptr made = openvdb::FloatGrid::create(0.0f);
  made->setName("density");
  made->setGridClass(openvdb::GRID_FOG_VOLUME);
  made->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
  openvdb::FloatGrid::Accessor values = made->getAccessor();
  for (int z = -8; z <= 8; ++z)
    for (int y = -8; y <= 8; ++y)
      for (int x = -8; x <= 8; ++x)
        if (smokeOf(x, y, z) > 0.0) values.setValue({x, y, z - 40}, static_cast<float>(smokeOf(x, y, z)));
  openvdb::io::File(folder + "/smoke.vdb").write({made});
  const Quad away{{500, 500, -5}, {1, 0, 0}, {0, 1, 0}, paper(0.8, 0.5)};
  writeScene(away, M_PI / 4, 1.0);  // towards (1, 0, -1): the shadow lies 2 m to the right
  writeShot(6.0f, 0.7f, 0.5f);
  const glm::dvec3 toSun = glm::normalize(glm::dvec3(-1, 0, 1));
  for (const auto& [shadows, tolerance] : {std::pair("exact", 1e-3), std::pair("stochastic", 0.02)}) {
    const Image<glm::vec4> out =
        composite({"--aa", "1", "--shadows", shadows, "--fog-grid", "smoke.vdb", "--fog", "density=1.5,albedo=0"});
    double darkest = 1.0, worst = 0.0;
    for (int y = 12; y < 52; ++y)
      for (int x = 49; x < 63; ++x) {  // from 1.6 m on, where the smoke is not before the wall
        const glm::dvec3 point(metres(x, 6.0), -metres(y, 6.0), -6.0);
        double depth = 0.0;
        for (double t = 0.0; t < 6.0; t += 1e-3) depth += 1.5 * 1e-3 * smokeAt(point + (t + 5e-4) * toSun);
        const double wanted = 0.2 + 0.5 * std::exp(-depth);
        worst = std::max(worst, std::abs(static_cast<double>(out.at(x, y).r) - wanted));
        darkest = std::min(darkest, wanted);
      }
    std::printf("[ figure ] %s: worst of the shadow %.2g, darkest %.3f\n", shadows, worst, darkest);
    EXPECT_LE(worst, tolerance);
    EXPECT_LT(darkest, 0.35);
  }
}

}  // namespace
}  // namespace pellucid
