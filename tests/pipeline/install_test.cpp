// The installed compositor, from outside: a program of less than 40 lines that knows it by find_package alone makes
// the picture of `pellucid composite`.
#include <gtest/gtest.h>

#include <algorithm>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/support/shell.h"

namespace pellucid::test {
namespace {

TEST(PipelineInstall, AnOutsideProgramCompositesAShot) {
  if (sanitized()) GTEST_SKIP() << "a library built with a sanitizer wants programs built with it";
  const std::string folder = freshFolder("pipeline-install"), source = PELLUCID_SOURCE_DIR "/tests/pipeline/outside";
  const Ended built =
      shell("cmake --install '" PELLUCID_BINARY_DIR "' --prefix '" + folder + "/prefix' && cmake -G Ninja -S '" +
                source + "' -B '" + folder + "/build' -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH='" + folder +
                "/prefix' && cmake --build '" + folder + "/build'",
            folder);
  ASSERT_EQ(built.code, 0) << built.out;
  const std::string text = slurp(source + "/main.cpp");
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 40);
  RunOptions options;
  options.folder = folder;
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "bottles", "90"}, generator).code, 0);
  const Ended outside = shell("cd '" + folder + "' && build/outside bottles.exr bottles.glb outside.exr", folder);
  ASSERT_EQ(outside.code, 0) << outside.out;
  const Ended ours = runProgram(
      {"composite", "bottles.exr", "bottles.glb", "-o", "ours.exr", "--method", "phenomenological", "--aa", "2"},
      options);
  ASSERT_EQ(ours.code, 0) << ours.err;
  const Image<glm::vec4> one = readOpaque(folder + "/outside.exr", {}).gbuffer.beauty,
                         two = readOpaque(folder + "/ours.exr", {}).gbuffer.beauty,
                         before = readOpaque(folder + "/bottles.exr", {}).gbuffer.beauty;
  ASSERT_EQ(one.size(), two.size());
  std::size_t differing = 0, changed = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    differing += one[i] != two[i];
    changed += one[i] != before[i];
  }
  std::printf("%zu of %zu pixels under glass, %zu differ from the program's\n", changed, one.size(), differing);
  EXPECT_EQ(differing, 0u);
  EXPECT_GT(changed, one.size() / 20);
}

}  // namespace
}  // namespace pellucid::test
