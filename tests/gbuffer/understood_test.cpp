// What is said of a picture's depths.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "gbuffer/opaque_io.h"

namespace pellucid {
namespace {

std::string depthLine(const std::vector<float>& depths) {
  OpaqueFile file;
  file.document.parts.emplace_back();
  file.choice.depthChannel = "Z";
  file.gbuffer.viewZ = Image<float>(static_cast<int>(depths.size()), 1);
  std::copy(depths.begin(), depths.end(), file.gbuffer.viewZ.data());
  for (const float z : depths) file.choice.farPixels += std::isinf(z);
  return understoodLines(file)[1];
}

// The definition: the one in the middle of those that were hit, the upper of two.
float middleOf(std::vector<float> depths) {
  std::erase_if(depths, [](float z) { return !std::isfinite(z); });
  std::sort(depths.begin(), depths.end());
  return depths[depths.size() / 2];
}

TEST(Understood, MedianIsExact) {
  std::mt19937 random(5);
  const std::vector<float> scales{1e-30f, 1.0f, 1e8f};
  for (const std::size_t size : {1u, 2u, 3u, 10u, 999u, 200000u})
    for (const float spread : {1e-6f, 0.5f, 30.0f}) {
      std::vector<float> depths(size);
      for (float& z : depths) {
        z = std::exp(std::uniform_real_distribution<float>(-spread, spread)(random));
        if (random() % 5 == 0) z = std::numeric_limits<float>::infinity();
      }
      depths[0] = scales[random() % scales.size()];
      const std::string expected = fmt::format("median {:.6g} m", middleOf(depths));
      EXPECT_NE(depthLine(depths).find(expected), std::string::npos) << depthLine(depths) << ", expected " << expected;
    }
}

// A sample that is drawn in steps would meet the same column again and again.
TEST(Understood, MedianOfAPattern) {
  std::vector<float> depths(1 << 18);
  for (std::size_t i = 0; i < depths.size(); ++i)
    depths[i] = i % 16 == 0 ? 1.0f : 2.0f + static_cast<float>(i % 16) * 1e-3f + static_cast<float>(i) * 1e-9f;
  const std::string expected = fmt::format("median {:.6g} m", middleOf(depths));
  EXPECT_NE(depthLine(depths).find(expected), std::string::npos) << depthLine(depths) << ", expected " << expected;
}

TEST(Understood, NothingWasHit) {
  const std::string line = depthLine(std::vector<float>(7, std::numeric_limits<float>::infinity()));
  EXPECT_EQ(line.find("median"), std::string::npos) << line;
  EXPECT_NE(line.find("100% of the pixels show nothing"), std::string::npos) << line;
}

// Numbers of another unit or kind are told as metres, too; those that are metres once.
TEST(Understood, TheRangeInMetres) {
  OpaqueFile file;
  file.document.parts.emplace_back();
  file.choice.depthChannel = "Z";
  file.choice.depthKind = "inverse";
  file.choice.least = 0.125;
  file.choice.most = 0.5;
  file.gbuffer.viewZ = Image<float>(2, 1, 2.0f);
  file.gbuffer.viewZ[1] = 8.0f;
  EXPECT_NE(understoodLines(file)[1].find("0.125 to 0.5, which is 2 to 8 m, median 8 m"), std::string::npos)
      << understoodLines(file)[1];
  file.choice.depthKind = "planar";
  file.choice.least = 2.0;
  file.choice.most = 8.0;
  EXPECT_NE(understoodLines(file)[1].find("(planar), 2 to 8, median 8 m"), std::string::npos);
}

}  // namespace
}  // namespace pellucid
