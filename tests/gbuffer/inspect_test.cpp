#include "gbuffer/inspect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exr_files.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/errors.h"

namespace pellucid::test {
namespace {

TEST(Inspect, SaysWhatWasUnderstood) {
  TemporaryFolder folder;
  Part part;
  part.data = {-1, 2, 7, 8};
  std::vector<float> depth(48, 5.0f);
  for (std::size_t i = 0; i < 12; ++i) depth[i] = 1e10f;
  for (std::size_t i = 12; i < 20; ++i) depth[i] = 0.05f;
  for (const char* name : {"R", "G", "B"}) part.planes.push_back(constantPlane(name, exr::HALF, 0.5f, 48));
  part.planes.push_back(floatPlane("depth.Z", depth));
  part.strings["odd"] = "caf\xe9 \x01";  // not UTF-8
  writeFile(folder.path("shot.exr"), {part});
  const nlohmann::json report = inspectExr(folder.path("shot.exr"), {});
  EXPECT_FALSE(report.contains("refusal")) << report.dump();
  EXPECT_EQ(report["depth"]["channel"], "depth.Z");
  EXPECT_EQ(report["depth"]["kind"], "planar");
  EXPECT_EQ(report["depth"]["far"], 1e9);
  const nlohmann::json& histogram = report["depth"]["histogram"];
  EXPECT_EQ(histogram["nothing"], 12);
  ASSERT_EQ(histogram["decades"].size(), 2u);
  EXPECT_EQ(histogram["decades"][0]["pixels"], 8);
  EXPECT_DOUBLE_EQ(histogram["decades"][0]["from"].get<double>(), 0.01);
  EXPECT_EQ(histogram["decades"][1]["pixels"], 28);
  EXPECT_EQ(report["beauty"]["channels"].size(), 3u);
  EXPECT_EQ(report["beauty"]["alpha"], false);
  EXPECT_EQ(report["parts"][0]["data"]["x"], -1);
  EXPECT_EQ(report["parts"][0]["data"]["width"], 8);
  EXPECT_EQ(report["parts"][0]["compression"], "zip");
  EXPECT_EQ(report["parts"][0]["channels"][3]["name"], "depth.Z");
  EXPECT_EQ(report["parts"][0]["channels"][3]["type"], "float");
  EXPECT_TRUE(report["camera"].is_null());
  EXPECT_NO_THROW(report.dump());
  const std::string text = inspectionText(report);
  for (const char* expected : {"shot.exr", "8 x 6 at (-1, 2)", "depth: depth.Z, planar", "beauty: R G B",
                               "nothing: 12 pixels", "camera: none"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " in\n" << text;
}

TEST(Inspect, DescribesDeepPictures) {
  TemporaryFolder folder;
  DeepHeader header;
  header.display = header.data = {0, 0, 2, 1};
  header.channels = {"R", "G", "B", "A", "Z"};
  Camera camera;
  header.camera = &camera;
  DeepWriter writer(folder.path("deep.exr"), header);
  DeepRows rows;
  rows.window = header.data;
  rows.offsets = {0, 2, 3};
  rows.channels = {{.1f, .2f, .3f}, {.1f, .2f, .3f}, {.1f, .2f, .3f}, {.5f, 1.0f, 1.0f}, {2.0f, 7.5f, INFINITY}};
  writer.write(rows);
  writer.finish();
  const nlohmann::json report = inspectExr(folder.path("deep.exr"), {});
  EXPECT_FALSE(report.contains("refusal")) << report.dump();
  EXPECT_EQ(report["deep"]["samples"], 3);
  EXPECT_EQ(report["deep"]["mostInAPixel"], 2);
  EXPECT_EQ(report["depth"]["channel"], "Z");
  const std::string text = inspectionText(report);
  for (const char* expected : {"3 samples, at most 2", "colour: R G B", "opacity: A", "depth: Z, planar", "2 to 7.5",
                               "camera: attribute worldToCamera"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " in\n" << text;
  EXPECT_EQ(text.find("cannot be composited"), std::string::npos);
}

TEST(Inspect, SaysWhyAFileIsOfNoUse) {
  TemporaryFolder folder;
  Part part;
  for (const char* name : {"R", "G", "B"}) part.planes.push_back(constantPlane(name, exr::HALF, 0.5f, 48));
  writeFile(folder.path("flat.exr"), {part});
  const nlohmann::json report = inspectExr(folder.path("flat.exr"), {});
  EXPECT_NE(report["refusal"].get<std::string>().find("no depth"), std::string::npos);
  EXPECT_EQ(report["refusalCode"], 4);
  EXPECT_NE(inspectionText(report).find("cannot be composited onto"), std::string::npos);
  EXPECT_THROW(inspectExr(folder.path("none.exr"), {}), InputError);
}

TEST(Inspect, EveryAssetIsReported) {
  if (assets().empty()) GTEST_SKIP() << "no shared assets";
  for (const char* name : {"/exr/Beachball_multipart.0001.exr", "/exr/LuminanceChroma_Garden.exr", "/deep/Balls.exr",
                           "/blender/gbuffer.exr", "/exr/WavyLinesLatLong.exr"}) {
    const nlohmann::json report = inspectExr(assets() + name, {});
    EXPECT_FALSE(report.dump().empty());
    EXPECT_FALSE(inspectionText(report).empty());
    EXPECT_EQ(report.contains("refusal"), !report.contains("depth")) << name;
  }
  EXPECT_NE(inspectExr(assets() + "/exr/LuminanceChroma_Garden.exr", {})["refusal"].get<std::string>().find(
                "luminance-chroma"),
            std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
