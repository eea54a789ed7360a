// Which textures are masks, and what their mip levels cover.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "engine_bridge/scene/foliage.h"
#include "samples/foliage/plants.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using Alpha = Image<float>;

Image<glm::vec4> textureOf(const Alpha& alpha) {
  Image<glm::vec4> texels(alpha.width(), alpha.height());
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec4(0.3f, 0.5f, 0.2f, alpha[i]);
  return texels;
}

Alpha alphaOf(const Image<glm::vec4>& texels) {
  Alpha alpha(texels.width(), texels.height());
  for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = texels[i].a;
  return alpha;
}

Alpha drawn(int edge, const std::function<double(double, double)>& value) {
  Alpha alpha(edge, edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x)
      alpha.at(x, y) = static_cast<float>(std::clamp(value((x + 0.5) / edge, (y + 0.5) / edge), 0.0, 1.0));
  return alpha;
}

// As an 8-bit file holds it.
Alpha eightBit(Alpha alpha) {
  for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = std::round(alpha[i] * 255.0f) / 255.0f;
  return alpha;
}

// Averaged from `factor` times as many texels: an antialiased border.
Alpha reduced(const Alpha& fine, int factor) {
  Alpha coarse(fine.width() / factor, fine.height() / factor);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x)
      for (int k = 0; k < factor * factor; ++k)
        coarse.at(x, y) +=
            fine.at(x * factor + k % factor, y * factor + k / factor) / static_cast<float>(factor * factor);
  return eightBit(coarse);
}

Alpha blurred(const Alpha& alpha, int radius) {
  Alpha out(alpha.width(), alpha.height());
  for (int y = 0; y < alpha.height(); ++y)
    for (int x = 0; x < alpha.width(); ++x) {
      double sum = 0, count = 0;
      for (int v = std::max(y - radius, 0); v <= std::min(y + radius, alpha.height() - 1); ++v)
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, alpha.width() - 1); ++u)
          sum += static_cast<double>(alpha.at(u, v)), ++count;
      out.at(x, y) = static_cast<float>(sum / count);
    }
  return out;
}

// Through a JPEG encoder and back.
Alpha jpeg(const Alpha& alpha, int quality) {
  const std::string path = std::string(PELLUCID_BINARY_DIR) + "/mask.jpg";
  std::vector<unsigned char> grey(alpha.size()), back(alpha.size());
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<unsigned char>(std::lround(alpha[i] * 255.0f));
  OIIO::ImageSpec spec(alpha.width(), alpha.height(), 1, OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", "jpeg:" + std::to_string(quality));
  auto out = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(out && out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT8, grey.data()) && out->close());
  auto in = OIIO::ImageInput::open(path);
  EXPECT_TRUE(in && in->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, back.data()));
  Alpha decoded(alpha.width(), alpha.height());
  for (std::size_t i = 0; i < back.size(); ++i) decoded[i] = static_cast<float>(back[i]) / 255.0f;
  return decoded;
}

struct Case {
  const char* name;
  bool binary;
  Alpha alpha;
};

