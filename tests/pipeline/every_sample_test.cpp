// accumulate, then resolve, is composite --method phenomenological on every sample: not one bit of a pixel differs.
#include <gtest/gtest.h>

#include <cstring>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

using Flags = std::vector<std::string>;

class EverySampleInTwoSteps : public ::testing::TestWithParam<std::pair<const char*, Flags>> {
 protected:
  RunOptions options;
  Ended run(Flags arguments, const Flags& more = {}) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
};

std::vector<std::string> scenesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const std::string& file : filesIn(folder))
    if (file.size() > 4 && file.substr(file.size() - 4) == ".glb") names.push_back(file.substr(0, file.size() - 4));
  return names;
}

std::size_t differingBits(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) != 0;
  return count;
}

TEST_P(EverySampleInTwoSteps, IsThePictureOfComposite) {
  options.folder = freshFolder("two-steps-every-sample");
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "all", "90"}, generator).code, 0);
  const Flags& flags = GetParam().second;
  int samples = 0, withoutLamps = 0;
  std::size_t pixels = 0, changed = 0;
  for (const std::string& name : scenesIn(options.folder)) {
    SCOPED_TRACE(name);
    const std::string opaque = name + ".exr";
    const Ended once =
        run({"composite", opaque, name + ".glb", "-o", "one.exr", "--method", "phenomenological", "--aa", "1"}, flags);
    if (once.code == 4 && once.err.find("no punctual light") != std::string::npos) {
      ++withoutLamps;
      continue;
    }
    ASSERT_EQ(once.code, 0) << once.err;
    const Ended sums = run({"accumulate", opaque, name + ".glb", "-o", "planes.exr"}, flags);
    ASSERT_EQ(sums.code, 0) << sums.err;
    const Ended resolved = run({"resolve", opaque, "planes.exr", "-o", "two.exr"});
    ASSERT_EQ(resolved.code, 0) << resolved.err;
    const Image<glm::vec4> one = readOpaque(options.folder + "/one.exr", {}).gbuffer.beauty,
                           two = readOpaque(options.folder + "/two.exr", {}).gbuffer.beauty,
                           before = readOpaque(options.folder + "/" + opaque, {}).gbuffer.beauty;
    ASSERT_EQ(one.size(), two.size());
    EXPECT_EQ(differingBits(one, two), 0u);
    pixels += one.size();
    changed += differingBits(one, before);
    ++samples;
  }
  std::printf("%s: %d samples, %zu pixels, %zu of them changed by layers: 0 differ; %d without lamps\n",
              GetParam().first, samples, pixels, changed, withoutLamps);
  EXPECT_GE(samples, 3);
  EXPECT_GT(changed, pixels / 50);
}

INSTANTIATE_TEST_SUITE_P(Flags, EverySampleInTwoSteps,
                         ::testing::Values(std::pair{"none", Flags{}},
                                           std::pair{"shadows", Flags{"--shadows", "exact"}},
                                           std::pair{"fog", Flags{"--fog", "density=.05"}},
                                           std::pair{"exact", Flags{"--precision", "exact"}},
                                           std::pair{"published", Flags{"--precision", "published"}}),
                         [](const auto& each) { return std::string(each.param.first); });

}  // namespace
}  // namespace pellucid::test
