// A shot that moves, from Blender, against Cycles' own answers. Skipped without ../shared/assets.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "composite/error.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

class BlenderShot : public ::testing::Test {
 protected:
  void SetUp() override {
    if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
    from = assets() + "/blender_shot/";
    if (!std::filesystem::exists(from + "transparent_unlit.glb")) GTEST_SKIP() << "no " << from << " in the assets";
    folder = freshFolder("blender-shot");
  }

  // The colours of one view, without anything else that the file may lack.
  static Image<glm::vec4> beauty(const std::string& path, const std::string& prefix) {
    const ExrDocument document = readExr(path);
    const ExrPart& part = document.parts[0];
    Image<glm::vec4> image(part.data.width(), part.data.height(), glm::vec4(0));
    int found = 0;
    for (const ExrChannel& channel : part.channels)
      for (int c = 0; c < 3; ++c) {
        if (channel.name != prefix + "RGB"[c]) continue;
        for (std::size_t i = 0; i < image.size(); ++i) image[i][c] = channel.at(i);
        ++found;
      }
    EXPECT_EQ(found, 3) << path;
    return image;
  }
  static std::string prefixOf(const std::string& path) {
    const ExrDocument document = readExr(path);
    for (const ExrChannel& channel : document.parts[0].channels)
      if (channel.name == "ViewLayer.Combined.R") return "ViewLayer.Combined.";
    return "";
  }
  ErrorStatistics errorOf(const std::string& opaque, const std::string& truth, std::vector<std::string> flags) {
    const std::string out = folder + "/out.exr";
    std::vector<std::string> arguments{"composite", from + opaque, from + "transparent_unlit.glb", "-o", out,
                                       "--camera",  "cam"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    last = runProgram(arguments);
    EXPECT_EQ(last.code, 0) << last.err;
    return measureError(beauty(out, prefixOf(out)), beauty(from + truth, prefixOf(from + truth)));
  }

  std::string from, folder;
  Ended last;
};

const std::vector<std::string> kExact = {"--aa", "1", "--mask", "hard", "--texture-filter", "bilinear"};

TEST_F(BlenderShot, EveryFrameByItsOwnHeader) {
  for (int frame = 1001; frame <= 1008; ++frame) {
    const std::string number = std::to_string(frame);
    const ErrorStatistics error =
        errorOf("center_opaque." + number + ".exr", "center_truth." + number + ".exr", kExact);
    printf("[ figure ] %d: %s\n", frame, errorLine(error).c_str());
    EXPECT_LE(error.rmse, 1e-5) << frame << ": what float textures and rasterised attributes leave";
    EXPECT_NE(last.err.find("frame " + number + " (attribute Frame)"), std::string::npos) << last.err;
  }
  std::vector<std::string> other = kExact;
  other.insert(other.end(), {"--frame", "1001"});
  EXPECT_GT(errorOf("center_opaque.1008.exr", "center_truth.1008.exr", other).rmse, 0.05) << "another frame's pose";
  EXPECT_GT(errorOf("center_opaque.1008.exr", "center_truth.1008.exr", {"--animation", "none", "--aa", "1"}).rmse,
            0.05);
}

// As Blender exports by default: an animation for each object, which do not meet.
TEST_F(BlenderShot, OneAnimationForEachObject) {
  const std::string out = folder + "/actions.exr";
  std::vector<std::string> arguments{
      "composite", from + "center_opaque.1006.exr", from + "transparent_actions.glb", "-o", out, "--camera", "cam"};
  arguments.insert(arguments.end(), kExact.begin(), kExact.end());
  const Ended ended = runProgram(arguments);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string truth = from + "center_truth.1006.exr";
  EXPECT_LE(measureError(beauty(out, prefixOf(out)), beauty(truth, prefixOf(truth))).rmse, 1e-5);
}

TEST_F(BlenderShot, BothEyesInOneRun) {
  const std::string out = folder + "/stereo.exr";
  std::vector<std::string> arguments{"composite",
                                     from + "stereo_opaque.1004.exr",
                                     from + "stereo.glb",
                                     "-o",
                                     out,
                                     "--view",
                                     "all",
                                     "--camera",
                                     "left=cam_left",
                                     "--camera",
                                     "right=cam_right"};
  arguments.insert(arguments.end(), kExact.begin(), kExact.end());
  const Ended ended = runProgram(arguments);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string truth = from + "stereo_truth.1004.exr";
  const auto eye = [](const std::string& path, const std::string& name) {
    const ExrDocument document = readExr(path);
    Image<glm::vec4> image(document.parts[0].data.width(), document.parts[0].data.height(), glm::vec4(0));
    for (const ExrPart& part : document.parts)
      for (const ExrChannel& channel : part.channels)
        for (int c = 0; c < 3; ++c) {
          const std::string letter(1, "RGB"[c]);
          const bool plain = name == "left" && channel.name == letter;
          const bool named = channel.name.ends_with(name + "." + letter) &&
                             (channel.name.starts_with("ViewLayer.Combined") || channel.name == name + "." + letter);
          if (plain || named)
            for (std::size_t i = 0; i < image.size(); ++i) image[i][c] = channel.at(i);
        }
    return image;
  };
  for (const char* name : {"left", "right"}) {
    const ErrorStatistics error = measureError(eye(out, name), eye(truth, name));
    printf("[ figure ] %s eye: %s\n", name, errorLine(error).c_str());
    EXPECT_LE(error.rmse, 1e-5) << name;
  }
}

TEST_F(BlenderShot, MotionBlurAgainstCycles) {
  struct Case {
    const char *opaque, *truth;
    std::vector<std::string> flags;
  };
  const std::vector<Case> cases = {
      {"mb_opaque.1003.exr", "mb_truth.1003.exr", {"--shutter", "-0.25:0.25"}},
      {"mb_opaque.1006.exr", "mb_truth.1006.exr", {"--shutter", "-0.25:0.25"}},
      {"mbstill_opaque.1006.exr", "mbstill_truth.1006.exr", {"--shutter", "-0.25:0.25", "--camera-motion", "off"}},
      {"dof_opaque.1003.exr", "dof_truth.1003.exr", {"--lens-radius", "0.1", "--focus", "6.6"}},
      {"dof_opaque.1006.exr", "dof_truth.1006.exr", {"--lens-radius", "0.1", "--focus", "4.2"}}};
  for (const Case& one : cases) {
    double error[3];
    const char* passes[3] = {"16", "16", "64"};
    for (int i = 0; i < 3; ++i) {
      std::vector<std::string> flags{"--aa", passes[i]};
      if (i > 0) flags.insert(flags.end(), one.flags.begin(), one.flags.end());
      error[i] = errorOf(one.opaque, one.truth, flags).rmse;
    }
    printf("[ figure ] %s: RMSE %.5f without, %.5f with 16 passes, %.5f with 64\n", one.opaque, error[0], error[1],
           error[2]);
    EXPECT_LT(error[1], error[0]) << one.opaque;
    EXPECT_LE(error[2], error[1]) << one.opaque;
  }
}

}  // namespace
}  // namespace pellucid
