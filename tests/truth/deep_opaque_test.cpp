// A deep picture as the opaque one, and deep tiles: both against the flatten that is itself held against brute force.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepTiledOutputFile.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "composite/deep/deep_opaque.h"
#include "composite/error.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/exr_document.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;
constexpr int kWidth = 48, kHeight = 40;
const std::vector<std::string> kLayerNames{"R", "G", "B", "A", "AR", "AG", "AB", "Z"};

void writeDeep(const std::string& path, const DeepRows& rows) {
  DeepHeader header;
  header.display = header.data = rows.window;
  header.channels = kLayerNames;
  DeepWriter writer(path, header);
  writer.write(rows);
  writer.finish();
}

void add(DeepRows& rows, const glm::vec3& light, const glm::vec3& opacity, float z) {
  const float values[] = {light.r,   light.g,   light.b,   (opacity.r + opacity.g + opacity.b) / 3,
                          opacity.r, opacity.g, opacity.b, z};
  for (std::size_t c = 0; c < 8; ++c) rows.channels[c].push_back(values[c]);
}

DeepRows emptyRows() {
  DeepRows rows;
  rows.window = {0, 0, kWidth, kHeight};
  rows.offsets.assign(1, 0);
  rows.channels.resize(kLayerNames.size());
  return rows;
}

// Surfaces that share a pixel: up to three edges and, but for every eighth pixel, a background that fills the rest.
DeepRows opaquePicture(Random& random) {
  DeepRows rows = emptyRows();
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const std::uint32_t edges = random.below(4);
    for (std::uint32_t k = 0; k < edges; ++k) {
      const float a = random.uniformf();
      add(rows, a * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf()), glm::vec3(a),
          2 + 8 * random.uniformf());
    }
    if (i % 8) add(rows, glm::vec3(random.uniformf(), random.uniformf(), 3 * random.uniformf()), glm::vec3(1), 12);
    rows.offsets.push_back(rows.channels[0].size());
  }
  return rows;
}

DeepRows smoke(Random& random) {
  DeepRows rows = emptyRows();
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const std::uint32_t layers = random.below(6);
    for (std::uint32_t k = 0; k < layers; ++k) {
      const glm::vec3 o(random.uniformf(), random.uniformf() * .9f, random.uniformf() * .5f);
      add(rows, o * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf()), o, 1 + 15 * random.uniformf());
    }
    rows.offsets.push_back(rows.channels[0].size());
  }
  return rows;
}

class DeepPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("deeppicture-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    Random random(61);
    writeDeep(folder + "/opaque.exr", opaquePicture(random));
    writeDeep(folder + "/smoke.exr", smoke(random));
  }
  Ended run(const std::vector<std::string>& arguments, int code = 0) const {
    Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, code) << ended.err;
    return ended;
  }
  double difference(const std::string& a, const std::string& b, const char* channels = "RGBA") const {
    const ExrDocument p = readExr(folder + "/" + a), q = readExr(folder + "/" + b);
    double worst = 0;
    for (const char* c = channels; *c; ++c) {
      const ExrChannel *x = p.parts[0].find(std::string(1, *c)), *y = q.parts[0].find(std::string(1, *c));
      for (std::size_t i = 0; i < kWidth * kHeight; ++i)
        worst = std::max(worst, std::abs(static_cast<double>(x->at(i)) - static_cast<double>(y->at(i))));
    }
    return worst;
  }
  std::string folder;
  RunOptions options;
};

TEST_F(DeepPicture, EverySampleHoldsLayersOutOnItsOwn) {
  run({"flatten", "opaque.exr", "smoke.exr", "-o", "truth.exr"});
  run({"composite", "opaque.exr", "smoke.exr", "-o", "over.exr", "--method", "over"});
  double worst = difference("over.exr", "truth.exr", "RGB");
  // A picture's alpha is the mean of its channels' opacities (MODEL section 1); flatten keeps those apart.
  const ExrDocument ours = readExr(folder + "/over.exr"), theirs = readExr(folder + "/truth.exr");
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    double mean = 0;
    for (const char* channel : {"AR", "AG", "AB"})
      mean += static_cast<double>(theirs.parts[0].find(channel)->at(i)) / 3;
    worst = std::max(worst, std::abs(static_cast<double>(ours.parts[0].find("A")->at(i)) - mean));
  }
  // What one depth a pixel makes of it.
  run({"flatten", "opaque.exr", "-o", "flat.exr"});
  run({"composite", "flat.exr", "smoke.exr", "-o", "plain.exr", "--method", "over"});
  const double plain = difference("plain.exr", "truth.exr", "RGB");
  std::printf("[ figure ] composite onto a deep picture against flatten of both: worst %.3g; onto its flat form %.3g\n",
              worst, plain);
  EXPECT_LE(worst, 2e-6);  // a few roundings to float, values up to 3
  EXPECT_GT(plain, .1);
}

