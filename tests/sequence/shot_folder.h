// A small shot on disk: frames of a sample's picture, and its glass.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace pellucid::test {

class ShotFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("sequence");
    options.folder = folder;
  }
  // shot.N.exr for each frame, and glass.glb.
  void makeShot(const std::vector<int>& frames, const std::string& sample = "bars", const std::string& height = "90") {
    RunOptions generator = options;
    generator.program = "pellucid_samples";
    ASSERT_EQ(runProgram({".", sample, height}, generator).code, 0);
    for (const int frame : frames)
      std::filesystem::copy_file(folder + "/" + sample + ".exr", folder + "/shot." + std::to_string(frame) + ".exr");
    std::filesystem::rename(folder + "/" + sample + ".glb", folder + "/glass.glb");
  }
  Ended run(const std::vector<std::string>& arguments) { return runProgram(arguments, options); }
  Ended composite(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"composite", "shot.####.exr", "glass.glb", "-o", "out.####.exr", "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  bool there(const std::string& name) const { return std::filesystem::exists(folder + "/" + name); }
  std::string bytes(const std::string& name) const { return slurp(folder + "/" + name); }
  // Names of files left behind under temporary names.
  std::vector<std::string> debris() const {
    std::vector<std::string> names;
    for (const std::string& name : filesIn(folder))
      if (name.find(".tmp") != std::string::npos) names.push_back(name);
    return names;
  }

  std::string folder;
  RunOptions options;
};

inline void expectIn(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text << "\n  lacks " << part;
}

}  // namespace pellucid::test
