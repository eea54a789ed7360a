// Every sample, composited by the sums that engines draw, and bottles by other methods, against the picture kept of it.
// `./dev golden` renews what is kept: look at what has changed before it is committed.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace pellucid::test {
namespace {

struct Shot {
  const char* name;
  const char* sample;
  std::vector<std::string> flags;
};

void PrintTo(const Shot& shot, std::ostream* out) {
  *out << shot.name;
}

const std::vector<Shot> kShots = {
    {"ball", "ball", {"--method", "phenomenological"}},
    {"bars", "bars", {"--method", "phenomenological"}},
    {"bottles", "bottles", {"--method", "phenomenological", "--environment", "0.34,0.37,0.42"}},
    {"bottles-front+tail", "bottles", {"--environment", "0.34,0.37,0.42", "--method", "front+tail"}},
    {"bottles-over", "bottles", {"--environment", "0.34,0.37,0.42", "--method", "over"}},
    {"bottles-published",
     "bottles",
     {"--method", "phenomenological", "--environment", "0.34,0.37,0.42", "--precision", "published"}},
    {"bottles-stochastic", "bottles", {"--environment", "0.34,0.37,0.42", "--method", "stochastic"}},
    {"cad", "cad", {"--method", "phenomenological", "--environment", "0.3,0.32,0.35"}},
    {"chess", "chess", {"--method", "phenomenological", "--shadows", "stochastic"}},
    {"clouds", "clouds", {"--method", "phenomenological", "--weight-range", "300:3000"}},
    {"foliage", "foliage", {"--method", "phenomenological"}},
    {"frosted", "frosted", {"--method", "phenomenological"}},
    {"hair", "hair", {"--method", "phenomenological"}},
    {"mixed", "mixed", {"--method", "phenomenological", "--low-res", "2"}},
    {"shadows", "shadows", {"--method", "phenomenological", "--shadows", "exact"}},
    {"shafts",
     "shafts",
     {"--method", "phenomenological", "--fog", "density=.12,g=.5,albedo=.95,shafts=160,steps=128", "--environment",
      ".05,.055,.065"}},
    {"smoke", "smoke", {"--method", "phenomenological"}},
    {"smokeball", "smokeball", {"--method", "phenomenological", "--particle-light", "32", "--shadows", "exact"}},
    {"sparks", "sparks", {"--method", "phenomenological", "--shadows", "exact"}},
    {"street", "street", {"--method", "phenomenological"}}};

const char* const kRows = "54";
const std::string kKept = std::string(PELLUCID_SOURCE_DIR) + "/tests/golden/";

bool renews() {
  const char* wish = std::getenv("PELLUCID_GOLDEN");
  return wish && std::string(wish) == "renew";
}

std::string keptName(const Shot& shot) {
  return kKept + shot.name + ".exr";
}

class Golden : public ::testing::TestWithParam<Shot> {};

// The same machine gives the same bits. Another driver, or a processor with other instructions, rounds otherwise (kept
// are halves, 2^-11 of a value) and puts samples on the other side of edges: of 5184 pixels that is some.
constexpr double kDark = 0.05, kMostMean = 1e-3, kFar = 0.02, kMostFar = 0.01;

TEST_P(Golden, IsAsItWas) {
  const Shot& shot = GetParam();
  const std::string folder = freshFolder(std::string("golden-") + shot.name),
                    stem = std::string(folder) + "/" + shot.sample;
  RunOptions samples;
  samples.program = "pellucid_samples";
  const Ended made = runProgram({folder, shot.sample, kRows}, samples);
  ASSERT_EQ(made.code, 0) << made.err;
  std::vector<std::string> arguments{"composite", stem + ".exr", stem + ".glb", "-o", folder + "/out.exr"};
  arguments.insert(arguments.end(), shot.flags.begin(), shot.flags.end());
  const Ended ended = runProgram(arguments);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const OIIO::ImageBuf whole(folder + "/out.exr");
  std::vector<int> rgba;
  for (const char* channel : {"R", "G", "B", "A"}) rgba.push_back(whole.spec().channelindex(channel));
  OIIO::ImageBuf found = OIIO::ImageBufAlgo::channels(whole, 4, rgba);
  ASSERT_FALSE(found.has_error()) << found.geterror();
  if (renews()) {
    OIIO::ImageBuf kept(OIIO::ImageSpec(found.spec().width, found.spec().height, 4, OIIO::TypeDesc::HALF));
    kept.specmod().attribute("compression", "zip");
    ASSERT_TRUE(OIIO::ImageBufAlgo::paste(kept, 0, 0, 0, 0, found));
    ASSERT_TRUE(kept.write(keptName(shot))) << kept.geterror();
    std::printf("renewed %s.exr\n", shot.name);
    return;
  }
  const OIIO::ImageBuf kept(keptName(shot));
  ASSERT_TRUE(kept.initialized()) << keptName(shot) << " is not there: ./dev golden writes it";
  ASSERT_EQ(kept.spec().width, found.spec().width);
  ASSERT_EQ(kept.spec().height, found.spec().height);
  double sum = 0, largest = 0;
  int far = 0;
  const int pixels = found.spec().width * found.spec().height;
  for (int i = 0; i < pixels; ++i) {
    double off = 0;
    for (int c = 0; c < 4; ++c) {
      const double a = kept.getchannel(i % found.spec().width, i / found.spec().width, 0, c),
                   b = found.getchannel(i % found.spec().width, i / found.spec().width, 0, c);
      ASSERT_TRUE(std::isfinite(b));
      off = std::max(off, std::abs(a - b) / std::max(kDark, std::abs(a)));
    }
    sum += off;
    largest = std::max(largest, off);
    far += off > kFar;
  }
  std::printf("%s: off what is kept by %.2g on average, %.2g at most; %d of %d pixels by more than %.2g\n", shot.name,
              sum / pixels, largest, far, pixels, kFar);
  EXPECT_LE(sum / pixels, kMostMean);
  EXPECT_LE(far, kMostFar * pixels);
}

INSTANTIATE_TEST_SUITE_P(Samples, Golden, ::testing::ValuesIn(kShots), [](const auto& instance) {
  std::string name = instance.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '+'; }, '_');
  return name;
});

TEST(GoldenFiles, EveryPictureHasItsShotAndEverySampleOne) {
  std::set<std::string> names, samples, kept, folders;
  for (const Shot& shot : kShots) names.insert(shot.name), samples.insert(shot.sample);
  for (const auto& entry : std::filesystem::directory_iterator(kKept))
    if (entry.path().extension() == ".exr") kept.insert(entry.path().stem());
  EXPECT_EQ(kept, names);
  RunOptions program;
  program.program = "pellucid_samples";
  const Ended ended = runProgram({freshFolder("golden-names"), "nothing"}, program);  // its refusal lists them
  for (const std::string& sample : samples) EXPECT_NE(ended.err.find(sample), std::string::npos) << sample;
  EXPECT_EQ(static_cast<std::size_t>(std::count(ended.err.begin(), ended.err.end(), ',')), samples.size()) << ended.err;
}

}  // namespace
}  // namespace pellucid::test
