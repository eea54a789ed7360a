// Pictures of N x N samples for each pixel: a post before a wall, each sample with a depth of its own, and glass
// before, between and behind them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"
#include "gbuffer/supersampled.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kPixels = 12, kPerPixel = 4, kSamples = kPixels * kPerPixel;
constexpr double kStandsAt = 3.0, kBackAt = 10.0, kCovered = 0.7;
const glm::dvec3 kDark(0.02, 0.03, 0.01), kBright(2.0, 1.6, 1.1), kPane(0.1, 0.2, 0.3);

// In samples.
bool isDark(int x, int y) {
  return (x + 0.5) - 0.13 * (y + 0.5) < 0.6 * kSamples;
}

template <class T>
ExrChannel channelOf(const char* name, PixelType type, const std::vector<T>& values) {
  ExrChannel channel{name, type, std::vector<std::byte>(values.size() * sizeof(T))};
  std::memcpy(channel.bytes.data(), values.data(), channel.bytes.size());
  return channel;
}

class Supersampled : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-supersampled");
    NewExr file;
    file.display = file.data = {0, 0, kSamples, kSamples};
    std::vector<float> planes[5];
    std::vector<std::uint32_t> numbers;
    for (int y = 0; y < kSamples; ++y)
      for (int x = 0; x < kSamples; ++x) {
        const bool dark = isDark(x, y);
        for (int c = 0; c < 3; ++c) planes[c].push_back(static_cast<float>((dark ? kDark : kBright)[c]));
        planes[3].push_back(static_cast<float>(dark ? kStandsAt : kBackAt));
        planes[4].push_back(static_cast<float>(x));
        numbers.push_back(static_cast<std::uint32_t>(4000000000u + static_cast<unsigned>(y * kSamples + x)));
      }
    const char* names[] = {"R", "G", "B", "Z", "column"};
    for (int c = 0; c < 5; ++c) file.channels.push_back(channelOf(names[c], PixelType::float32, planes[c]));
    file.channels.push_back(channelOf("id", PixelType::uint32, numbers));
    file.attributes["comments"] = "of the samples";
    writeNewExr(path("post.exr"), file);
  }
  std::string path(const char* name) const { return folder + "/" + name; }
  Request request(double z, const std::string& method = "over", int passes = 1) const {
    writeGlb(path("glass.glb"), {Quad{{-60, -60, static_cast<float>(-z)},
                                      {120, 0, 0},
                                      {0, 120, 0},
                                      unlit(0.1f, 0.2f, 0.3f, static_cast<float>(kCovered))}});
    Request request = requestOf(path("post.exr"), path("glass.glb"));
    request.method = method;
    request.paint = paintOf(method);
    request.passes = passes;
    request.supersampled = kPerPixel;
    return request;
  }
  std::string folder;
};

glm::dvec3 expectedAt(int x, int y, double z) {
  glm::dvec3 sum(0.0);
  for (int v = y * kPerPixel; v < (y + 1) * kPerPixel; ++v)
    for (int u = x * kPerPixel; u < (x + 1) * kPerPixel; ++u) {
      const glm::dvec3 behind = isDark(u, v) ? kDark : kBright;
      const bool shows = z < (isDark(u, v) ? kStandsAt : kBackAt);
      sum += shows ? kCovered * kPane + (1.0 - kCovered) * behind : behind;
    }
  return sum / static_cast<double>(kPerPixel * kPerPixel);
}

