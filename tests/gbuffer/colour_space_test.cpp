// Linear colour spaces by their primaries, as files state them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"
#include "room.h"

namespace pellucid::test {
namespace {

void expectNear(const glm::vec3& found, const glm::vec3& expected, float slack, const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], slack) << what << ", channel " << c;
}

const ColourSpace spaceNamed(const std::string& name) {
  return *spaceOf(namedSpace(name)->chromaticities);
}

TEST(ColourSpace, RedIsWhereOthersPutIt) {
  // As published with each space: columns of the matrices with Bradford's adaptation.
  expectNear(converted(spaceNamed("ACEScg").fromRec709, {1, 0, 0}), {.613097f, .070194f, .020616f}, 2e-6f, "ACEScg");
  expectNear(converted(spaceNamed("ACES2065-1").fromRec709, {1, 0, 0}), {.439632f, .089776f, .017541f}, 3e-6f, "AP0");
  expectNear(converted(spaceNamed("Linear Rec.2020").fromRec709, {1, 0, 0}), {.627404f, .069097f, .016391f}, 2e-6f,
             "Rec.2020");
  expectNear(converted(spaceNamed("Linear P3-D65").fromRec709, {1, 0, 0}), {.822462f, .033194f, .017083f}, 2e-6f, "P3");
}

TEST(ColourSpace, Rec709IsTheIdentityToTheBit) {
  EXPECT_TRUE(spaceOf(Chromaticities{})->isRec709());
  // As floats of four digits, and as a program that rounds the white otherwise.
  EXPECT_TRUE(spaceOf({{.64f, .33f}, {.3f, .6f}, {.15f, .06f}, {.3127f, .329f}})->isRec709());
  EXPECT_TRUE(spaceOf({{.64, .33}, {.3, .6}, {.15, .06}, {.31272, .32903}})->isRec709());
  EXPECT_FALSE(spaceOf({{.64, .33}, {.3, .6}, {.15, .06}, {.31, .33}})->isRec709());
  EXPECT_TRUE(ColourSpace().isRec709());
}

TEST(ColourSpace, GreysKeepTheirBits) {
  for (const NamedSpace& row : namedSpaces())
    for (const float grey : {0.0f, 1e-30f, 0.1f, 0.3333333f, 1.0f, 12345.678f})
      EXPECT_EQ(converted(spaceOf(row.chromaticities)->fromRec709, glm::vec3(grey)), glm::vec3(grey)) << row.name;
}

TEST(ColourSpace, WideSpacesHoldColoursOfRec709) {
  for (const NamedSpace& row : namedSpaces())
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 corner(i & 1, i >> 1 & 1, i >> 2 & 1);
      const glm::vec3 there = converted(spaceOf(row.chromaticities)->fromRec709, corner);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(there[c] >= 0.0f && there[c] <= 1.0f) << row.name << " " << there[c];
    }
}

TEST(ColourSpace, NamesAndAliases) {
  EXPECT_EQ(namedSpace("acescg"), namedSpace("ACEScg"));
  EXPECT_EQ(namedSpace("lin_rec709")->name, std::string("Linear Rec.709 (sRGB)"));
  EXPECT_EQ(namedSpace("ACES - ACES2065-1")->name, std::string("ACES2065-1"));
  EXPECT_EQ(namedSpace("sepia"), nullptr);
  for (const NamedSpace& row : namedSpaces()) EXPECT_NE(spacesHelp().find(row.name), std::string::npos);
}

TEST(ColourSpace, ByAMatrixAlone) {
  const ColourSpace aces = spaceNamed("ACEScg");
  const ColourSpace again = spaceBy("mine", aces.fromRec709);
  EXPECT_TRUE(sameSpace(aces, again));
  EXPECT_TRUE(sameSpace(aces, *spaceOf(again.chromaticities))) << "its chromaticities say the same";
  EXPECT_NEAR(again.chromaticities.white.x, .3127, 1e-9);
  EXPECT_FALSE(sameSpace(aces, ColourSpace()));
}

ExrDocument with(const std::vector<float>& chromaticities) {
  TemporaryFolder folder;
  NewExr file;
  file.display = file.data = {0, 0, 2, 2};
  file.channels = {{"R", PixelType::float32, std::vector<std::byte>(16)}};
  file.chromaticities = chromaticities;
  writeNewExr(folder.path("a.exr"), file);
  return readExr(folder.path("a.exr"));
}

TEST(ColourSpace, WhatAFileStates) {
  std::vector<std::string> notes;
  const ColourSpace aces = statedSpace(with(numbersOf(namedSpace("ACEScg")->chromaticities)).parts[0], "", notes);
  EXPECT_EQ(aces.name, "ACEScg");
  EXPECT_EQ(aces.source, SpaceSource::chromaticities);
  EXPECT_EQ(spaceText(aces), "ACEScg by chromaticities");
  const ColourSpace none = statedSpace(with({}).parts[0], "", notes);
  EXPECT_TRUE(none.isRec709());
  EXPECT_EQ(none.source, SpaceSource::nothing);
  EXPECT_NE(spaceText(none).find("as nothing says otherwise"), std::string::npos);
  EXPECT_EQ(statedSpace(with({}).parts[0], "ACES2065-1", notes).source, SpaceSource::preset);
  // XYZ itself, whose primaries have no light.
  EXPECT_EQ(statedSpace(with({1, 0, 0, 1, 0, 0, 1.f / 3, 1.f / 3}).parts[0], "", notes).source,
            SpaceSource::chromaticities);
  EXPECT_TRUE(notes.empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::vector<float>& bad : std::vector<std::vector<float>>{{0, 0, 0, 0, 0, 0, 0, 0},
                                                                       {.3f, .3f, .3f, .3f, .3f, .3f, .3f, .3f},
                                                                       {.64f, .33f, .3f, .6f, .15f, .06f, .3f, 0},
                                                                       {nan, .33f, .3f, .6f, .15f, .06f, .3f, .3f}}) {
    notes.clear();
    EXPECT_EQ(statedSpace(with(bad).parts[0], "", notes).source, SpaceSource::nothing);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("which span no colours"), std::string::npos) << notes[0];
  }
}

TEST(ColourSpace, AsAttributesOfPlanes) {
  TemporaryFolder folder;
  NewExr file;
  file.display = file.data = {0, 0, 2, 2};
  file.channels = {{"R", PixelType::float32, std::vector<std::byte>(16)}};
  const auto again = [&] {
    writeNewExr(folder.path("a.exr"), file);
    return readSpace(readExr(folder.path("a.exr")).parts[0], "a.exr");
  };
  EXPECT_TRUE(again().isRec709()) << "files of before have none";
  ColourSpace space = spaceNamed("ACES2065-1");
  space.source = SpaceSource::fileRule;
  putSpace(space, file.attributes);
  EXPECT_EQ(again().fromRec709, space.fromRec709);
  EXPECT_EQ(again().name, "ACES2065-1");
  EXPECT_EQ(again().source, SpaceSource::fileRule);
  file.attributes["pellucid:workingSpaceFromRec709"] = "1 0 0 0 1";
  EXPECT_THROW(again(), MeaningError);
}

}  // namespace
}  // namespace pellucid::test
