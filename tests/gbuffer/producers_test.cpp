// The table of producers: every row is recognised, forced and told; layouts as renderers write them are read right, or
// asked about, and never wrong in silence.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gbuffer/depth_evidence.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/producers.h"
#include "room.h"

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

struct Layout {
  const char* producer;
  const char* channel;
  bool half;
  double (*stored)(double z, double ray);
  std::vector<std::pair<const char*, const char*>> header;
  const char* decided;  // the kind that is read; "" where it is asked
};

double planar(double z, double) {
  return z;
}
double along(double z, double ray) {
  return z * ray;
}
double inverse(double z, double) {
  return 1 / z;
}
double centimetres(double z, double) {
  return 100 * z;
}
double ramp(double z, double) {
  return z / 40;
}
double invertedRamp(double z, double) {
  return 1 - z / 40;
}
double negative(double z, double) {
  return -z;
}

const Layout kLayouts[] = {
    {"blender", "ViewLayer.Depth.Z", false, planar, {{"BlenderMultiChannel", "Blender V2.55.1 and newer"}}, "planar"},
    {"arnold", "Z", false, planar, {{"arnold/version", "7"}}, "planar"},
    {"renderman", "Z", false, planar, {{"Software", "RenderMan 25"}}, "planar"},
    {"vray", "VRayZDepth.R", false, planar, {{"vray/version", "6"}}, "planar"},
    {"vray", "VRayZDepth.R", false, along, {{"vray/version", "6"}}, "ray"},
    {"vray", "VRayZDepth.R", true, ramp, {{"Software", "V-Ray"}}, ""},
    {"vray", "VRayZDepth.R", true, invertedRamp, {{"Software", "V-Ray"}}, ""},
    {"karma", "hitPz", false, planar, {{"husk:render_stats", "{}"}}, "planar"},
    {"karma", "hitPz", false, along, {{"husk:render_stats", "{}"}}, "ray"},
    {"mantra", "Z", false, negative, {{"Software", "mantra 20"}}, "negative"},
    {"3delight", "Z", false, along, {{"Software", "3Delight"}}, "ray"},
    {"redshift", "Z", true, planar, {{"rs/camera/nearPlane", ".1"}}, "planar"},
    {"unreal", "FinalImageMovieRenderQueue_WorldDepth.R", true, centimetres, {{"unreal/version", "5.4"}}, "planar"},
    {"unity", "Depth.R", true, ramp, {{"Software", "Unity Recorder"}}, ""},
    {"mitsuba", "dd.y.T", false, along, {}, "ray"},
    {"pbrt", "P.Z", false, planar, {}, "planar"},
    {"appleseed", "Z", false, along, {{"appleseed:Version", "2.1"}}, "ray"},
    {"luxcore", "Z", false, along, {{"Software", "LuxCore"}}, "ray"},
    {"octane", "Z", true, ramp, {{"Software", "Octane"}}, ""},
    {"corona", "Z", false, planar, {{"Software", "Corona"}}, "planar"},
    {"maya", "Z", false, negative, {{"Software", "Maya"}}, "negative"},
    {"3dsmax", "Z", false, negative, {{"Software", "3ds Max"}}, "negative"},
    {"nuke", "depth.Z", false, inverse, {{"nuke/version", "15.1v3"}}, "inverse"},
    {"nuke", "depth.Z", false, planar, {{"nuke/version", "15.1v3"}}, "planar"},
    {"natron", "depth.Z", false, inverse, {{"Software", "Natron"}}, "inverse"},
};

Part partOf(const Layout& layout, const Room& room) {
  const std::string view = std::string(layout.producer) == "blender" ? "ViewLayer.Combined." : "";
  Part part = room.part(true, view);
  for (const auto& [name, text] : layout.header) part.strings[name] = text;
  const std::vector<float> values = room.depth(layout.stored);
  part.planes.push_back(layout.half ? halfPlane(layout.channel, values) : floatPlane(layout.channel, values));
  if (std::string(layout.producer) == "pbrt")
    for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B", "u", "v", "P.X", "P.Y", "N.X", "N.Y", "N.Z"})
      part.planes.push_back(constantPlane(name, exr::HALF, 0.5f, values.size()));
  return part;
}

TEST(Producers, LayoutsAreReadRightOrAsked) {
  TemporaryFolder folder;
  const Room room;
  std::set<std::string> seen;
  std::printf("| preset | depth | read as | pixels wrong |\n| --- | --- | --- | --- |\n");
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE(std::string(layout.producer) + " " + layout.channel + " " + layout.decided);
    seen.insert(layout.producer);
    writeFile(folder.path("shot.exr"), {partOf(layout, room)});
    std::string refusal;
    std::size_t wrong = 0;
    try {
      const OpaqueFile file = readOpaque(folder.path("shot.exr"), {});
      EXPECT_EQ(file.choice.preset, layout.producer);
      EXPECT_EQ(file.choice.depthChannel, layout.channel);
      EXPECT_EQ(file.choice.depthKind, layout.decided);
      const double tolerance = layout.half ? 2e-3 : 2e-6;
      for (std::size_t i = 0; i < room.z.size(); ++i)
        wrong += std::abs(static_cast<double>(file.gbuffer.viewZ[i]) / room.z[i] - 1) > tolerance;
    } catch (const MeaningError& error) {
      refusal = error.what();
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(refusal.empty(), *layout.decided != '\0') << refusal;
    if (!refusal.empty()) {
      EXPECT_NE(refusal.find("--depth-kind"), std::string::npos) << refusal;
    }
    std::printf("| %s | `%s`, %s | %s | %zu |\n", layout.producer, layout.channel, layout.half ? "half" : "float",
                *layout.decided ? layout.decided : "asked", wrong);
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
  const std::pair<const char*, double (*)(double, double)> readings[] = {
      {"planar", planar}, {"ray", along}, {"inverse", inverse}};
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
