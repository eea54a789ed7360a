// The shot that moves of ../shared/assets, rendered by Blender. Tests of it are skipped where it is absent.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "composite/error.h"
#include "gbuffer/exr_document.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"

namespace pellucid::test {

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
  static Image<glm::vec4> beauty(const std::string& path) { return beauty(path, prefixOf(path)); }
  static std::string prefixOf(const std::string& path) {
    const ExrDocument document = readExr(path);
    for (const ExrChannel& channel : document.parts[0].channels)
      if (channel.name == "ViewLayer.Combined.R") return "ViewLayer.Combined.";
    return "";
  }
  //   opaque, scene, truth  files of any folder
  ErrorStatistics errorOfFiles(const std::string& opaque, const std::string& scene, const std::string& truth,
                               const std::vector<std::string>& flags) {
    const std::string out = folder + "/out.exr";
    std::vector<std::string> arguments{"composite", opaque, scene, "-o", out, "--camera", "cam"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    last = runProgram(arguments);
    EXPECT_EQ(last.code, 0) << last.err;
    return measureError(beauty(out), beauty(truth));
  }
  ErrorStatistics errorOf(const std::string& opaque, const std::string& truth, const std::vector<std::string>& flags) {
    return errorOfFiles(from + opaque, from + "transparent_unlit.glb", from + truth, flags);
  }

  std::string from, folder;
  Ended last;
};

}  // namespace pellucid::test
