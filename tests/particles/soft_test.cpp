// Balls before, in and behind what is opaque: the closed form, and the picture of it.
#include <gtest/gtest.h>

#include <cmath>

#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/permutation.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "shaders/particle.h"
#include "tests/gl/builder.h"
#include "tests/particles/points_file.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// What a ray meets of a ball of even density, in double.
double coverage(double square, double z, double radius, double behind, double middle) {
  const double reach = radius * std::sqrt(std::max(1 - square, 0.0));
  const double length = std::max(std::min(behind, z + reach) - std::max(z - reach, 0.0), 0.0);
  return -std::expm1(std::log1p(-middle) * length / (2 * radius));
}

TEST(Particle, SoftIntersectionIsTheClosedForm) {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double square = random.uniform(), z = random.between(0.01, 20), radius = random.between(1e-3, 3),
                 middle = random.uniform() * 0.999;
    const double behind = z + radius * random.between(-1.5, 1.5);
    if (behind <= 0) continue;
    const shading::Chord chord = shading::chordOf(static_cast<float>(square), static_cast<float>(z),
                                                  static_cast<float>(radius), static_cast<float>(behind));
    worst =
        std::max(worst, std::abs(static_cast<double>(shading::ballCoverage(static_cast<float>(middle), chord.share)) -
                                 coverage(square, z, radius, behind, middle)));
  }
  std::printf("largest error of 100,000: %.2g\n", worst);
  EXPECT_LT(worst, 1e-3);  // z - reach cancels: a radius of a millimetre at 20 m is known to a thousandth
}

// No step anywhere: not at the front, nor the back, nor before the camera.
TEST(Particle, CoverageIsContinuousInTheDepthBehind) {
  double before = 0;
  for (int i = 0; i <= 4000; ++i) {
    const float behind = 4.0f + static_cast<float>(i) * 5e-4f;
    const double now =
        static_cast<double>(shading::ballCoverage(0.9f, shading::chordOf(0.1f, 5.0f, 0.5f, behind).share));
    EXPECT_GE(now, before - 1e-6);
    EXPECT_LT(now - before, 2e-3);
    before = now;
  }
  EXPECT_NEAR(before, coverage(0.1, 5, 0.5, 99, 0.9), 1e-5);
  EXPECT_EQ(shading::chordOf(0.1f, 5.0f, 0.5f, 4.0f).share, 0.0f);
  EXPECT_EQ(shading::chordOf(0.1f, 5.0f, 0.5f, 99.0f).z, 5.0f);
}

// Every kind of particle under every output.
TEST(Particle, EveryKindCompilesAndLinks) {
  GlContext context;
  for (int bits = 0; bits < 1 << 8; ++bits) {
    const auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
    Material material;
    material.alphaMode = AlphaMode::blend;
    const bool points = bit(0);
    material.billboard = bit(1);
    material.softness = bit(2) ? 1.0f : 0.0f;
    material.unlit = bit(3);
    if (bit(4)) material.baseColorTexture.texture = 0;
    if (bit(5)) material.transmission = 1.0f;
    gl::FrameFeatures frame;
    frame.lights = true;
    frame.lightVolume = bit(6);
    frame.surroundings = bit(7);
    frame.environment = !bit(7);
    frame.solids = bit(2);
    std::vector<std::string> defines =
        gl::outputDefines(static_cast<gl::Output>(bits % static_cast<int>(gl::kOutputs)), frame, SumsSettings{});
    const std::vector<std::string> surface = gl::surfaceDefines(material, bit(5), frame, false, points);
    defines.insert(defines.end(), surface.begin(), surface.end());
    ASSERT_NO_THROW(gl::buildProgram("gl/transparent.vert", "gl/transparent.frag", defines)) << bits;
    if (points || material.billboard) {
      ASSERT_NO_THROW(gl::buildProgram("gl/transparent.vert", "gl/shadow_caster.frag",
                                       [&] {
                                         std::vector<std::string> caster = surface;
                                         caster.emplace_back("EXACT_COVERAGE");
                                         return caster;
                                       }()))
          << bits;
    }
  }
}

class PointsShot : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("points-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  Scene load(const PointsFile& points, std::size_t streamBytes = 0) const {
    writePoints(folder + "/points.gltf", points);
    SceneOptions options;
    options.streamBytes = streamBytes;
    return loadScene({folder + "/points.gltf"}, options);
  }
  std::string folder;
};