TEST_F(DeepPicture, EveryMethodAndToleranceTakeIt) {
  run({"composite", "opaque.exr", "smoke.exr", "-o", "over.exr", "--method", "over"});
  for (const std::string method : {"phenomenological", "weighted", "front+tail", "wavelet:3", "mlab:8"}) {
    run({"composite", "opaque.exr", "smoke.exr", "-o", "out.exr", "--method", method});
    const double worst = difference("out.exr", "over.exr"), alpha = difference("out.exr", "over.exr", "A");
    std::printf("[ figure ] %s onto a deep picture: worst %.3g, alpha %.3g\n", method.c_str(), worst, alpha);
    EXPECT_LE(alpha, 3e-6) << method;  // transmission is exact by every one of them
    if (method == "mlab:8") {
      EXPECT_LE(worst, 3e-6);
    }
  }
  run({"composite", "opaque.exr", "smoke.exr", "-o", "within.exr", "--tolerance", ".05"});
  EXPECT_LE(difference("within.exr", "over.exr"), .05);
  EXPECT_GT(difference("within.exr", "over.exr"), 1e-4);
}

TEST_F(DeepPicture, GlassRefractsAndDiffusesBetweenItsSamples) {
  nlohmann::json frosted = {{"doubleSided", true},
                            {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.3}}},
                            {"extensions",
                             {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 0.2}}}}}};
  writeGlb(folder + "/pane.glb", {Quad{{-4, -4, -6}, {8, 0, 1}, {0, 8, 0}, frosted}});
  run({"composite", "opaque.exr", "pane.glb", "-o", "over.exr", "--aa", "1", "--method", "over"});
  run({"composite", "opaque.exr", "pane.glb", "-o", "blended.exr", "--aa", "1", "--method", "phenomenological"});
  EXPECT_LE(difference("blended.exr", "over.exr"), 5e-6);  // one layer: nothing to blend
  run({"composite", "opaque.exr", "pane.glb", "-o", "off.exr", "--aa", "1", "--refract", "off", "--diffusion", "off"});
  EXPECT_GT(difference("off.exr", "over.exr"), .1);
}

// They were one layer, before a sample or behind it.
TEST_F(DeepPicture, LayersOfLowResolutionStandBetweenItsSamples) {
  std::vector<Quad> sheets;
  for (int k = 0; k < 4; ++k) {
    const float z = 3.0f + 2.0f * static_cast<float>(k);
    sheets.push_back({{-2 * z, -2 * z, -z}, {4 * z, 0, 0}, {0, 4 * z, 0}, unlit(.9f, .1f * z, .2f, .3f)});
  }
  writeGlb(folder + "/sheets.glb", sheets);
  for (const std::string passes : {"1", "4"}) {
    std::vector<std::string> low{"composite", "opaque.exr", "sheets.glb", "-o", "full.exr", "--aa", passes};
    run(low);
    low[4] = "low.exr";
    for (int k = 0; k < 4; ++k)
      low.insert(low.end(), {"--set", "material_" + std::to_string(k) + ".lowResolution=true"});
    run(low);
    EXPECT_LE(difference("low.exr", "full.exr"), 3e-6) << passes;
  }
}

TEST_F(DeepPicture, WhatCannotTakeItSaysSo) {
  writeGlb(folder + "/pane.glb", {Quad{}});
  EXPECT_NE(run({"accumulate", "opaque.exr", "pane.glb", "-o", "out.exr", "--occlusion", "apart"}, 4)
                .err.find("found it with a deep picture"),
            std::string::npos);
  EXPECT_NE(run({"composite", "opaque.exr", "smoke.exr", "-o", "out.exr", "--depth-kind", "auto"}, 2)
                .err.find("--depth-kind"),
            std::string::npos);
}

