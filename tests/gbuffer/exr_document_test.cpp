// Files come back as they were: every channel, window and attribute, whatever the storage.
#include "gbuffer/exr_document.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <tuple>

#include "exr_files.h"
#include "gbuffer/errors.h"

namespace pellucid::test {
namespace {

// Windows: plain, overscan with a negative origin, a crop, and data outside the display altogether.
const std::pair<Window, Window> kWindows[] = {
    {{0, 0, 37, 29}, {0, 0, 37, 29}},
    {{0, 0, 30, 20}, {-5, -7, 41, 33}},
    {{0, 0, 64, 64}, {11, 13, 48, 42}},
    {{400, -100, 440, -60}, {0, 0, 37, 29}},
};

Part mixedPart(const std::pair<Window, Window>& windows, exr::Compression compression, int tileSize, unsigned seed) {
  Part part;
  part.display = windows.first;
  part.data = windows.second;
  part.compression = compression;
  part.tileSize = tileSize;
  part.strings = {{"owner", "somebody"}, {"a name that is longer than thirty-one letters", "x"}, {"empty", ""}};
  const std::size_t pixels = pixelsOf(part.data);
  part.planes = {noisePlane("A", exr::HALF, pixels, seed), noisePlane("Layer.Z", exr::FLOAT, pixels, seed + 1),
                 noisePlane("id", exr::UINT, pixels, seed + 2), noisePlane("R", exr::HALF, pixels, seed + 3)};
  return part;
}

void expectSame(const Contents& found, const Contents& expected) {
  EXPECT_EQ(found.attributes, expected.attributes);
  ASSERT_EQ(found.planes.size(), expected.planes.size());
  for (const auto& [name, bytes] : expected.planes) {
    ASSERT_TRUE(found.planes.contains(name)) << name;
    EXPECT_TRUE(found.planes.at(name) == bytes) << name << " differs";
  }
}

// An edit that changes nothing but makes every part be coded again.
std::map<int, ExrPartEdit> codeAgain(const ExrDocument& document) {
  std::map<int, ExrPartEdit> edits;
  for (std::size_t i = 0; i < document.parts.size(); ++i)
    if (!document.parts[i].deep)
      edits[static_cast<int>(i)].replaced[document.parts[i].channels[0].name] = document.parts[i].channels[0].bytes;
  return edits;
}

using Storage = std::tuple<exr::Compression, int, int>;  // compression, tile size, window

class Lossless : public testing::TestWithParam<Storage> {};

TEST_P(Lossless, CopiedAndCodedAgainKeepEveryBit) {
  const auto [compression, tileSize, window] = GetParam();
  TemporaryFolder folder;
  const Part part = mixedPart(kWindows[window], compression, tileSize, 7);
  writeFile(folder.path("in.exr"), {part});
  const Contents expected = readFile(folder.path("in.exr"));
  for (const Plane& plane : part.planes) ASSERT_TRUE(expected.planes.at("0/" + plane.name) == plane.bytes);

  const ExrDocument document = readExr(folder.path("in.exr"));
  ASSERT_EQ(document.parts.size(), 1u);
  EXPECT_EQ(document.parts[0].data, part.data);
  EXPECT_EQ(document.parts[0].display, part.display);
  for (const Plane& plane : part.planes) EXPECT_TRUE(document.parts[0].find(plane.name)->bytes == plane.bytes);
  EXPECT_EQ(document.parts[0].find("id")->type, PixelType::uint32);

  EXPECT_TRUE(writeExr(folder.path("copied.exr"), document).empty());
  expectSame(readFile(folder.path("copied.exr")), expected);
  EXPECT_TRUE(writeExr(folder.path("coded.exr"), document, codeAgain(document)).empty());
  expectSame(readFile(folder.path("coded.exr")), expected);
}

INSTANTIATE_TEST_SUITE_P(Storage, Lossless,
                         testing::Combine(testing::Values(exr::NO_COMPRESSION, exr::RLE_COMPRESSION,
                                                          exr::ZIPS_COMPRESSION, exr::ZIP_COMPRESSION,
                                                          exr::PIZ_COMPRESSION),
                                          testing::Values(0, 16, 64), testing::Range(0, 4)));

TEST(ExrDocument, MultiPartKeepsEveryPart) {
  TemporaryFolder folder;
  std::vector<Part> parts;
  for (unsigned i = 0; i < 4; ++i) {
    parts.push_back(mixedPart({kWindows[0].first, kWindows[i].second}, exr::ZIP_COMPRESSION, i == 2 ? 16 : 0, 11 * i));
    parts.back().name = "part" + std::to_string(i);
  }
  writeFile(folder.path("in.exr"), parts);
  const Contents expected = readFile(folder.path("in.exr"));
  const ExrDocument document = readExr(folder.path("in.exr"));
  ASSERT_EQ(document.parts.size(), 4u);
  EXPECT_TRUE(document.multiPart);
  EXPECT_EQ(document.parts[2].name, "part2");
  writeExr(folder.path("copied.exr"), document);
  expectSame(readFile(folder.path("copied.exr")), expected);
  writeExr(folder.path("coded.exr"), document, codeAgain(document));
  expectSame(readFile(folder.path("coded.exr")), expected);
}

TEST(ExrDocument, DecreasingLinesStayDecreasing) {
  TemporaryFolder folder;
  Part part = mixedPart(kWindows[1], exr::ZIP_COMPRESSION, 0, 3);
  part.lineOrder = exr::DECREASING_Y;
  writeFile(folder.path("in.exr"), {part});
  const ExrDocument document = readExr(folder.path("in.exr"));
  writeExr(folder.path("coded.exr"), document, codeAgain(document));
  expectSame(readFile(folder.path("coded.exr")), readFile(folder.path("in.exr")));
}

class Lossy : public testing::TestWithParam<exr::Compression> {};

TEST_P(Lossy, BecomesZipOnlyWhenPixelsChange) {
  TemporaryFolder folder;
  Part part = mixedPart(kWindows[0], GetParam(), 0, 5);
  part.planes = {halfPlane("R", std::vector<float>(pixelsOf(part.data), 0.3f)),
                 noisePlane("id", exr::UINT, pixelsOf(part.data), 1)};
  for (std::size_t i = 0; i < part.planes[0].bytes.size(); i += 2)
    part.planes[0].bytes[i] = static_cast<std::byte>(i * 37);
  writeFile(folder.path("in.exr"), {part});
  const Contents before = readFile(folder.path("in.exr"));
  const ExrDocument document = readExr(folder.path("in.exr"));

  writeExr(folder.path("copied.exr"), document);
  EXPECT_EQ(slurp(folder.path("copied.exr")), slurp(folder.path("in.exr")));

  const auto notes = writeExr(folder.path("coded.exr"), document, codeAgain(document));
  const Contents after = readFile(folder.path("coded.exr"));
  EXPECT_TRUE(after.planes == before.planes) << "coding again changed pixels";
  const bool lossless = GetParam() == exr::PXR24_COMPRESSION;  // of half and uint
  EXPECT_EQ(notes.size(), lossless ? 0u : 1u);
  EXPECT_EQ(after.attributes.at("0/compression") == before.attributes.at("0/compression"), lossless);
}

INSTANTIATE_TEST_SUITE_P(Compressions, Lossy,
                         testing::Values(exr::PXR24_COMPRESSION, exr::B44_COMPRESSION, exr::B44A_COMPRESSION,
                                         exr::DWAA_COMPRESSION, exr::DWAB_COMPRESSION));

TEST(ExrDocument, Pxr24FloatsThatChangeBecomeZip) {
  TemporaryFolder folder;
  Part part;
  part.compression = exr::PXR24_COMPRESSION;
  part.planes = {constantPlane("R", exr::FLOAT, 1.0f, 48), noisePlane("V", exr::FLOAT, 48, 9)};
  writeFile(folder.path("in.exr"), {part});
  const ExrDocument document = readExr(folder.path("in.exr"));
  std::vector<float> fine(48, 1.00000012f);  // lost in 24 bits
  const Plane plane = floatPlane("R", fine);
  std::map<int, ExrPartEdit> edits;
  edits[0].replaced["R"] = plane.bytes;
  EXPECT_EQ(writeExr(folder.path("out.exr"), document, edits).size(), 1u);
  const Contents out = readFile(folder.path("out.exr"));
  EXPECT_TRUE(out.planes.at("0/R") == plane.bytes);
  EXPECT_TRUE(out.planes.at("0/V") == readFile(folder.path("in.exr")).planes.at("0/V"));
}

TEST(ExrDocument, MipMapsAreCopiedWholeButNotEdited) {
  for (const exr::LevelMode levels : {exr::MIPMAP_LEVELS, exr::RIPMAP_LEVELS}) {
    TemporaryFolder folder;
    Part part = mixedPart(kWindows[1], exr::ZIP_COMPRESSION, 16, 21);
    part.levels = levels;
    writeFile(folder.path("in.exr"), {part});
    const ExrDocument document = readExr(folder.path("in.exr"));
    for (const Plane& plane : part.planes) EXPECT_TRUE(document.parts[0].find(plane.name)->bytes == plane.bytes);
    writeExr(folder.path("copied.exr"), document);
    EXPECT_EQ(slurp(folder.path("copied.exr")), slurp(folder.path("in.exr")));
    EXPECT_THROW(writeExr(folder.path("coded.exr"), document, codeAgain(document)), InputError);
  }
}

TEST(ExrDocument, MayReplaceTheFileItCameFrom) {
  TemporaryFolder folder;
  std::vector<Part> parts = {mixedPart(kWindows[0], exr::ZIP_COMPRESSION, 0, 1),
                             mixedPart({kWindows[0].first, kWindows[2].second}, exr::PIZ_COMPRESSION, 0, 2)};
  parts[0].name = "a";
  parts[1].name = "b";
  writeFile(folder.path("in.exr"), parts);
  const Contents expected = readFile(folder.path("in.exr"));
  const ExrDocument document = readExr(folder.path("in.exr"));
  std::map<int, ExrPartEdit> edits = codeAgain(document);
  edits.erase(1);  // copied from the open file, whose path is about to be replaced
  writeExr(folder.path("in.exr"), document, edits);
  writeExr(folder.path("in.exr"), document, edits);
  expectSame(readFile(folder.path("in.exr")), expected);
}

TEST(ExrDocument, AttributesAreAddedAndReplaced) {
  TemporaryFolder folder;
  Part part = mixedPart(kWindows[0], exr::ZIP_COMPRESSION, 0, 1);
  part.matrices["matrix"] = std::vector<float>(16, 1.0f);
  writeFile(folder.path("in.exr"), {part});
  std::map<int, ExrPartEdit> edits;
  edits[0].attributes = {{"owner", "another"}, {"matrix", "now a text"}, {"pellucid:new", ""}};
  writeExr(folder.path("out.exr"), readExr(folder.path("in.exr")), edits);
  Contents expected = readFile(folder.path("in.exr"));
  expected.attributes["0/owner"] = "string:another";
  expected.attributes["0/matrix"] = "string:now a text";
  expected.attributes["0/pellucid:new"] = "string:";
  expectSame(readFile(folder.path("out.exr")), expected);
}

TEST(ExrDocument, NoticesThatItsFileWasOverwritten) {
  TemporaryFolder folder;
  writeFile(folder.path("in.exr"), {mixedPart(kWindows[0], exr::ZIP_COMPRESSION, 0, 1)});
  const ExrDocument document = readExr(folder.path("in.exr"));
  spit(folder.path("in.exr"), "something else");
  EXPECT_THROW(writeExr(folder.path("out.exr"), document), InputError);
  EXPECT_EQ(folder.list(), std::vector<std::string>{"in.exr"});
}

TEST(ExrDocument, RefusesWhatItCannotKeep) {
  TemporaryFolder folder;
  const auto message = [](const std::string& path) -> std::string {
    try {
      readExr(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(folder.path("none.exr")).find("none.exr"), std::string::npos);
  EXPECT_NE(message(folder.path("")).find("folder"), std::string::npos);
  EXPECT_NE(message("/dev/zero").find("device"), std::string::npos);
  spit(folder.path("text.exr"), "not an image at all");
  EXPECT_NE(message(folder.path("text.exr")).find("expected an OpenEXR file"), std::string::npos);
  spit(folder.path("empty.exr"), "");
  EXPECT_NE(message(folder.path("empty.exr")).find("0 bytes"), std::string::npos);
}

// Cut at every length: the whole file or none of it.
TEST(ExrDocument, RefusesEveryTruncation) {
  TemporaryFolder folder;
  for (const int tileSize : {0, 8}) {
    Part part;
    part.tileSize = tileSize;
    part.planes = {noisePlane("R", exr::HALF, 48, 1), noisePlane("Z", exr::FLOAT, 48, 2)};
    Part second = part;
    part.name = "one";
    second.name = "two";
    for (const bool multi : {false, true}) {
      writeFile(folder.path("in.exr"), multi ? std::vector<Part>{part, second} : std::vector<Part>{part});
      const std::string whole = slurp(folder.path("in.exr"));
      for (std::size_t length = 0; length < whole.size(); ++length) {
        spit(folder.path("cut.exr"), whole.substr(0, length));
        EXPECT_THROW(readExr(folder.path("cut.exr")), InputError) << length << " of " << whole.size() << " bytes";
      }
    }
  }
}

// One byte changed anywhere: refused, or read without harm (the sanitizers watch).
TEST(ExrDocument, SurvivesEveryChangedByte) {
  TemporaryFolder folder;
  Part part;
  part.planes = {halfPlane("R", std::vector<float>(48, 0.5f)), constantPlane("Z", exr::FLOAT, 2.0f, 48)};
  int refused = 0, read = 0;
  for (const exr::Compression compression : {exr::ZIP_COMPRESSION, exr::PIZ_COMPRESSION, exr::DWAA_COMPRESSION}) {
    part.compression = compression;
    writeFile(folder.path("in.exr"), {part});
    const std::string whole = slurp(folder.path("in.exr"));
    for (std::size_t i = 0; i < whole.size(); ++i)
      for (const int flip : {0x01, 0x80, 0xff}) {
        std::string bad = whole;
        bad[i] = static_cast<char>(bad[i] ^ flip);
        spit(folder.path("bad.exr"), bad);
        try {
          readExr(folder.path("bad.exr"));
          ++read;
        } catch (const InputError&) {
          ++refused;
        }
      }
  }
  printf("changed bytes: %d files refused, %d read\n", refused, read);
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 100);
}

TEST(Assets, DamagedFilesAreRefusedOrReadSafely) {
  if (assets().empty()) GTEST_SKIP() << "no shared assets";
  int refused = 0, read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(assets() + "/damaged")) {
    if (entry.path().filename() == "LICENSE") continue;
    try {
      readExr(entry.path());
      ++read;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(entry.path().filename().string()), std::string::npos);
      ++refused;
    }
  }
  printf("damaged files: %d refused, %d read\n", refused, read);
  EXPECT_GE(refused + read, 80) << "the folder should hold the damaged files of the OpenEXR project";
}

TEST(Assets, ReadableFilesComeBackWhole) {
  if (assets().empty()) GTEST_SKIP() << "no shared assets";
  TemporaryFolder folder;
  int files = 0, planes = 0;
  for (const char* kind : {"/exr", "/blender", "/deep"})
    for (const auto& entry : std::filesystem::directory_iterator(assets() + kind)) {
      if (entry.path().extension() != ".exr") continue;
      SCOPED_TRACE(entry.path());
      const Contents expected = readFile(entry.path());
      const ExrDocument document = readExr(entry.path());
      writeExr(folder.path("copied.exr"), document);
      const Contents copied = readFile(folder.path("copied.exr"));
      expectSame(copied, expected);
      const bool editable = document.parts[0].levelMode == 0 && !document.parts[0].deep;
      if (editable) {
        EXPECT_TRUE(writeExr(folder.path("coded.exr"), document, codeAgain(document)).empty());
        expectSame(readFile(folder.path("coded.exr")), expected);
      } else {
        EXPECT_EQ(slurp(folder.path("copied.exr")).size(), slurp(entry.path()).size());
      }
      ++files;
      planes += static_cast<int>(expected.planes.size());
    }
  printf("readable files: %d with %d channels, all identical\n", files, planes);
  EXPECT_GE(files, 23);
}

}  // namespace
}  // namespace pellucid::test
