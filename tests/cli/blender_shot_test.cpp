// A shot that moves, from Blender, against Cycles' own answers. Skipped without ../shared/assets.
#include "tests/cli/blender_shot.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace pellucid {
namespace {

using namespace test;

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

// By default flags, filtered pictures as the program's users have them. What is left is what one colour and one depth
// for each pixel do not tell: which samples of an edge Cycles took, beside the noise of 256 of them. So the shot may be
// as far off as a still picture of such a scene, unlit and filtered alike, whose opaque part is noisier; and the bound
// of its own is a fifth above what the worst frame has.
TEST_F(BlenderShot, DefaultFlagsAreAsGoodAsOnTheStill) {
  const std::string blender = assets() + "/blender/";
  const ErrorStatistics still =
      errorOfFiles(blender + "gbuffer.exr", blender + "transparent_unlit.glb", blender + "gt_unlit.exr", {});
  printf("[ figure ] still: %s\n", errorLine(still).c_str());
  for (int frame = 1001; frame <= 1008; ++frame) {
    const std::string number = std::to_string(frame);
    const ErrorStatistics error = errorOf("opaque." + number + ".exr", "flat_truth." + number + ".exr", {});
    printf("[ figure ] %d: %s\n", frame, errorLine(error).c_str());
    EXPECT_LE(error.rmse, still.rmse) << frame;
    EXPECT_LE(error.rmse, 0.0025) << frame;
  }
}

// Noise of --method stochastic belongs to the pixel and the triangle, or to the triangle alone: still things do not
// flicker, and what moves through pixels has other noise in each frame, as the pixels see it. Two frames whose noise is
// independent differ by the root of two times it.
TEST_F(BlenderShot, StochasticNoiseOfWhatMoves) {
  const auto shot = [&](const std::string& name, std::vector<std::string> flags) {
    std::vector<std::string> arguments{"composite",
                                       from + "opaque.####.exr",
                                       from + "transparent_unlit.glb",
                                       "-o",
                                       folder + "/" + name + ".####.exr",
                                       "--camera",
                                       "cam",
                                       "--frames",
                                       "1002-1004"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
  };
  shot("truth", {});
  for (const char* noise : {"screen", "object"}) {
    double before = std::numeric_limits<double>::infinity();
    for (const char* samples : {"16", "64"}) {
      shot("noisy", {"--method", "stochastic", "--samples", samples, "--noise", noise});
      const Ended compared = runProgram({"compare", folder + "/noisy.####.exr", folder + "/truth.####.exr", "--json",
                                         "--fail", "1000", "--metadata", "ignore"});
      ASSERT_EQ(compared.code, 0) << compared.err;
      double spatial = 0.0, temporal = 0.0;
      const nlohmann::json report = nlohmann::json::parse(compared.out);
      for (const nlohmann::json& row : report["frames"])
        for (const nlohmann::json& layer : row["summary"]) {
          spatial = std::max(spatial, layer["rms"].get<double>());
          temporal = std::max(temporal, layer.value("temporalRms", 0.0));
        }
      printf("[ figure ] noise on %s, %s samples: rms %.5f, from frame to frame %.5f\n", noise, samples, spatial,
             temporal);
      EXPECT_GT(temporal, 0.0);
      EXPECT_LE(temporal, std::sqrt(2.0) * spatial);
      EXPECT_LT(temporal, 0.6 * before) << "four times the samples, half the noise";
      before = temporal;
    }
  }
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
  EXPECT_LE(measureError(beauty(out), beauty(truth)).rmse, 1e-5);
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
