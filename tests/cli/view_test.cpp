// `view`, and the page of `inspect --html`: what a file holds, as a person sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "composite/look/depth_histogram.h"
#include "composite/look/flow_diagram.h"
#include "composite/look/plan_view.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class View : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder = freshFolder(std::string("view-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directory(options.folder + "/tmp");
    options.environment = {"DISPLAY=", "WAYLAND_DISPLAY=", "TMPDIR=" + options.folder + "/tmp"};
  }
  Ended run(const std::vector<std::string>& arguments) { return runProgram(arguments, options); }
  // A desktop, whose opener writes down what it is asked for and ends with `code`.
  void giveDesktop(int code) {
    const std::string opener = options.folder + "/bin/xdg-open";
    std::filesystem::create_directory(options.folder + "/bin");
    std::ofstream(opener) << "#!/bin/sh\necho \"$1\" >'" << options.folder << "/opened'\nexit " << code << "\n";
    std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
    options.environment = {"DISPLAY=:7", "TMPDIR=" + options.folder + "/tmp",
                           "PATH=" + options.folder + "/bin:/usr/bin:/bin"};
  }
  std::vector<std::string> temporary() { return filesIn(options.folder + "/tmp"); }
  RunOptions options;
};

TEST_F(View, AnExrIsAPageOfItsLayers) {
  writeOpaque(options.folder + "/opaque.exr");
  const Ended ended = run({"view", "opaque.exr", "--print"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const std::string path = ended.out.substr(0, ended.out.find('\n'));
  EXPECT_EQ(std::filesystem::path(path).filename(), "opaque.html");
  EXPECT_EQ(path.rfind(options.folder + "/tmp/pellucid-view-", 0), 0u) << path;
  std::filesystem::copy(options.folder + "/opaque.exr", options.folder + "/opaque.tmp");
  EXPECT_NE(run({"view", "opaque.tmp", "--print"}).out.find("/opaque.html"), std::string::npos) << "by its content";
  const std::string page = slurp(path);
  for (const char* expected :
       {"<title>opaque.exr</title>", "<h2>Channels</h2>", "Pixels by depth", "\"pictures\":[", "beauty: R G B"})
    EXPECT_NE(page.find(expected), std::string::npos) << expected;
}

TEST_F(View, WithoutADisplayItSaysSoAndWhere) {
  std::ofstream(options.folder + "/picture.png") << "a PNG";
  const Ended ended = run({"view", "picture.png"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out, options.folder + "/picture.png\n");
  EXPECT_NE(ended.err.find("not opened: DISPLAY and WAYLAND_DISPLAY name no display"), std::string::npos) << ended.err;
  EXPECT_TRUE(temporary().empty());
}

TEST_F(View, TheDesktopOpensIt) {
  giveDesktop(0);
  std::ofstream(options.folder + "/picture.png") << "a PNG";
  std::filesystem::create_directory(options.folder + "/report");
  std::ofstream(options.folder + "/report/study.html") << "a page";
  for (const auto& [asked, opened] : {std::pair{"picture.png", "/picture.png"}, {"report", "/report/study.html"}}) {
    const Ended ended = run({"view", asked});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(slurp(options.folder + "/opened"), options.folder + opened + "\n");
    EXPECT_EQ(ended.out, options.folder + opened + "\n");
  }
  std::filesystem::remove(options.folder + "/opened");
  EXPECT_EQ(run({"view", "picture.png", "--print"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(options.folder + "/opened"));
}

TEST_F(View, WhatIsRefused) {
  std::ofstream(options.folder + "/broken.exr") << "no EXR";
  std::ofstream(options.folder + "/picture.png") << "a PNG";
  std::filesystem::create_directory(options.folder + "/empty");
  const auto refused = [&](const std::string& file, int code, const std::string& sentence) {
    const Ended ended = run({"view", file});
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err << "\n  lacks " << sentence;
  };
  refused("missing.png", 3, "missing.png: not found, expected a file that a verb wrote");
  refused("empty", 3, "empty: found a folder without study.html");
  refused("broken.exr", 3, "broken.exr");
  giveDesktop(3);
  refused("picture.png", 6, "picture.png: cannot be opened: xdg-open ended with 3, expected a program that shows it");
  options.environment.back() = "PATH=" + options.folder;
  refused("picture.png", 6, "expected the program of xdg-utils");
  EXPECT_TRUE(temporary().empty());
}

TEST_F(View, InspectShowsWhatWouldBeCompositedWhere) {
  writeOpaque(options.folder + "/opaque.exr");
  writeGlb(options.folder + "/scene.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .5f)}});
  const Ended ended = run({"inspect", "opaque.exr", "--html", "page.html", "--scene", "scene.glb", "--camera",
                           "eye=0,0,0;look=0,0,-1;fov=60"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string page = slurp(options.folder + "/page.html");
  for (const char* expected : {"<h2>Scene</h2>", "<td>composited</td>", "3 to 3 m", "class=\"plan\"", ">camera</text>",
                               "at most 1 on one.", "layers on each pixel", "composited at pixel centres"})
    EXPECT_NE(page.find(expected), std::string::npos) << expected;
  // The pane is 1 m wide at 3 m: of 2 tan(30 degrees) 3 = 3.46 m that the height shows.
  const OpaqueFile file = readOpaque(options.folder + "/opaque.exr", {});
  const double edge = file.gbuffer.display.height() / 3.4641;
  const auto at = page.find(" pixels show transparent layers");
  const double covered = std::stod(page.substr(page.rfind("Scene: ", at) + 7));
  EXPECT_NEAR(covered, edge * edge, 2 * edge + 1) << "a pixel at each edge";
}

TEST_F(View, DeepFilesOverAPictureNeedNoCamera) {
  writeOpaque(options.folder + "/opaque.exr");
  writeGlb(options.folder + "/scene.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .5f)}});
  ASSERT_EQ(run({"fragments", "opaque.exr", "scene.glb", "-o", "deep.exr", "--camera", "fit"}).code, 0);
  const Ended ended = run({"inspect", "opaque.exr", "--html", "page.html", "--scene", "deep.exr"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string page = slurp(options.folder + "/page.html");
  EXPECT_NE(page.find("at most 1 on one."), std::string::npos);
  EXPECT_EQ(page.find("class=\"plan\""), std::string::npos) << "nobody says where the camera is";
  EXPECT_EQ(page.find("<h2>Scene</h2>"), std::string::npos) << "a deep file has no nodes";
}

TEST_F(View, InspectRefusesWhatThePageAloneReads) {
  writeOpaque(options.folder + "/opaque.exr");
  struct Row {
    std::vector<std::string> words;
    int code;
    const char* sentence;
  };
  const Row rows[] = {
      {{"inspect", "opaque.exr", "--scene", "a.glb"}, 2, "--scene: found it without --html"},
      {{"inspect", "opaque.exr", "--html", "p.html", "--camera", "fit"}, 2, "--camera: found it without --scene"},
      {{"inspect", "opaque.exr", "--html", "p.png"}, 2, ".html"},
      {{"inspect", "--devices", "--html", "p.html"}, 2, "--html and --devices"},
      {{"inspect", "opaque.exr", "--html", "p.html", "--scene", "a.glb"}, 3, "composite says: glTF scene: a.glb"},
  };
  for (const Row& row : rows) {
    const Ended ended = run(row.words);
    EXPECT_EQ(ended.code, row.code) << ended.err;
    EXPECT_NE(ended.err.find(row.sentence), std::string::npos) << ended.err << "\n  lacks " << row.sentence;
  }
  EXPECT_FALSE(std::filesystem::exists(options.folder + "/p.html"));
}

TEST_F(View, ThePlanIsADiagram) {
  writeOpaque(options.folder + "/opaque.exr");
  writeGlb(options.folder + "/scene.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .5f)}});
  std::vector<std::string> words{"composite", "opaque.exr", "scene.glb",      "-o",       "out.exr",
                                 "--camera",  "fit",        "--explain-page", "plan.html"};
  const Ended ended = run(words);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(filesIn(options.folder), (std::vector<std::string>{"opaque.exr", "plan.html", "scene.glb", "tmp"}))
      << "nothing is drawn";
  const std::string page = slurp(options.folder + "/plan.html");
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_NE(page.find(line.substr(0, line.find(' '))), std::string::npos) << line;
  for (const char* expected : {"class=\"flow\"", ">Transparent things<", "scene.glb<", ">Passes<", "out.exr<"})
    EXPECT_NE(page.find(expected), std::string::npos) << expected;
  words.back() = "plan.png";
  EXPECT_EQ(run(words).code, 2);
}

TEST(FlowSvg, EveryStepHasAnArrowFromWhatIsBeforeIt) {
  const std::string svg = flowSvg({{"a", {"one"}}, {"b", {std::string(300, 'x') + " y"}}}, {{"c", {}}, {"d & e", {}}});
  std::size_t arrows = 0, boxes = 0;
  for (auto at = svg.find("marker-end"); at != std::string::npos; at = svg.find("marker-end", at + 1)) ++arrows;
  for (auto at = svg.find("<rect"); at != std::string::npos; at = svg.find("<rect", at + 1)) ++boxes;
  EXPECT_EQ(boxes, 4u);
  EXPECT_EQ(arrows, 3u) << "two sources to c, c to d";
  EXPECT_NE(svg.find("d &amp; e"), std::string::npos);
}

TEST(DepthBins, AreOfEqualRatio) {
  Image<float> viewZ(6, 1, 1.0f);
  viewZ[1] = 10.0f;
  viewZ[2] = 100.0f;
  viewZ[3] = 1.5f;
  viewZ[4] = viewZ[5] = std::numeric_limits<float>::infinity();
  const DepthBins bins = depthBins(viewZ, 4);  // edges at 1, 3.16, 10, 31.6 and 100
  EXPECT_EQ(bins.nearest, 1.0);
  EXPECT_EQ(bins.farthest, 100.0);
  EXPECT_EQ(bins.nothing, 2u);
  EXPECT_EQ(bins.pixels, (std::vector<std::size_t>{2, 0, 1, 1}));
  EXPECT_EQ(depthBins(Image<float>(2, 1, 7.0f), 3).pixels, (std::vector<std::size_t>{2, 0, 0}));
  EXPECT_NE(histogramSvg(depthBins(Image<float>(1, 1, std::numeric_limits<float>::infinity()))).find("1 pixels"),
            std::string::npos);
}

// The eye at the origin looks down -z, which is up in the drawing; the box stands before it to the right.
TEST(PlanSvg, PutsThingsWhereTheyAre) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 8, 4};
  gbuffer.beauty = Image<glm::vec4>(8, 4, glm::vec4(1.0f));
  gbuffer.viewZ = Image<float>(8, 4, 10.0f);
  Camera camera;
  const std::string svg = planSvg(gbuffer, camera, {{"a <b>", {2, 0, -6}, {4, 1, -5}, true}});
  const auto number = [&](const std::string& before, const char* name) {
    const auto at = svg.find(name + std::string("=\""), svg.find(before));
    return std::stod(svg.substr(at + std::string(name).size() + 2));
  };
  EXPECT_NE(svg.find("a &lt;b&gt;"), std::string::npos);
  const double boxX = number("<rect", "x"), boxY = number("<rect", "y");
  const auto eye = svg.rfind("<circle", svg.find("r=\"5\""));
  const double x = std::stod(svg.substr(svg.find("cx=\"", eye) + 4)),
               y = std::stod(svg.substr(svg.find("cy=\"", eye) + 4));
  EXPECT_GT(boxX, x);
  EXPECT_LT(boxY, y);
  // Lengths are to one scale: the box begins 2 m to the right of the eye and 6 m before it, and is 2 m wide.
  EXPECT_NEAR((boxX - x) / number("<rect", "width"), 1.0, 0.01);
  EXPECT_NEAR((y - boxY) / number("<rect", "width"), 3.0, 0.01);
}

}  // namespace
}  // namespace pellucid
