// Frames and names of files as they are written on the command line.
#include <gtest/gtest.h>

#include <fstream>

#include "composite/sequence/digest.h"
#include "composite/sequence/frame_pattern.h"
#include "composite/sequence/frame_range.h"
#include "gbuffer/errors.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using Frames = std::vector<int>;

TEST(Frames, RangesStepsAndLists) {
  const auto frames = [](const char* text) { return parseFrames(text, "--frames").frames; };
  EXPECT_EQ(frames("1001"), Frames{1001});
  EXPECT_EQ(frames("1001-1004"), (Frames{1001, 1002, 1003, 1004}));
  EXPECT_EQ(frames("1001-1006x2,1200"), (Frames{1001, 1003, 1005, 1200}));
  EXPECT_EQ(frames("1004-1001"), (Frames{1004, 1003, 1002, 1001})) << "downwards";
  EXPECT_EQ(frames("10-1x4"), (Frames{10, 6, 2}));
  EXPECT_EQ(frames("-2-1"), (Frames{-2, -1, 0, 1}));
  EXPECT_EQ(frames("-1--3"), (Frames{-1, -2, -3}));
  EXPECT_EQ(frames("7,3,7,3-4"), (Frames{7, 3, 4})) << "each once, where it first stands";
}

TEST(Frames, DuplicatesAreTold) {
  EXPECT_TRUE(parseFrames("1-3", "--frames").duplicates.empty());
  EXPECT_EQ(parseFrames("7,3,7,3-4,7", "--frames").duplicates, (Frames{7, 3}));
}

TEST(Frames, WhatIsNoFrameIsRefused) {
  for (const char* text : {"", "a", "1-", "-", "1x2-3", "1-5x0", "1-5x-1", "1,,2", "1-2 ", "1.5", "99999999999", "1,",
                           "0-1000000", "2000000"})
    EXPECT_THROW(parseFrames(text, "--frames"), UsageError) << text;
}

TEST(Frames, TextForPeople) {
  EXPECT_EQ(framesText({}), "");
  EXPECT_EQ(framesText({1001, 1002, 1003, 1004}), "1001-1004");
  EXPECT_EQ(framesText({1, 2, 5, 9, 8}), "1, 2, 5, 9, 8");
}

TEST(FramePatterns, EverySpelling) {
  const auto at = [](const char* text, int frame) { return FramePattern(text).at(frame); };
  EXPECT_EQ(at("shot.####.exr", 7), "shot.0007.exr");
  EXPECT_EQ(at("shot.##.exr", 1001), "shot.1001.exr") << "more digits than places";
  EXPECT_EQ(at("shot.#.exr", 7), "shot.0007.exr") << "one stands for four";
  EXPECT_EQ(at("shot.@@@.exr", 7), "shot.007.exr");
  EXPECT_EQ(at("shot.@.exr", 7), "shot.7.exr");
  EXPECT_EQ(at("shot.%04d.exr", 7), "shot.0007.exr");
  EXPECT_EQ(at("shot.%d.exr", 7), "shot.7.exr");
  EXPECT_EQ(at("shot.$F4.exr", 7), "shot.0007.exr");
  EXPECT_EQ(at("shot.$F.exr", 7), "shot.7.exr");
  EXPECT_EQ(at("####/shot.####.exr", 12), "0012/shot.0012.exr") << "every place";
  EXPECT_EQ(at("shot.%04d.exr", -5), "shot.-005.exr") << "as printf has it";
}

TEST(FramePatterns, WhatIsNone) {
  for (const char* text : {"shot.exr", "50%.exr", "%4d.exr", "%x.exr", "%00d.exr", "$Frame12.exr", "%0d.exr", "$f.exr"})
    EXPECT_FALSE(FramePattern(text).any()) << text;
  EXPECT_FALSE(FramePattern("me@home.exr").unmistakable()) << "an @ stands in names too";
  EXPECT_TRUE(FramePattern("shot.####.exr").unmistakable());
}

TEST(FramePatterns, FramesOnDisk) {
  const std::string folder = test::freshFolder("patterns");
  for (const char* name : {"a.1001.exr", "a.1003.exr", "a.0999.exr", "a.999.exr", "a.12.exr", "a.1002.exrx",
                           "b.1005.exr", "a.10040.exr", "a.x.exr"})
    std::ofstream(folder + "/" + name) << "x";
  EXPECT_EQ(FramePattern(folder + "/a.####.exr").onDisk(), (Frames{999, 1001, 1003, 10040}));
  EXPECT_EQ(FramePattern(folder + "/a.%d.exr").onDisk(), (Frames{12, 999, 1001, 1003, 10040}));
  EXPECT_TRUE(FramePattern(folder + "/none.####.exr").onDisk().empty());
  EXPECT_TRUE(FramePattern(folder + "/nothing/a.####.exr").onDisk().empty());
}

// printf counts the minus among the digits, Blender does not.
TEST(FramePatterns, NegativeFramesAreFoundByBothNames) {
  const std::string folder = test::freshFolder("negative-patterns");
  for (const char* name : {"a.-0002.exr", "a.-001.exr", "a.0000.exr", "b.-003.exr", "b.-0003.exr"})
    std::ofstream(folder + "/" + name) << "x";
  EXPECT_EQ(FramePattern(folder + "/a.####.exr").onDisk(), (Frames{-2, -1, 0}));
  EXPECT_EQ(FramePattern(folder + "/a.%04d.exr").onDisk(), (Frames{-2, -1, 0}));
  const auto fileOf = [](const std::string& value) { return value.substr(0, value.find(".exr") + 4); };
  const auto input = [&](const char* text, int frame) { return FramePattern(folder + text).inputAt(frame, fileOf); };
  EXPECT_EQ(input("/a.####.exr:Z", -2), folder + "/a.-0002.exr:Z");
  EXPECT_EQ(input("/a.####.exr", -1), folder + "/a.-001.exr");
  EXPECT_EQ(input("/a.####.exr", -7), folder + "/a.-007.exr") << "neither is there";
  EXPECT_EQ(input("/b.####.exr", -3), folder + "/b.-003.exr") << "both are there";
}

TEST(FramePatterns, AFileOfJustThisNameIsNoPattern) {
  const std::string folder = test::freshFolder("literal");
  EXPECT_TRUE(inputPattern(folder + "/glass@2x.glb").any());
  std::ofstream(folder + "/glass@2x.glb") << "x";
  EXPECT_FALSE(inputPattern(folder + "/glass@2x.glb").any());
}

TEST(Digests, TellTextsAndTheirBoundsApart) {
  const auto of = [](std::vector<std::string> texts) {
    Digest digest;
    for (const std::string& text : texts) digest.add(text);
    return digest.text();
  };
  EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
  EXPECT_NE(of({"ab", "c"}), of({"a", "bc"}));
  EXPECT_NE(of({"ab", "c"}), of({"c", "ab"}));
  EXPECT_NE(of({""}), of({}));
  EXPECT_EQ(of({"x"}).size(), 32u);
}

TEST(Digests, AFileIsReadAgainWhenItChanges) {
  const std::string path = test::freshFolder("digest") + "/a.bin";
  std::string bytes(3000000, 'a');
  std::ofstream(path) << bytes;
  FileDigests files;
  const std::string first = files.of(path);
  EXPECT_EQ(files.of(path), first);
  bytes.back() = 'b';
  std::ofstream(path) << bytes;
  EXPECT_NE(files.of(path), first);
  EXPECT_THROW(files.of(path + ".not"), InputError);
}

}  // namespace
}  // namespace pellucid