// The same samples in tiles of 16 x 16 that the windows do not fill.
void writeTiles(const std::string& path, const DeepRows& rows, bool latLong = false) {
  namespace exr = OPENEXR_IMF_NAMESPACE;
  const int width = rows.window.width(), height = rows.window.height();
  exr::Header header(width, height);
  header.setType(exr::DEEPTILE);
  header.compression() = exr::ZIPS_COMPRESSION;
  if (latLong) exr::addEnvmap(header, exr::ENVMAP_LATLONG);
  header.setTileDescription(exr::TileDescription(20, 16, exr::ONE_LEVEL));
  std::vector<unsigned> counts;
  std::vector<std::vector<const float*>> pointers(rows.channels.size());
  for (std::size_t i = 0; i + 1 < rows.offsets.size(); ++i) {
    counts.push_back(static_cast<unsigned>(rows.offsets[i + 1] - rows.offsets[i]));
    for (std::size_t c = 0; c < pointers.size(); ++c) pointers[c].push_back(rows.channels[c].data() + rows.offsets[i]);
  }
  exr::DeepFrameBuffer frame;
  const auto stride = static_cast<std::size_t>(width);
  frame.insertSampleCountSlice(
      exr::Slice(exr::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), sizeof(unsigned) * stride));
  for (std::size_t c = 0; c < pointers.size(); ++c) {
    header.channels().insert(kLayerNames[c], exr::Channel(exr::FLOAT));
    frame.insert(kLayerNames[c], exr::DeepSlice(exr::FLOAT, reinterpret_cast<char*>(pointers[c].data()), sizeof(char*),
                                                sizeof(char*) * stride, sizeof(float)));
  }
  exr::DeepTiledOutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1);
}

// Its pixels are directions all around: neither a picture nor layers of what a camera sees. Flattened it stays one.
TEST_F(DeepPicture, ALatLongMapIsRefused) {
  Random random(8);
  writeTiles(folder + "/around.exr", smoke(random), true);
  writeGlb(folder + "/pane.glb", {Quad{}});
  for (const std::vector<std::string>& inputs : {std::vector<std::string>{"around.exr", "pane.glb"},
                                                 {"around.exr", "smoke.exr"},
                                                 {"opaque.exr", "around.exr"}}) {
    const Ended ended = run({"composite", inputs[0], inputs[1], "-o", "out.exr"}, 4);
    EXPECT_NE(ended.err.find("around.exr: attribute envmap: found a lat-long map"), std::string::npos) << ended.err;
  }
  EXPECT_NE(run({"inspect", "around.exr"}).out.find("attribute envmap: found a lat-long map"), std::string::npos);
  run({"flatten", "around.exr", "-o", "flat.exr"});
  EXPECT_NE(run({"composite", "flat.exr", "pane.glb", "-o", "out.exr"}, 4).err.find("lat-long map"), std::string::npos);
}

TEST(DeepTiles, HoldTheSameSamples) {
  const std::string folder = freshFolder("deep-tiles");
  Random random(8);
  const DeepRows rows = smoke(random);
  writeTiles(folder + "/tiles.exr", rows);
  for (const std::uint64_t most : {std::uint64_t{1}, std::uint64_t{200}, UINT64_MAX}) {
    DeepReader reader(folder + "/tiles.exr", 0, kLayerNames);
    std::uint64_t samples = 0;
    for (int y = 0; y < kHeight;) {
      const DeepRows band = reader.read(y, kHeight, most);
      ASSERT_GT(band.window.y1, y);
      for (int row = y; row < band.window.y1; ++row)
        for (int x = 0; x < kWidth; ++x) {
          const auto there = static_cast<std::size_t>(row * kWidth + x),
                     here = there - static_cast<std::size_t>(y * kWidth);
          ASSERT_EQ(band.offsets[here + 1] - band.offsets[here], rows.offsets[there + 1] - rows.offsets[there]);
          for (std::uint64_t k = 0; k < band.offsets[here + 1] - band.offsets[here]; ++k)
            for (std::size_t c = 0; c < kLayerNames.size(); ++c)
              ASSERT_EQ(band.channels[c][band.offsets[here] + k], rows.channels[c][rows.offsets[there] + k]);
        }
      samples += band.offsets.back();
      y = band.window.y1;
    }
    EXPECT_EQ(samples, rows.offsets.back());
  }
  RunOptions options;
  options.folder = folder;
  EXPECT_EQ(runProgram({"flatten", "tiles.exr", "-o", "flat.exr"}, options).code, 0);
  // Cut short: refused, nothing written.
  std::filesystem::resize_file(folder + "/tiles.exr", std::filesystem::file_size(folder + "/tiles.exr") / 2);
  EXPECT_EQ(runProgram({"flatten", "tiles.exr", "-o", "none.exr"}, options).code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder + "/none.exr"));
}

}  // namespace
}  // namespace pellucid
