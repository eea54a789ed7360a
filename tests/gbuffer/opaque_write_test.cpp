// Only touched pixels of the beauty change; everything else leaves bit for bit as it came.
#include <Imath/half.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "exr_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::test {
namespace {

template <class T>
T bitsAt(const std::vector<std::byte>& bytes, std::size_t i) {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
  return value;
}

// Noise in every channel: NaN payloads, infinities and denormals among it.
Part noisy(const Window& display, const Window& data, exr::PixelType type, int tileSize, unsigned seed) {
  Part part;
  part.display = display;
  part.data = data;
  part.tileSize = tileSize;
  part.strings["owner"] = "somebody";
  const std::size_t pixels = pixelsOf(data);
  for (const char* name : {"R", "G", "B", "A", "Z", "crypto.r"})
    part.planes.push_back(noisePlane(name, type, pixels, seed++));
  part.planes.push_back(noisePlane("id", exr::UINT, pixels, seed++));
  return part;
}

class UntouchedPixels : public testing::TestWithParam<std::tuple<exr::PixelType, int, exr::Compression>> {};

TEST_P(UntouchedPixels, KeepEveryBit) {
  const auto [type, tileSize, compression] = GetParam();
  TemporaryFolder folder;
  for (const bool multiPart : {false, true}) {
    Part beauty = noisy({0, 0, 30, 20}, {-5, -7, 36, 25}, type, tileSize, 3);
    Part second = noisy({0, 0, 30, 20}, {2, 2, 9, 9}, type, 0, 50);
    beauty.compression = compression;
    for (Plane& plane : second.planes) plane.name = "data." + plane.name;
    if (multiPart) {
      beauty.name = "rgba";
      second.name = "second";
    }
    writeFile(folder.path("in.exr"), multiPart ? std::vector<Part>{beauty, second} : std::vector<Part>{beauty});
    const Contents before = readFile(folder.path("in.exr"));
    const OpaqueFile file = readOpaque(folder.path("in.exr"), {});

    Image<glm::vec4> picture(41, 32, glm::vec4(0.1f, 0.7f, 3.0f, 0.5f));
    Image<std::uint8_t> touched(41, 32, 0);
    for (std::size_t i = 0; i < touched.size(); i += 3) touched[i] = 1;
    writePicture(folder.path("out.exr"), file, picture, touched, {}, {{"pellucid:version", "1"}});
    Contents after = readFile(folder.path("out.exr"));

    for (const auto& [name, bytes] : before.planes) {
      const bool isBeauty = name == "0/R" || name == "0/G" || name == "0/B" || name == "0/A";
      if (!isBeauty) {
        EXPECT_TRUE(after.planes.at(name) == bytes) << name;
        continue;
      }
      const glm::vec4& colour = picture[0];
      const float expected = name == "0/R" ? colour.r : name == "0/G" ? colour.g : name == "0/B" ? colour.b : colour.a;
      for (std::size_t i = 0; i < touched.size(); ++i) {
        if (type == exr::HALF)
          ASSERT_EQ(bitsAt<std::uint16_t>(after.planes.at(name), i),
                    touched[i] ? imath_float_to_half(expected) : bitsAt<std::uint16_t>(bytes, i));
        else
          ASSERT_EQ(bitsAt<std::uint32_t>(after.planes.at(name), i),
                    touched[i] ? std::bit_cast<std::uint32_t>(expected) : bitsAt<std::uint32_t>(bytes, i));
      }
    }
    EXPECT_EQ(after.planes.size(), before.planes.size());
    EXPECT_EQ(after.attributes.at("0/pellucid:version"), "string:1");
    after.attributes.erase("0/pellucid:version");
    EXPECT_EQ(after.attributes, before.attributes);
  }
}

INSTANTIATE_TEST_SUITE_P(Storage, UntouchedPixels,
                         testing::Combine(testing::Values(exr::HALF, exr::FLOAT), testing::Values(0, 16),
                                          testing::Values(exr::NO_COMPRESSION, exr::RLE_COMPRESSION,
                                                          exr::ZIPS_COMPRESSION, exr::ZIP_COMPRESSION,
                                                          exr::PIZ_COMPRESSION)));

class OpaqueWrite : public testing::Test {
 protected:
  Part plain(exr::PixelType type, bool alpha) {
    Part part;
    for (const char* name : {"R", "G", "B", "Z"}) part.planes.push_back(constantPlane(name, type, 0.5f, 48));
    if (alpha) part.planes.push_back(constantPlane("A", type, 1.0f, 48));
    return part;
  }
  OpaqueFile read(const Part& part) {
    writeFile(folder_.path("in.exr"), {part});
    return readOpaque(folder_.path("in.exr"), {});
  }
  TemporaryFolder folder_;
  Image<std::uint8_t> all_{8, 6, 1};
};

TEST_F(OpaqueWrite, HalfRoundsToNearestAndStaysFinite) {
  const OpaqueFile file = read(plain(exr::HALF, false));
  Image<glm::vec4> picture(8, 6, glm::vec4(0.0f, 0.0f, 0.0f, 0.25f));
  picture[0] = {1.0f + 0x1p-11f, 1.0f + 3 * 0x1p-11f, 65519.0f, 0};  // two ties to even, and beyond the range
  picture[1] = {1e30f, -7e4f, 65504.0f, 0};
  picture[2] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 6e-8f, 0};
  const auto notes = writePicture(folder_.path("out.exr"), file, picture, all_);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("3 values beyond 65504"), std::string::npos) << notes[0];
  const Contents out = readFile(folder_.path("out.exr"));
  const auto value = [&](const char* name, std::size_t i) {
    return imath_half_to_float(bitsAt<std::uint16_t>(out.planes.at(name), i));
  };
  EXPECT_EQ(value("0/R", 0), 1.0f);
  EXPECT_EQ(value("0/G", 0), 1.0f + 0x1p-9f);
  EXPECT_EQ(value("0/B", 0), 65504.0f);
  EXPECT_EQ(value("0/R", 1), 65504.0f);
  EXPECT_EQ(value("0/G", 1), -65504.0f);
  EXPECT_EQ(value("0/B", 1), 65504.0f);
  EXPECT_TRUE(std::isinf(value("0/R", 2))) << "what came in infinite leaves so";
  EXPECT_TRUE(std::isnan(value("0/G", 2)));
  EXPECT_EQ(value("0/B", 2), 0x1p-24f) << "denormal halves are kept";
  EXPECT_FALSE(out.planes.contains("0/A")) << "no alpha in, no alpha out";
}

