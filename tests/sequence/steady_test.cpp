// What stands still does not flicker, and what flickers is measured.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "composite/compare/temporal.h"
#include "tests/sequence/shot_folder.h"

namespace pellucid {
namespace {

using namespace test;

ExrDocument flatPicture(const std::vector<float>& values) {
  ExrDocument document;
  ExrPart part;
  part.display = part.data = {0, 0, static_cast<int>(values.size()), 1};
  ExrChannel channel;
  channel.name = "R";
  channel.bytes.resize(values.size() * sizeof(float));
  std::memcpy(channel.bytes.data(), values.data(), channel.bytes.size());
  part.channels.push_back(std::move(channel));
  document.parts.push_back(std::move(part));
  return document;
}

TEST(Temporal, OfTwoSequencesByHand) {
  TemporalError error;
  const CompareSettings settings;
  EXPECT_TRUE(error.next(flatPicture({1, 2}), flatPicture({0, 0}), settings).empty()) << "nothing before it";
  // The first value changes by 2 more than that of the other sequence, the second alike.
  std::vector<TemporalLayer> layers = error.next(flatPicture({4, 5}), flatPicture({1, 3}), settings);
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_EQ(layers[0].values, 2u);
  EXPECT_EQ(layers[0].changed, 1u);
  EXPECT_DOUBLE_EQ(layers[0].largest, 2.0);
  EXPECT_DOUBLE_EQ(layers[0].rms, std::sqrt(2.0));
  // NaN is no change, and a frame of another size has none before it.
  layers = error.next(flatPicture({NAN, 5}), flatPicture({1, 3}), settings);
  EXPECT_EQ(layers[0].values, 1u);
  EXPECT_EQ(layers[0].changed, 0u);
  EXPECT_TRUE(error.next(flatPicture({1}), flatPicture({1}), settings).empty());
  error.forget();
  EXPECT_TRUE(error.next(flatPicture({1}), flatPicture({1}), settings).empty());
}

class Steady : public ShotFolder {
 protected:
  // The table of `compare` along the frames against the picture of the first one.
  nlohmann::json flickerOf(const std::vector<std::string>& method) {
    std::vector<std::string> arguments{"--frames", "1001-1020", "--jobs", "2"};
    arguments.insert(arguments.end(), method.begin(), method.end());
    const Ended made = composite(arguments);
    EXPECT_EQ(made.code, 0) << made.err;
    const Ended compared = run({"compare", "out.####.exr", "out.1001.exr", "--json", "--fail", "1000"});
    EXPECT_EQ(compared.code, 0) << compared.err;
    return nlohmann::json::parse(compared.out)["frames"];
  }
};

TEST_F(Steady, AStaticShotOfTwentyFrames) {
  std::vector<int> frames;
  for (int frame = 1001; frame <= 1020; ++frame) frames.push_back(frame);
  makeShot(frames, "smoke");
  const std::vector<std::vector<std::string>> methods{
      {"--method", "over"},
      {"--method", "phenomenological"},
      {"--method", "phenomenological", "--precision", "exact"},
      {"--method", "phenomenological", "--weight", "auto"},
      {"--method", "stochastic", "--samples", "4"},
      {"--method", "stochastic", "--samples", "4", "--noise", "object"},
  };
  for (const std::vector<std::string>& method : methods) {
    const nlohmann::json rows = flickerOf(method);
    ASSERT_EQ(rows.size(), 20u);
    std::size_t changed = 0, values = 0;
    for (const nlohmann::json& row : rows)
      for (const nlohmann::json& layer : row["summary"]) {
        changed += layer.value("temporalChanged", std::size_t{0});
        values += layer.value("values", std::size_t{0});
        EXPECT_EQ(layer["rms"], 0.0) << method[1];
      }
    std::printf("%s: %zu of %zu values change\n", method.back().c_str(), changed, values);
    EXPECT_GT(values, 19u * 160u * 90u * 3u) << "every frame but the first has one before it";
    EXPECT_EQ(changed, 0u) << method[1] << ": the seed is that of all frames";
  }
}

TEST_F(Steady, ATableOfBothErrors) {
  makeShot({1001, 1002, 1003});
  ASSERT_EQ(composite({"--frames", "1001-1002"}).code, 0);
  ASSERT_EQ(run({"composite", "shot.1003.exr", "glass.glb", "-o", "out.1003.exr", "--method", "sum", "--aa", "1"}).code,
            0);
  const Ended ended = run({"compare", "out.####.exr", "shot.####.exr", "--fail", "1000", "--metadata", "ignore"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  expectIn("temporal rms", ended.out);
  expectIn("temporal error: rms at most ", ended.out);
  expectIn(" in frame 1003; ", ended.out);
  const Ended differs = run({"compare", "out.####.exr", "shot.####.exr", "--metadata", "ignore"});
  EXPECT_EQ(differs.code, 1);
  expectIn("3 of 3 frames differ: 1001-1003", differs.err);
  std::filesystem::remove(folder + "/shot.1002.exr");
  const Ended missing = run({"compare", "out.####.exr", "shot.####.exr", "--metadata", "ignore"});
  EXPECT_EQ(missing.code, 5) << "a frame that is missing weighs more than one that differs";
  expectIn("1 of 3 frames failed: 1002", missing.err);
}

}  // namespace
}  // namespace pellucid