std::vector<Case> twentyTextures() {
  const Alpha leaf = alphaOf(samples::leafMask(256)), slats = alphaOf(samples::slatMask(256));
  const Alpha wire = drawn(256, [](double u, double v) {
    const double a = std::abs(std::remainder(8 * (u + v), 1.0)), b = std::abs(std::remainder(8 * (u - v), 1.0));
    return std::min(a, b) < 0.14 ? 1.0 : 0.0;
  });
  test::Random random(5);
  const Alpha speckle = drawn(128, [&](double, double) { return random.uniform() < 0.4 ? 1.0 : 0.0; });
  const Alpha noise = drawn(128, [&](double, double) { return random.uniform(); });
  const Alpha puff = drawn(128, [](double u, double v) { return 1.2 - 2.6 * std::hypot(u - 0.5, v - 0.5); });
  std::vector<Case> cases;
  cases.push_back({"leaf", true, leaf});
  cases.push_back({"slats", true, slats});
  cases.push_back({"wire", true, wire});
  cases.push_back({"speckle of single texels", true, speckle});
  cases.push_back({"leaf, antialiased 8-bit border", true, reduced(alphaOf(samples::leafMask(1024)), 4)});
  cases.push_back({"slats, antialiased 8-bit border", true, reduced(alphaOf(samples::slatMask(512)), 2)});
  cases.push_back({"leaf, JPEG 90", true, jpeg(leaf, 90)});
  cases.push_back({"slats, JPEG 75", true, jpeg(slats, 75)});
  cases.push_back({"antialiased leaf, JPEG 80", true, jpeg(reduced(alphaOf(samples::leafMask(1024)), 4), 80)});
  cases.push_back({"leaf from 4 to 250 of 255", true, drawn(256, [&](double u, double v) {
                     const bool in = leaf.at(static_cast<int>(u * 256), static_cast<int>(v * 256)) > 0.5f;
                     return (in ? 250.0 : 4.0) / 255.0;
                   })});
  cases.push_back({"smoke puff", false, puff});
  cases.push_back({"puff, JPEG 90", false, jpeg(eightBit(puff), 90)});
  cases.push_back({"white noise", false, noise});
  cases.push_back({"leaf, soft border of 13 texels", false, blurred(leaf, 6)});
  cases.push_back({"constant half", false, drawn(64, [](double, double) { return 0.5; })});
  cases.push_back({"constant one", false, drawn(64, [](double, double) { return 1.0; })});
  cases.push_back({"constant zero", false, drawn(64, [](double, double) { return 0.0; })});
  cases.push_back({"ramp", false, drawn(128, [](double u, double) { return u; })});
  cases.push_back({"checker of .2 and .8", false, drawn(128, [](double u, double v) {
                     return std::fmod(std::floor(8 * u) + std::floor(8 * v), 2.0) < 0.5 ? 0.2 : 0.8;
                   })});
  cases.push_back({"cut-out stained glass of .5", false,
                   drawn(128, [](double u, double v) { return std::hypot(u - 0.5, v - 0.5) < 0.4 ? 0.5 : 0.0; })});
  cases.push_back({"leaf with a veil of .4 in it", false, drawn(256, [&](double u, double v) {
                     const float a = leaf.at(static_cast<int>(u * 256), static_cast<int>(v * 256));
                     return static_cast<double>(a) * (v < 0.5 ? 0.4 : 1.0);
                   })});
  return cases;
}

TEST(Masks, BinaryIsMeasuredOnBothKinds) {
  int binary = 0, other = 0;
  for (const Case& c : twentyTextures()) {
    const MaskMeasure measure = measureMask(textureOf(c.alpha));
    printf("[ figure ] %-34s %-6s between %.4f unexplained %.5f\n", c.name, measure.binary ? "binary" : "no",
           measure.between, measure.unexplained);
    EXPECT_EQ(measure.binary, c.binary) << c.name;
    ++(c.binary ? binary : other);
  }
  EXPECT_GE(binary, 10);
  EXPECT_GE(other, 10);
}

TEST(Masks, NothingIsNoMask) {
  EXPECT_FALSE(measureMask(Image<glm::vec4>()).binary);
  EXPECT_FALSE(measureMask(Image<glm::vec4>(1, 1, glm::vec4(1.0f))).binary);
}

Scene sceneOf(const Alpha& alpha) {
  Scene scene;
  scene.textures.resize(1);
  scene.textures[0].texels = textureOf(alpha);
  Material material;
  material.alphaMode = AlphaMode::mask;
  material.baseColorTexture.texture = 0;
  scene.materials.push_back(material);
  return scene;
}