TEST_F(OpaqueWrite, NothingTouchedIsTheSameFile) {
  Part part = plain(exr::HALF, true);
  part.compression = exr::B44_COMPRESSION;
  const OpaqueFile file = read(part);
  const Image<glm::vec4> picture(8, 6, glm::vec4(9.0f));
  EXPECT_TRUE(writePicture(folder_.path("out.exr"), file, picture, Image<std::uint8_t>(8, 6, 0)).empty());
  EXPECT_EQ(slurp(folder_.path("out.exr")), slurp(folder_.path("in.exr")));
  EXPECT_EQ(writePicture(folder_.path("out.exr"), file, picture, all_).size(), 1u) << "b44 became zip";
}

TEST_F(OpaqueWrite, LayersStandBesideThePicture) {
  const OpaqueFile file = read(plain(exr::HALF, true));
  const Image<glm::vec4> picture(8, 6, glm::vec4(0.25f));
  ExtraLayer layer{"transparent", {{"R", Image<float>(8, 6, 0.1f)}, {"Z", Image<float>(8, 6, 7.0f)}}};
  writePicture(folder_.path("out.exr"), file, picture, all_, {layer, {"occlusion", {{"", Image<float>(8, 6, 0.5f)}}}});
  const Contents out = readFile(folder_.path("out.exr"));
  EXPECT_EQ(bitsAt<float>(out.planes.at("0/transparent.R"), 5), 0.1f) << "float, also beside half";
  EXPECT_EQ(bitsAt<float>(out.planes.at("0/occlusion"), 5), 0.5f);
  EXPECT_EQ(imath_half_to_float(bitsAt<std::uint16_t>(out.planes.at("0/A"), 0)), 0.25f);
  const OpaqueFile again = readOpaque(folder_.path("out.exr"), {});
  EXPECT_THROW(writePicture(folder_.path("two.exr"), again, picture, all_, {layer}), MeaningError)
      << "a layer of that name is there already";
}

TEST_F(OpaqueWrite, NewFilesHoldLayersAndCamera) {
  Camera camera;
  camera.focal = {1.5, 2.0};
  camera.viewFromWorld[3] = glm::dvec4(1, 2, -3, 1);
  ExtraLayer colour{"",
                    {{"R", Image<float>(4, 3, 1.5f)},
                     {"G", Image<float>(4, 3, 1e9f)},
                     {"B", Image<float>(4, 3, 0.0f)},
                     {"Z", Image<float>(4, 3, 2.0f)}}};
  const Window display{0, 0, 10, 10}, data{-1, 5, 3, 8};
  EXPECT_TRUE(
      writeLayers(folder_.path("float.exr"), display, data, {colour}, {{"pellucid:made", "x"}}, &camera).empty());
  EXPECT_EQ(writeLayers(folder_.path("half.exr"), display, data, {colour}, {}, nullptr, true).size(), 1u);
  const OpaqueFile file = readOpaque(folder_.path("float.exr"), {});
  EXPECT_EQ(file.gbuffer.data, data);
  EXPECT_EQ(file.gbuffer.display, display);
  EXPECT_EQ(file.gbuffer.beauty.at(3, 2).g, 1e9f);
  ASSERT_TRUE(file.gbuffer.camera.has_value());
  EXPECT_NEAR(file.gbuffer.camera->viewFromWorld[3].y, 2.0, 1e-6);
  EXPECT_EQ(file.document.parts[0].text("pellucid:made"), "x");
  EXPECT_EQ(readOpaque(folder_.path("half.exr"), {}).gbuffer.beauty.at(0, 0).g, 65504.0f);
}

}  // namespace
}  // namespace pellucid::test