TEST_F(PointsShot, GlDrawsTheBallItsAttributesSay) {
  PointsFile points;
  points.positions = {{0.0f, 0.0f, -4.0f}, {1.0f, 0.5f, -6.0f}};
  points.radii = {0.8f, 0.5f};
  points.colours = {{1.0f, 0.5f, 0.25f, 1.0f}, {0.5f, 1.0f, 1.0f, 0.5f}};
  points.material = unlitPoints(0.8f, 0.8f, 0.8f, 0.9f);
  Stage stage(96, 64);
  stage.scene = load(points);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) stage.gbuffer.viewZ.at(x, y) = x < 48 ? 4.2f : 50.0f;  // the first is cut by a wall
  int met = 0;
  double worst = 0;
  for (const FragmentLists& lists : stage.fragments())
    for (int y = 0; y < lists.window.height(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel = static_cast<std::size_t>(y * lists.window.width() + x);
        const int px = lists.window.x0 + x, py = lists.window.y0 + y;
        const double behind = px < 48 ? 4.2 : 50.0;
        std::vector<std::pair<double, double>> wanted;  // coverage, red
        for (std::size_t i = 0; i < 2; ++i) {
          const double z = -static_cast<double>(points.positions[i][2]), radius = static_cast<double>(points.radii[i]);
          const glm::vec3 at = stage.at(px + 0.5, py + 0.5, z);
          const double u = (static_cast<double>(at.x) - static_cast<double>(points.positions[i][0])) / radius;
          const double v = (static_cast<double>(at.y) - static_cast<double>(points.positions[i][1])) / radius;
          const double alpha = 0.9 * static_cast<double>(points.colours[i][3]);
          if (u * u + v * v < 1.0)
            wanted.emplace_back(coverage(u * u + v * v, z, radius, behind, alpha),
                                0.8 * static_cast<double>(points.colours[i][0]));
        }
        std::size_t seen = 0;
        for (std::uint64_t k = lists.offsets[pixel]; k < lists.offsets[pixel + 1]; ++k) {
          const Fragment& fragment = lists.fragments[k];
          double off = 1;
          for (const auto& [alpha, red] : wanted)
            off = std::min(off, std::abs(static_cast<double>(fragment.coverage) - alpha) +
                                    std::abs(static_cast<double>(fragment.radiance.r) - alpha * red));
          worst = std::max(worst, off);
          ++seen;
        }
        met += static_cast<int>(seen);
        EXPECT_LE(seen, wanted.size());
        for (const auto& [alpha, red] : wanted)
          if (alpha > 0.05) {
            EXPECT_GE(seen, 1u) << px << ' ' << py;
          }
      }
  std::printf("%d fragments, largest difference %.2g\n", met, worst);
  EXPECT_GT(met, 200);
  EXPECT_LT(worst, 2e-4);  // where a disc ends the root is steep: attributes are the rasteriser's
}

TEST_F(PointsShot, StreamedPointsAreTheSameInAnyChunk) {
  Random random(9);
  PointsFile points;
  for (int i = 0; i < 5000; ++i) {
    points.positions.push_back({static_cast<float>(random.between(-2, 2)), static_cast<float>(random.between(-1, 1)),
                                static_cast<float>(random.between(-8, -3))});
    points.radii.push_back(static_cast<float>(random.between(0.01, 0.1)));
  }
  points.material = unlitPoints(0.8f, 0.7f, 0.6f, 0.2f);
  const auto drawn = [&](std::size_t streamBytes, std::size_t chunk, SubmissionOrder order) {
    Stage stage(48, 32);
    stage.scene = load(points, streamBytes);
    PassSettings settings;
    settings.chunkBytes = chunk;
    settings.order = order;
    std::vector<FragmentLists> tiles = stage.fragments(settings);
    std::vector<std::vector<Fragment>> sorted;
    for (FragmentLists& lists : tiles)
      for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i) {
        sorted.emplace_back(lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                            lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]));
        std::sort(sorted.back().begin(), sorted.back().end(),
                  [](const Fragment& a, const Fragment& b) { return a.identity < b.identity; });
      }
    EXPECT_EQ(stage.statistics.triangles, 5000u);
    return sorted;
  };
  const auto whole = drawn(0, 0, {});
  for (const auto& other : {drawn(1 << 20, 1 << 18, {}), drawn(1 << 20, 0, {SubmissionOrder::shuffle, 5}),
                            drawn(0, 1 << 17, {SubmissionOrder::reverse, 0})}) {
    ASSERT_EQ(other.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_EQ(other[i].size(), whole[i].size());
      for (std::size_t k = 0; k < whole[i].size(); ++k) {
        EXPECT_EQ(other[i][k].identity, whole[i][k].identity);
        EXPECT_EQ(other[i][k].coverage, whole[i][k].coverage);
        EXPECT_EQ(other[i][k].z, whole[i][k].z);
      }
    }
  }
}

TEST_F(PointsShot, OddPointsAreLeftOutAndSaidSo) {
  PointsFile points;
  points.positions = {{0, 0, -4}, {NAN, 0, -4}, {0, 0, -5}, {0, INFINITY, -4}};
  points.radii = {0.5f, 0.5f, -1.0f, 0.5f};
  points.colours = {{2, 0, 0, 1}, {0, 0, 0, 1}, {NAN, 0, 0, 1}, {0, 0, 0, 1}};
  points.material = unlitPoints(0.8f, 0.7f, 0.6f, 0.5f);
  Stage stage(32, 32);
  stage.scene = load(points);
  std::string notes;
  for (const std::string& note : stage.scene.notes) notes += note + '\n';
  EXPECT_NE(notes.find("2 points have a position that is not finite"), std::string::npos) << notes;
  EXPECT_NE(notes.find("1 points have a radius"), std::string::npos) << notes;
  EXPECT_NE(notes.find("2 colour values of points"), std::string::npos) << notes;
  for (const FragmentLists& lists : stage.fragments())
    for (const Fragment& fragment : lists.fragments) {
      EXPECT_NEAR(fragment.z, 4.0f, 1e-6f);
      EXPECT_TRUE(std::isfinite(fragment.radiance.r + fragment.coverage));
    }
  // Opaque points belong to nothing that is drawn.
  points.material = {{"name", "rock"}};
  stage.scene = load(points);
  EXPECT_TRUE(stage.scene.primitives.empty());
}

}  // namespace
}  // namespace pellucid::test