TEST(Masks, OnlyLitOpaqueCutOutsInfer) {
  Scene scene = sceneOf(alphaOf(samples::leafMask(64)));
  Material& material = scene.materials[0];
  EXPECT_TRUE(infersOcclusion(material, scene));
  material.alphaMode = AlphaMode::blend;
  EXPECT_TRUE(infersOcclusion(material, scene));
  material.baseColor.a = 0.5f;
  EXPECT_FALSE(infersOcclusion(material, scene));
  material.baseColor.a = 1.0f;
  material.transmission = 0.4f;
  EXPECT_FALSE(infersOcclusion(material, scene));
  material.transmission = 0.0f;
  material.unlit = true;
  EXPECT_FALSE(infersOcclusion(material, scene));
  material.unlit = false;
  material.alphaMode = AlphaMode::opaque;
  EXPECT_FALSE(infersOcclusion(material, scene));
  Scene smoke = sceneOf(drawn(64, [](double u, double) { return u; }));
  smoke.materials[0].alphaMode = AlphaMode::blend;
  EXPECT_FALSE(infersOcclusion(smoke.materials[0], smoke));
}

TEST(Mips, EveryLevelCoversWhatTheFinestCovers) {
  for (const auto& [name, mask, cutoff] :
       {std::make_tuple("leaf", samples::leafMask(256), 0.5f), std::make_tuple("slats", samples::slatMask(256), 0.5f),
        std::make_tuple("leaf cut at .8", samples::leafMask(256), 0.8f)}) {
    const std::vector<Image<glm::vec4>> levels = coveragePreservingMips(mask, cutoff);
    ASSERT_EQ(levels.size(), 9u);
    EXPECT_EQ(levels.back().size(), 1u);
    const double wanted = coveredArea(levels[0], cutoff);
    double most = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
      // Below 16x16 texels a leaf is a handful of patches: the area moves in steps.
      if (levels[i].width() >= 16) most = std::max(most, std::abs(coveredArea(levels[i], cutoff) - wanted));
      for (std::size_t k = 0; k < levels[i].size(); ++k) {
        EXPECT_GE(levels[i][k].a, 0.0f);
        EXPECT_LE(levels[i][k].a, 1.0f);
      }
    }
    printf("[ figure ] %s: covers %.4f, largest difference to 16x16 texels %.4f\n", name, wanted, most);
    EXPECT_LE(most, 0.01);
  }
}

TEST(Mips, ColoursOfWhatIsCutAwayStayOut) {
  Image<glm::vec4> texels(4, 4, glm::vec4(1.0f, 0.0f, 1.0f, 0.0f));
  for (int x = 0; x < 4; ++x) texels.at(x, 0) = glm::vec4(0.0f, 1.0f, 0.0f, 1.0f);
  const std::vector<Image<glm::vec4>> levels = coveragePreservingMips(texels, 0.5f);
  EXPECT_EQ(glm::vec3(levels[1].at(0, 0)), glm::vec3(0.0f, 1.0f, 0.0f));
  EXPECT_EQ(glm::vec3(levels[1].at(0, 1)), glm::vec3(1.0f, 0.0f, 1.0f));
  EXPECT_EQ(levels[1].at(0, 1).a, 0.0f);
}

TEST(Mips, OddSizesAndExtremesHold) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {7, 3}, {1, 9}, {33, 17}}) {
    const auto levels =
        coveragePreservingMips(Image<glm::vec4>(size.x, size.y, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f)), 0.5f);
    EXPECT_EQ(levels.back().size(), 1u);
    for (const auto& level : levels) EXPECT_EQ(coveredArea(level, 0.5f), 1.0);
    EXPECT_EQ(levels.back()[0].a, 1.0f);
    const auto clear = coveragePreservingMips(Image<glm::vec4>(size.x, size.y, glm::vec4(0.0f)), 0.5f);
    for (const auto& level : clear) EXPECT_EQ(coveredArea(level, 0.5f), 0.0);
  }
}

}  // namespace
}  // namespace pellucid
