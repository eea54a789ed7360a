// Planar depth told from distances along the ray, on renders of real scenes: Blender's of ../shared/assets, and our own
// samples'. Each is read as it was rendered, and turned into ray distances; with noise of several sizes, too.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "exr_files.h"
#include "gbuffer/depth_evidence.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// Of ../shared/assets, whose lenses of 28 and 40 mm stand before 36 mm of film, 16 by 9.
constexpr double kStillFocal = 28.0 / 18.0, kShotFocal = 40.0 / 18.0;

struct Rates {
  std::size_t right = 0, asked = 0, wrong = 0;
};

// What the planes of a depth channel say, between the two readings.
struct Judge {
  Rates clean;
  std::map<double, Rates> noisy;  // by the largest relative change

  //   planar  metres; not finite where nothing was hit
  void picture(const std::string& name, const Image<float>& planar, const Camera& camera, const Window& display) {
    for (const bool half : {false, true})
      for (const bool ray : {false, true}) count(name, planar, camera, display, ray, half, 0.0, clean);
    for (const double noise : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1})
      for (const bool ray : {false, true}) count(name, planar, camera, display, ray, false, noise, noisy[noise]);
  }

  void print(const char* what) const {
    const auto line = [&](const std::string& which, const Rates& rates) {
      std::printf("[ figure ] ray or planar, %s, %s: %zu right, %zu asked, %zu wrong\n", what, which.c_str(),
                  rates.right, rates.asked, rates.wrong);
    };
    line("as rendered", clean);
    for (const auto& [noise, rates] : noisy) line("noise of " + std::to_string(noise), rates);
  }

 private:
  static void count(const std::string& name, const Image<float>& planar, const Camera& camera, const Window& display,
                    bool ray, bool half, double noise, Rates& rates) {
    Random random(7);
    std::vector<float> stored(planar.size());
    for (std::size_t i = 0; i < planar.size(); ++i) {
      const auto width = static_cast<std::size_t>(planar.width());
      const double x = static_cast<double>(i % width) + 0.5, y = static_cast<double>(i / width) + 0.5;
      const double z = static_cast<double>(planar[i]), length = ray ? rayOverPlanar(camera, display, x, y) : 1.0;
      const double changed = 1.0 + noise * (2.0 * random.uniform() - 1.0);
      stored[i] = std::isfinite(z) ? static_cast<float>(z * length * changed) : 1e10f;
    }
    const Plane plane = half ? halfPlane("Z", stored) : floatPlane("Z", stored);
    ExrPart part;
    part.display = part.data = {0, 0, planar.width(), planar.height()};
    ExrChannel channel;
    channel.name = "Z";
    channel.type = half ? PixelType::half : PixelType::float32;
    channel.bytes = plane.bytes;
    const auto found = spokenFor(depthEvidence(part, channel, &camera), parseDepthKind("planar|ray"));
    const DepthMeaning truth = ray ? DepthMeaning::ray : DepthMeaning::planar;
    ++(!found ? rates.asked : *found == truth ? rates.right : rates.wrong);
    EXPECT_TRUE(!found || *found == truth)
        << name << (ray ? ", rays" : ", planar") << (half ? ", half" : ", float") << ", noise " << noise;
  }
};

TEST(Evidence, OfSamples) {
  const std::string folder = freshFolder("gbuffer-evidence-samples");
  RunOptions options;
  options.program = "pellucid_samples";
  ASSERT_EQ(runProgram({folder, "all", "90"}, options).code, 0);
  Judge judge;
  for (const std::string& name : filesIn(folder)) {
    if (!name.ends_with(".exr")) continue;
    try {
      const OpaqueFile file = readOpaque(folder + "/" + name, {});
      if (file.gbuffer.camera) judge.picture(name, file.gbuffer.viewZ, *file.gbuffer.camera, file.gbuffer.display);
    } catch (const Error&) {
      continue;  // no picture with a depth
    }
  }
  judge.print("our samples");
  EXPECT_GT(judge.clean.right, 0u);
  EXPECT_EQ(judge.clean.wrong, 0u);
}

TEST(Evidence, OfBlendersRenders) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
  Judge judge;
  std::size_t pictures = 0;
  const std::pair<const char*, double> folders[] = {{"blender", kStillFocal}, {"blender_shot", kShotFocal}};
  for (const auto& [name, focal] : folders) {
    const std::string folder = assets() + "/" + name;
    if (!std::filesystem::exists(folder)) continue;
    for (const std::string& file : filesIn(folder)) {
      const bool opaque = file.find("opaque") != std::string::npos || file.find("gbuffer") != std::string::npos;
      if (!file.ends_with(".exr") || !opaque || file.starts_with("offaxis")) continue;
      const OpaqueFile picture = readOpaque(folder + "/" + file, {});
      Camera camera;
      camera.focal = {focal, focal * 16 / 9};
      judge.picture(name + ("/" + file), picture.gbuffer.viewZ, camera, picture.gbuffer.display);
      ++pictures;
    }
  }
  judge.print("Blender's renders");
  std::printf("[ figure ] of %zu renders\n", pictures);
  EXPECT_EQ(judge.clean.wrong, 0u);
  EXPECT_GT(judge.clean.right, judge.clean.asked);
}

}  // namespace
}  // namespace pellucid::test
