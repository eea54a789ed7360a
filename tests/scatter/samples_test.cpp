// What a scene does not need is left out, and no bit of any sample's picture changes; the exact tier on every sample.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

std::vector<std::string> samplesIn(const std::string& folder) {
  RunOptions generator;
  generator.program = "pellucid_samples";
  EXPECT_EQ(runProgram({folder, "all", "90"}, generator).code, 0);
  std::vector<std::string> names;
  for (const std::string& file : filesIn(folder))
    if (file.size() > 4 && file.substr(file.size() - 4) == ".glb") names.push_back(file.substr(0, file.size() - 4));
  return names;
}

// Bits a pixel, and what was pruned.
nlohmann::json composite(const std::string& folder, const std::string& name, const std::string& out,
                         const std::vector<std::string>& flags) {
  RunOptions options;
  options.folder = folder;
  std::vector<std::string> arguments{"composite", name + ".exr", name + ".glb", "-o", out, "--stats", "--json"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  const Ended ended = runProgram(arguments, options);
  EXPECT_EQ(ended.code, 0) << ended.err;
  return nlohmann::json::parse(ended.out, nullptr, false).value("statistics", nlohmann::json::object());
}

TEST(EverySample, PruningChangesNoBit) {
  const std::string folder = freshFolder("every-sample");
  const std::vector<std::string> names = samplesIn(folder);
  ASSERT_GE(names.size(), 6u);
  std::printf("bits a pixel       float, all of it   published, all of it   solid pass\n");
  for (const std::string& name : names) {
    int bits[2][2];
    nlohmann::json pruned;
    for (const bool published : {false, true}) {
      const std::string precision = published ? "published" : "float";
      std::vector<std::string> flags{"--aa", "1", "--method", "phenomenological", "--precision", precision};
      // Texels of low resolution are floats in either tier: the layout of 112 bits is that of full resolution.
      if (published && (name == "mixed" || name == "street")) flags.insert(flags.end(), {"--low-res", "1"});
      pruned = composite(folder, name, "pruned.exr", flags);
      flags.emplace_back("--no-prune");
      const nlohmann::json full = composite(folder, name, "full.exr", flags);
      EXPECT_TRUE(slurp(folder + "/pruned.exr") == slurp(folder + "/full.exr")) << name << ' ' << precision;
      bits[published][0] = pruned["bitsPerPixel"];
      bits[published][1] = full["bitsPerPixel"];
    }
    std::printf("  %-12s %8d %8d   %12d %8d   %12d\n", name.c_str(), bits[0][0], bits[0][1], bits[1][0], bits[1][1],
                pruned["solidBitsPerPixel"].get<int>());
    EXPECT_EQ(bits[1][1], 112) << name;
    EXPECT_TRUE(bits[1][0] == 88 || bits[1][0] == 112) << name;
    EXPECT_LE(bits[0][0], bits[0][1]);
  }
  // Coverage alone: A, W, tau, and what the visibility of light and the files need, in float; table 2 without its
  // scattering in `published`.
  const nlohmann::json leaves =
      composite(folder, "foliage", "pruned.exr", {"--aa", "1", "--method", "phenomenological"});
  EXPECT_EQ(leaves["bitsPerPixel"], 352);
}

// The picture is its layers: in ulps of the picture's own half floats.
TEST(EverySample, PictureIsTransparentPlusTransmissionTimesBackground) {
  const std::string folder = freshFolder("every-sample-layers");
  for (const std::string& name : samplesIn(folder)) {
    composite(folder, name, "out.exr",
              {"--aa", "2", "--refract", "off", "--diffusion", "off", "--layers", "transparent,transmission"});
    const GBuffer before = readOpaque(folder + "/" + name + ".exr", {}).gbuffer;
    const GBuffer after = readOpaque(folder + "/out.exr", {}).gbuffer;
    const ExrDocument file = readExr(folder + "/out.exr");
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
      const std::string channel(1, "RGB"[c]);
      const ExrChannel *light = nullptr, *passed = nullptr;
      for (const ExrPart& part : file.parts) {
        if (!light) light = part.find("transparent." + channel);
        if (!passed) passed = part.find("transmission." + channel);
      }
      ASSERT_TRUE(light && passed) << name;
      for (std::size_t i = 0; i < before.beauty.size(); ++i) {
        float l = 0, t = 0;
        std::memcpy(&l, light->bytes.data() + i * sizeof l, sizeof l);
        std::memcpy(&t, passed->bytes.data() + i * sizeof t, sizeof t);
        const double expected =
            static_cast<double>(l) + static_cast<double>(t) * static_cast<double>(before.beauty[i][c]);
        const double ulp = std::ldexp(1.0, std::max(std::ilogb(std::max(expected, 1e-30)), -14) - 10);
        worst = std::max(worst, std::abs(static_cast<double>(after.beauty[i][c]) - expected) / ulp);
      }
    }
    std::printf("%-10s picture - (transparent + transmission x background): at most %.3f ulp\n", name.c_str(), worst);
    EXPECT_LE(worst, 1.0) << name;
  }
}

// The samples with hundreds of thousands of triangles are left to ./dev campaign: fifteen tiles draw them fifteen
// times.
TEST(EverySample, TwentyShufflesChangeNoBitOfTheExactTier) {
  RunOptions options;
  options.program = "campaign_order";
  const Ended ended = runProgram({"20", "ball", "bars", "bottles", "foliage", "frosted", "smoke", "stacks"}, options);
  std::printf("%s%s", ended.out.c_str(), ended.err.c_str());
  EXPECT_EQ(ended.code, 0);
}

}  // namespace
}  // namespace pellucid::test