TEST_F(Supersampled, EverySampleIsCompositedAtItsOwnDepth) {
  for (const char* method : {"over", "phenomenological", "weighted", "blended"})
    for (const double z : {2.0, 5.0, 12.0})
      for (const int passes : {1, 2}) {
        SCOPED_TRACE(testing::Message() << method << ", glass at " << z << ", --aa " << passes);
        const Request asked = request(z, method, passes);
        const Result result = Compositor(asked).run(asked);
        ASSERT_EQ(result.picture.rgba.width(), kPixels);
        EXPECT_EQ(result.dataWindow, (Window{0, 0, kPixels, kPixels}));
        double worst = 0.0;
        for (int y = 0; y < kPixels; ++y)
          for (int x = 0; x < kPixels; ++x)
            for (int c = 0; c < 3; ++c)
              worst = std::max(worst,
                               std::abs(static_cast<double>(result.picture.rgba.at(x, y)[c]) - expectedAt(x, y, z)[c]));
        EXPECT_LE(worst, 2e-6);
      }
}

TEST_F(Supersampled, IsTheMeanOfWhatTheSamplesShow) {
  Request asked = request(5.0, "over", 8);
  asked.fog.text = FogText();
  asked.fog.text->medium.density = 0.05;
  asked.fog.text->hasDensity = true;
  asked.measure = true;
  asked.layers = {LayerName::transmission, LayerName::depth};
  Compositor compositor(asked);
  const Result pixels = compositor.run(asked);
  asked.supersampled = 1;
  const Result samples = compositor.run(asked);
  const Image<glm::vec4> means = meansOf(samples.picture.rgba, kPerPixel);
  EXPECT_EQ(std::memcmp(means.data(), pixels.picture.rgba.data(), means.size() * sizeof(glm::vec4)), 0);
  EXPECT_EQ(pixels.error->maximum, 0.0);
  EXPECT_EQ(pixels.error->pixels, static_cast<std::size_t>(kPixels * kPixels));
  ASSERT_EQ(pixels.layers.size(), samples.layers.size());
  for (std::size_t i = 0; i < pixels.layers.size(); ++i)
    for (std::size_t c = 0; c < pixels.layers[i].channels.size(); ++c) {
      const auto& [name, plane] = pixels.layers[i].channels[c];
      const Image<float>& fine = samples.layers[i].channels[c].second;
      const Image<float> expected = name == "Z" ? middlesOf(fine, kPerPixel) : meansOf(fine, kPerPixel);
      EXPECT_EQ(std::memcmp(expected.data(), plane.data(), plane.size() * sizeof(float)), 0) << name;
    }
}

TEST_F(Supersampled, TheFileHasPixelsOfEveryChannel) {
  const Request asked = request(5.0);
  Compositor compositor(asked);
  const Result result = compositor.run(asked);
  compositor.write(path("out.exr"), result);
  const ExrDocument document = readExr(path("out.exr"));
  const ExrPart& part = document.parts.at(0);
  EXPECT_EQ(part.display, (Window{0, 0, kPixels, kPixels}));
  EXPECT_EQ(part.data, part.display);
  EXPECT_EQ(part.text("comments"), "of the samples");
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const auto i = static_cast<std::size_t>(y * kPixels + x);
      EXPECT_EQ(part.find("R")->at(i), result.picture.rgba[i].r);
      const int u = x * kPerPixel + kPerPixel / 2, v = y * kPerPixel + kPerPixel / 2;
      EXPECT_EQ(part.find("Z")->at(i), static_cast<float>(isDark(u, v) ? kStandsAt : kBackAt));
      EXPECT_EQ(part.find("column")->at(i), static_cast<float>(x * kPerPixel + 1.5));
      std::uint32_t id = 0;
      std::memcpy(&id, part.find("id")->bytes.data() + 4 * i, 4);
      EXPECT_EQ(id, 4000000000u + static_cast<unsigned>(v * kSamples + u));
    }
}

TEST_F(Supersampled, WindowsHoldWholePixels) {
  Request asked = request(5.0);
  asked.supersampled = 5;
  Compositor compositor(asked);
  try {
    compositor.run(asked);
    ADD_FAILURE() << "48 samples were taken for pixels of 5";
  } catch (const MeaningError& error) {
    EXPECT_NE(std::string(error.what()).find("(0, 0) to (48, 48), expected edges at multiples of 5"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pellucid
