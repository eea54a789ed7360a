// Layers that lie on a sample of a deep picture are in front of it, and what lies behind it is hidden by its share,
// wherever in the pixel a pass samples.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "composite/pipeline/compositor.h"
#include "gbuffer/deep_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kSize = 24;
constexpr double kTilt = 50.0 * M_PI / 180.0;  // about an upright axis
constexpr double kNear = 2.5, kFar = 5.0;      // metres, on the camera's axis
constexpr float kVeil = 0.4f, kPaint = 0.5f;   // coverage of the nearer sheet, of the decal
constexpr float kWallLight = 0.6f, kSheetLight = 0.1f, kPaintLight = 1.0f;

// Where the tilted plane at a distance lies in a pixel, as the camera of writeGlb() sees it.
double planeAt(int x, double distance) {
  const double across = (x + 0.5) / kSize - 0.5;
  return distance * std::cos(kTilt) / (std::cos(kTilt) - std::sin(kTilt) * across);
}

// A sheet before a wall, both tilted: two samples a pixel. Without `there` both lie beyond everything.
void writeSheetAndWall(const std::string& path, bool there) {
  const DeepHeader header = deepHeaderOf(kSize, kSize);
  DeepWriter writer(path, header);
  DeepRows rows = noSamplesOf(header);
  const auto put = [&](float alpha, float light, double z) {
    const float values[] = {alpha, alpha * light, alpha * light, alpha * light, static_cast<float>(z)};
    for (std::size_t c = 0; c < 5; ++c) rows.channels[c].push_back(values[c]);
  };
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      put(kVeil, kSheetLight, there ? planeAt(x, kNear) : 1e6);
      put(1.0f, kWallLight, there ? planeAt(x, kFar) : 2e6);
      rows.offsets.push_back(rows.channels[0].size());
    }
  writer.write(rows);
  writer.finish();
}

// Parallel to them, on the camera's axis at a distance, over the whole picture.
void writeDecal(const std::string& path, double distance) {
  const double s = 6.0 * distance;
  const glm::dvec3 across(std::cos(kTilt), 0.0, -std::sin(kTilt)), up(0.0, 1.0, 0.0);
  const auto put = [](const glm::dvec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  writeGlb(path, {Quad{put(glm::dvec3(0.0, 0.0, -distance) - 0.5 * s * (across + up)), put(s * across), put(s * up),
                       unlit(kPaintLight, kPaintLight, kPaintLight, kPaint)}});
}

class DeepContact : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-deep-contact"); }
  // The picture with the decal at a distance must be this value all over.
  void expectValue(double distance, double value, const char* method, int passes, bool there = true) {
    writeSheetAndWall(folder + "/deep.exr", there);
    writeDecal(folder + "/decal.glb", distance);
    Request request = requestOf(folder + "/deep.exr", folder + "/decal.glb");
    request.method = method;
    request.paint = paintOf(method);
    request.passes = passes;
    Compositor compositor(request);
    const Image<glm::vec4> shown = compositor.run(request).picture.rgba;
    double largest = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i)
      largest = std::max(largest, std::abs(static_cast<double>(shown[i].g) - value));
    EXPECT_LT(largest, 2e-6) << distance << " m, " << method << ", --aa " << passes;
  }
  static double over(double light, double alpha, double behind) { return alpha * light + (1.0 - alpha) * behind; }
  std::string folder;
};

TEST_F(DeepContact, ASampleIsHeldOutWhereThePassSamplesIt) {
  const double plain = over(kSheetLight, kVeil, kWallLight);
  const double onWall = over(kSheetLight, kVeil, over(kPaintLight, kPaint, kWallLight));
  const double onSheet = over(kPaintLight, kPaint, plain);
  for (const char* method : {"over", "phenomenological", "weighted", "mlab:4"})
    for (const int passes : {1, 2, 8}) {
      expectValue(kFar, onWall, method, passes);
      expectValue(kFar * (1.0 + 0x1p-19), plain, method, passes);
      expectValue(kNear, onSheet, method, passes);
      expectValue(kNear * (1.0 + 0x1p-19), onWall, method, passes);
      expectValue(kNear, onSheet, method, passes, false);
    }
}

}  // namespace
}  // namespace pellucid
