// Cryptomatte as renderers write it: which names are found, what pixels show, and when it tells nothing.
#include <gtest/gtest.h>

#include <bit>

#include "gbuffer/object_coverage.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kPost = 0x3f123456u, kWall = 0xbe987654u, kLeaf = 0x00001234u;  // the last is a denormal
constexpr Window kAll{0, 0, 4, 1};

Image<float> rowOf(std::initializer_list<float> values) {
  Image<float> row(4, 1);
  std::size_t i = 0;
  for (const float value : values) row[i++] = value;
  return row;
}

float asFloat(std::uint32_t id) {
  return std::bit_cast<float>(id);
}

// Post alone, post and wall, all three with a part of nothing, nothing alone.
ExtraLayer rank(const std::string& name, int number, const char* letters) {
  ExtraLayer layer{name + (number == 0 ? "00" : "01"), {}};
  const auto put = [&](std::size_t c, std::initializer_list<float> values) {
    layer.channels.emplace_back(std::string(1, letters[c]), rowOf(values));
  };
  if (number == 0) {
    put(0, {asFloat(kPost), asFloat(kPost), asFloat(kWall), 0.0f});
    put(1, {1.0f, 0.75f, 0.5f, 0.0f});
    put(2, {0.0f, asFloat(kWall), asFloat(kPost), 0.0f});
    put(3, {0.0f, 0.25f, 0.25f, 0.0f});
  } else {
    put(0, {0.0f, 0.0f, asFloat(kLeaf), 0.0f});
    put(1, {0.0f, 0.0f, 0.125f, 0.0f});
    put(2, {0.0f, 0.0f, 0.0f, 0.0f});
    put(3, {0.0f, 0.0f, 0.0f, 0.0f});
  }
  return layer;
}

ExtraLayer picture() {
  const Image<float> one(4, 1, 1.0f);
  return {"", {{"R", one}, {"G", one}, {"B", one}, {"A", one}, {"Z", one}}};
}

OpaqueFile readBack(const std::vector<ExtraLayer>& layers, const std::map<std::string, std::string>& attributes,
                    bool half = false) {
  const std::string path = test::freshFolder("object-coverage") + "/p.exr";
  writeLayers(path, kAll, kAll, layers, attributes, nullptr, half);
  return readOpaque(path, {});
}

TEST(ObjectCoverage, TellsWhatAPixelShows) {
  for (const char* letters : {"rgba", "RGBA"}) {
    const OpaqueFile file =
        readBack({picture(), rank("ViewLayer.CryptoObject", 0, letters), rank("ViewLayer.CryptoObject", 1, letters)},
                 {{"cryptomatte/542cafa/name", "ViewLayer.CryptoObject"}});
    ASSERT_TRUE(file.gbuffer.objects);
    const ObjectCoverage& objects = *file.gbuffer.objects;
    EXPECT_EQ(objects.layer(), "ViewLayer.CryptoObject");
    EXPECT_EQ(objects.mostOf(0, 0), kPost);
    EXPECT_EQ(objects.mostOf(1, 0), kPost);
    EXPECT_EQ(objects.mostOf(2, 0), kWall);
    EXPECT_EQ(objects.mostOf(3, 0), kNoObject);
    EXPECT_EQ(objects.coverage(0, 0, {kPost}), 1.0);
    EXPECT_EQ(objects.coverage(0, 0, {kWall, kNoObject}), 0.0);
    EXPECT_EQ(objects.coverage(1, 0, {kPost}), 0.75);
    EXPECT_EQ(objects.coverage(1, 0, {kPost, kWall}), 1.0);
    EXPECT_EQ(objects.coverage(2, 0, {kLeaf}), 0.125);
    EXPECT_EQ(objects.coverage(2, 0, {kNoObject}), 0.125) << "what nothing covers";
    EXPECT_EQ(objects.coverage(3, 0, {kNoObject}), 1.0);
    bool said = false;
    for (const std::string& line : understoodLines(file))
      said = said || line.find("Cryptomatte ViewLayer.CryptoObject") != std::string::npos;
    EXPECT_TRUE(said);
  }
}

TEST(ObjectCoverage, ObjectsWinOverMaterials) {
  const std::map<std::string, std::string> both = {{"cryptomatte/1111111/name", "crypto_material"},
                                                   {"cryptomatte/2222222/name", "crypto_object"}};
  const OpaqueFile file =
      readBack({picture(), rank("crypto_material", 0, "RGBA"), rank("crypto_object", 0, "RGBA")}, both);
  ASSERT_TRUE(file.gbuffer.objects);
  EXPECT_EQ(file.gbuffer.objects->layer(), "crypto_object");
  const OpaqueFile other = readBack({picture(), rank("crypto_material", 0, "RGBA")}, both);
  ASSERT_TRUE(other.gbuffer.objects);
  EXPECT_EQ(other.gbuffer.objects->layer(), "crypto_material") << "the other's channels are not there";
}

TEST(ObjectCoverage, TellsNothingWhereThereIsNone) {
  const std::map<std::string, std::string> named = {{"cryptomatte/1/name", "crypto_object"}};
  EXPECT_FALSE(readBack({picture()}, named).gbuffer.objects) << "channels that are not there";
  EXPECT_FALSE(readBack({picture(), rank("crypto_object", 0, "RGBA")}, {}).gbuffer.objects) << "no header";
  EXPECT_FALSE(readBack({picture(), rank("crypto_object", 0, "RGBA")}, named, true).gbuffer.objects) << "halves";
  ExtraLayer centres = rank("crypto_object", 0, "RGBA");
  centres.channels[1].second = rowOf({1.0f, 1.0f, 1.0f, 0.0f});
  centres.channels[3].second = rowOf({0.0f, 0.0f, 0.0f, 0.0f});
  EXPECT_FALSE(readBack({picture(), centres}, named).gbuffer.objects) << "of pixels' centres";
}

}  // namespace
}  // namespace pellucid
