// The table of producers: every row is recognised, forced and told; and what the planes of a picture tell of its depth.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gbuffer/depth_evidence.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/producers.h"
#include "layouts.h"

namespace pellucid::test {
namespace {

std::string recognised(const std::vector<Part>& parts, const std::string& preset = "auto") {
  TemporaryFolder folder;
  writeFile(folder.path("shot.exr"), parts);
  const ExrDocument document = readExr(folder.path("shot.exr"));
  const RecognisedProducer found = recogniseProducer(document, nameChannels(document), preset);
  return found.row ? found.row->name : "";
}

// A name that the pattern of a row stands for.
std::string nameFor(const std::string& pattern) {
  if (pattern.ends_with("*")) return pattern.substr(0, pattern.size() - 1) + "Depth.R";
  return pattern.starts_with("*.") ? "aov." + pattern.substr(2) : pattern;
}

TEST(Producers, EveryRowIsRecognisedForcedAndTold) {
  std::set<std::string> names;
  Part plain;
  plain.planes = {constantPlane("R", exr::HALF, 1, 48)};
  EXPECT_EQ(recognised({plain}), "");
  for (const Producer& row : producers()) {
    SCOPED_TRACE(row.name);
    EXPECT_TRUE(names.insert(row.name).second);
    EXPECT_NE(std::string(row.source), "");
    EXPECT_GT(row.unit, 0.0);
    EXPECT_NO_THROW(parseDepthKind(row.kind));
    EXPECT_TRUE(!row.marks.empty() || !row.names.empty());
    for (const HeaderMark& mark : row.marks) {
      Part part = plain;
      part.strings[std::string(mark.attribute) + (mark.isPrefix ? "x" : "")] = mark.text ? mark.text : "1";
      EXPECT_EQ(recognised({part}), row.name);
    }
    if (!row.names.empty()) {
      Part part = plain;
      for (const char* pattern : row.names) part.planes.push_back(constantPlane(nameFor(pattern), exr::HALF, 1, 48));
      EXPECT_EQ(recognised({part}), row.name);
    }
    EXPECT_EQ(recognised({plain}, row.name), row.name);
    EXPECT_NE(producersHelp().find(row.title), std::string::npos);
    EXPECT_NE(producersHelp().find(row.source), std::string::npos);
    EXPECT_NE(producerNames().find(row.name), std::string::npos);
  }
  EXPECT_THROW(recognised({plain}, "paint"), UsageError);
}

TEST(Producers, EveryRowHasALayout) {
  std::set<std::string> seen;
  for (const Layout& layout : layoutsOf(Room())) {
    seen.insert(layout.producer);
    EXPECT_EQ(recognised(layout.parts), layout.producer) << layout.depth << ", " << layout.words;
  }
  for (const Producer& row : producers()) EXPECT_TRUE(seen.count(row.name)) << row.name << " has no layout";
}

TEST(Producers, AWallThatTellsNothingIsAsked) {
  TemporaryFolder folder;
  const Room room;
  for (const bool withCamera : {true, false})
    for (const char* preset : {"nuke", "vray"}) {
      Part part = room.part(withCamera);
      part.planes.push_back(constantPlane("Z", exr::FLOAT, 5.0f, room.z.size()));
      writeFile(folder.path("wall.exr"), {part});
      ReadOptions options;
      options.preset = preset;
      const bool tells = withCamera && std::string(preset) == "vray";  // 1/z of a wall that faces the eye is even too
      if (tells)
        EXPECT_EQ(readOpaque(folder.path("wall.exr"), options).choice.depthKind, "planar");
      else
        EXPECT_THROW(readOpaque(folder.path("wall.exr"), options), MeaningError) << preset;
      options.depthKind = "inverse";
      EXPECT_NEAR(static_cast<double>(readOpaque(folder.path("wall.exr"), options).gbuffer.viewZ[0]), 0.2, 1e-7);
    }
}

// Mitsuba 2 calls its depth what the user calls it, "dd.y" after its guide, and measures along rays as Mitsuba 3 does.
TEST(Producers, ADepthThatIsNamedIsOfItsProducersKind) {
  TemporaryFolder folder;
  const Room room;
  const auto along = room.depth([](double z, double ray) { return z * ray; });
  const auto planar = room.depth([](double z, double) { return z; });
  ReadOptions options;
  options.depthChannel = "dd.y";
  const auto kindOf = [&](const std::vector<float>& values, const char* generatedBy) {
    Part part = room.part(true);
    part.planes.push_back(floatPlane("dd.y", values));
    if (*generatedBy) part.strings["generatedBy"] = generatedBy;
    writeFile(folder.path("shot.exr"), {part});
    return readOpaque(folder.path("shot.exr"), options).choice.depthKind;
  };
  EXPECT_EQ(kindOf(along, "Mitsuba version 2.2.1"), "ray");
  EXPECT_EQ(kindOf(planar, "Mitsuba version 2.2.1"), "planar");
  EXPECT_EQ(kindOf(planar, ""), "planar");
  std::uint32_t state = 1;
  const auto noise =
      room.depth([&](double, double) { return 1 + 9 * ((state = state * 1664525u + 1013904223u) / 4294967296.0); });
  EXPECT_THROW(kindOf(noise, "Mitsuba version 2.2.1"), MeaningError);
}

TEST(Evidence, PlanesTellReadingsApartAndNoiseTellsNone) {
  TemporaryFolder folder;
  std::size_t right = 0, asked = 0, wrong = 0;
  std::uint32_t state = 1;
  const auto noise = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  const auto judge = [&](const Room& room, const std::vector<float>& values, bool half, const std::string& truth) {
    Part part = room.part(true);
    part.planes.push_back(half ? halfPlane("Z", values) : floatPlane("Z", values));
    writeFile(folder.path("shot.exr"), {part});
    ReadOptions options;
    options.depthKind = "auto";
    std::string found;
    try {
      found = readOpaque(folder.path("shot.exr"), options).choice.depthKind;
    } catch (const MeaningError&) {
    }
    ++(found.empty() ? asked : found == truth ? right : wrong);
    EXPECT_TRUE(found.empty() || found == truth) << found << " for " << truth;
  };
  const std::pair<const char*, StoredDepth> readings[] = {{"planar", [](double z, double) { return z; }},
                                                          {"ray", [](double z, double ray) { return z * ray; }},
                                                          {"inverse", [](double z, double) { return 1 / z; }}};
  for (const double focal : {0.7, 1.2, 2.5, 5.0})
    for (const bool half : {false, true})
      for (const auto& [name, stored] : readings) {
        const Room room(true, focal);
        judge(room, room.depth(stored), half, name);
        judge(room, room.depth([&](double, double) { return 1 + 9 * noise(); }), half, "none");
        // Things that are curved everywhere: a hollow and a ball before noise.
        judge(room, room.depth([&](double, double ray) { return stored(4 / ray - 1.5 / (ray * ray), ray); }), half,
              name);
        judge(room, room.depth([&](double, double ray) {
          const double inside = 25 - ray * ray * (25 - 4.5 * 4.5);
          return stored(inside > 0 ? (5 - std::sqrt(inside)) / (ray * ray) : 3 + 8 * noise(), ray);
        }),
              half, name);
      }
  std::printf("depth kinds by evidence: %zu right, %zu asked, %zu wrong\n", right, asked, wrong);
  EXPECT_EQ(wrong, 0u);
  EXPECT_GE(right, 20u);
}

}  // namespace
}  // namespace pellucid::test
