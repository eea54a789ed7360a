// Glass that stands between sheets of low resolution has those before it over it and the others behind it, as at full
// resolution: in what sorts, in what keeps a tolerance, and on the average of stochastic samples.
#include <gtest/gtest.h>

#include "composite/pipeline/compositor.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kSize = 32;

class LowRunsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-low-runs");
    const auto plane = [](float value) { return Image<float>(kSize, kSize, value); };
    const Window window{0, 0, kSize, kSize};
    writeLayers(folder + "/wall.exr", window, window,
                {{"", {{"R", plane(0.2f)}, {"G", plane(0.4f)}, {"B", plane(0.6f)}, {"Z", plane(6.5f)}}}});
    std::vector<Quad> quads;
    const glm::vec4 colours[] = {{0.9f, 0.1f, 0.1f, 0.5f}, {0.1f, 0.9f, 0.1f, 0.3f}, {0.1f, 0.1f, 0.9f, 0.6f},
                                 {0.9f, 0.9f, 0.1f, 0.4f}, {0.1f, 0.9f, 0.9f, 0.7f}, {0.9f, 0.1f, 0.9f, 0.5f}};
    for (int i = 0; i < 6; ++i) {  // at 2 to 7 m, the last behind the wall
      const float z = 2.0f + static_cast<float>(i);
      nlohmann::json material = unlit(colours[i].r, colours[i].g, colours[i].b, colours[i].a);
      if (i % 2 == 0) material["extras"] = {{"pellucid", {{"lowResolution", true}}}};
      quads.push_back({{-z, -z, -z}, {2.0f * z, 0, 0}, {0, 2.0f * z, 0}, material});
    }
    writeGlb(folder + "/sheets.glb", quads);
  }
  Request request(int factor, int passes) const {
    Request request = requestOf(folder + "/wall.exr", folder + "/sheets.glb");
    request.paint = PaintSorted{};
    request.lowResolution.factor = factor;
    request.passes = passes;
    return request;
  }
  static Image<glm::vec4> drawn(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture.rgba;
  }
  std::string folder;
};

TEST_F(LowRunsTest, GlassStandsBetweenThem) {
  for (const int passes : {1, 4}) {
    const Image<glm::vec4> full = drawn(request(1, passes));
    for (const int factor : {2, 4, 8}) {
      SCOPED_TRACE(testing::Message() << "1/" << factor << ", --aa " << passes);
      EXPECT_LE(farthestApart(drawn(request(factor, passes)), full), 1e-6);
      Request within = request(factor, passes);
      within.paint = PaintWithin{0.01};
      EXPECT_LE(farthestApart(drawn(within), full), 0.01);
    }
  }
}

TEST_F(LowRunsTest, SamplesAreThemOnTheAverage) {
  const Image<glm::vec4> full = drawn(request(1, 1));
  Request samples = request(4, 1);
  samples.paint = PaintSamples{};
  std::get<PaintSamples>(samples.paint).settings.samples = 256;
  const Image<glm::vec4> picture = drawn(samples);
  glm::dvec3 mean(0.0), right(0.0);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    mean += glm::dvec3(picture[i]);
    right += glm::dvec3(full[i]);
  }
  // A pixel's 256 samples are off by .5 / 16 at most, the mean of 1024 pixels by a thousandth.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / kSize / kSize, right[c] / kSize / kSize, 4e-3);
}

}  // namespace
}  // namespace pellucid
