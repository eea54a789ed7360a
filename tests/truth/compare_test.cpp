// The regression gate, as a user runs it: what idiff lets pass is a failure here.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "gbuffer/exr_document.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/truth/browser.h"

namespace pellucid {
namespace {

using namespace test;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

class Compare : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("compare-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    layer = {"", {{"R", ramp(0)}, {"G", ramp(1)}, {"B", ramp(2)}}};
    write("a.exr", {layer});
  }
  Image<float> ramp(int c) const {
    Image<float> image(16, 8);
    for (std::size_t i = 0; i < image.size(); ++i)
      image[i] = .01f * static_cast<float>(i) + .1f * static_cast<float>(c);
    return image;
  }
  void write(const std::string& name, const std::vector<ExtraLayer>& layers, Window data = {0, 0, 16, 8},
             const std::map<std::string, std::string>& attributes = {}, bool half = false) {
    writeLayers(folder + "/" + name, {0, 0, 16, 8}, data, layers, attributes, nullptr, half);
  }
  int gate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"compare", "a.exr", "b.exr"});
    last = runProgram(arguments, options);
    return last.code;
  }
  std::string folder;
  RunOptions options;
  ExtraLayer layer;
  Ended last;
};

TEST_F(Compare, SamePasses) {
  write("b.exr", {layer});
  EXPECT_EQ(gate({}), 0) << last.out << last.err;
}

TEST_F(Compare, NamesTheWorstPixelAndCounts) {
  layer.channels[1].second.at(5, 3) += .25f;
  layer.channels[0].second.at(2, 1) += .05f;
  write("b.exr", {layer});
  EXPECT_EQ(gate({"--json"}), 1);
  const nlohmann::json report = nlohmann::json::parse(last.out);
  const nlohmann::json& entry = report["layers"][0];
  EXPECT_EQ(entry["failing"], 2);
  EXPECT_EQ(entry["worst"]["x"], 5);
  EXPECT_EQ(entry["worst"]["y"], 3);
  EXPECT_EQ(entry["worst"]["channel"], "G");
  EXPECT_NEAR(entry["worst"]["difference"].get<double>(), .25, 1e-6);
  EXPECT_EQ(gate({"--fail", ".3"}), 0) << last.out;
  EXPECT_NE(last.out.find("WARNING"), std::string::npos) << last.out;
  EXPECT_EQ(gate({"--fail", ".3", "--warn", ".3"}), 0);
  EXPECT_EQ(last.out.find("WARNING"), std::string::npos) << last.out;
  EXPECT_EQ(gate({"--failpercent", "2"}), 0);  // 2 of 128 are 1.56 %
  EXPECT_EQ(gate({"--failpercent", "1.5"}), 1);
  EXPECT_EQ(gate({"--failpercent", "2", "--hardfail", ".2"}), 1);
  EXPECT_EQ(gate({"--allowfailures", "2"}), 0);
  EXPECT_EQ(gate({"--allowfailures", "1"}), 1);
  EXPECT_EQ(gate({"--failrelative", ".9"}), 0);
}

TEST_F(Compare, NonFiniteValuesAreNotEqualToNumbers) {
  layer.channels[0].second.at(3, 3) = kNan;
  write("b.exr", {layer});
  EXPECT_EQ(gate({"--fail", "1e9", "--failpercent", "99"}), 1);
  EXPECT_NE(last.out.find("(3, 3)"), std::string::npos) << last.out;
  if (std::system("command -v idiff >/dev/null") == 0) {
    const int theirs = std::system(("cd " + folder + " && idiff a.exr b.exr >/dev/null 2>&1").c_str());
    printf("[ figure ] NaN against a number: idiff exits with %d, compare with 1\n", WEXITSTATUS(theirs));
  }
  write("a.exr", {layer});  // the same NaN in both
  EXPECT_EQ(gate({}), 0) << last.out;
  EXPECT_EQ(gate({"--finite"}), 1);
  layer.channels[0].second.at(3, 3) = kInfinity;
  write("b.exr", {layer});
  EXPECT_EQ(gate({}), 1);
  layer.channels[0].second.at(3, 3) = -kInfinity;
  write("a.exr", {layer});
  EXPECT_EQ(gate({"--fail", "1e30"}), 1);
}

TEST_F(Compare, WindowsChannelsTypesAndMetadata) {
  ExtraLayer small = layer;
  for (auto& [name, image] : small.channels) image = Image<float>(15, 8, .5f);
  write("b.exr", {small}, {0, 0, 15, 8});
  EXPECT_EQ(gate({"--fail", "10"}), 1);
  EXPECT_NE(last.out.find("data window (0, 0)-(15, 7) against (0, 0)-(14, 7)"), std::string::npos) << last.out;
  ExtraLayer extra{"depth", {{"Z", ramp(0)}}};
  write("b.exr", {layer, extra});
  EXPECT_EQ(gate({}), 1);
  EXPECT_NE(last.out.find("channel depth.Z is only in the second file"), std::string::npos) << last.out;
  write("b.exr", {layer}, {0, 0, 16, 8}, {}, true);
  EXPECT_EQ(gate({"--fail", "1"}), 1);
  EXPECT_NE(last.out.find("float against half"), std::string::npos) << last.out;
  write("b.exr", {layer}, {0, 0, 16, 8}, {{"owner", "someone"}});
  EXPECT_EQ(gate({}), 1);
  EXPECT_NE(last.out.find("attribute owner is only in the second file"), std::string::npos) << last.out;
  EXPECT_EQ(gate({"--metadata", "warn"}), 0);
  EXPECT_EQ(gate({"--ignore-attribute", "owner"}), 0);
}

TEST_F(Compare, OneLayerAlone) {
  ExtraLayer other{"fog", {{"R", ramp(0)}}}, changed = other;
  changed.channels[0].second.at(0, 0) = 9;
  write("a.exr", {layer, other});
  write("b.exr", {layer, changed});
  EXPECT_EQ(gate({}), 1);
  EXPECT_EQ(gate({"--layer", "fog"}), 1);
  EXPECT_EQ(gate({"--layer", ""}), 0) << last.out << last.err;
  EXPECT_EQ(gate({"--layer", "smoke"}), 2);
}

TEST_F(Compare, MissingAndDamagedFiles) {
  EXPECT_EQ(gate({}), 3);
  std::ofstream(folder + "/b.exr") << "not an EXR";
  EXPECT_EQ(gate({}), 3);
}

// The page in a browser: the slider moves, the numbers are read, the heat map shows the one pixel that differs.
TEST_F(Compare, ThePageWorksInABrowser) {
  layer.channels[1].second.at(5, 3) += .25f;
  write("b.exr", {layer});
  EXPECT_EQ(gate({"--html", "page.html"}), 1);
  const std::string page = slurp(folder + "/page.html");
  ASSERT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
  if (!haveBrowser()) GTEST_SKIP() << "no chromium (apt package chromium)";
  const nlohmann::json out = probePage(folder, folder + "/page.html", R"JS(
  const view = find('view'), heat = find('heat');
  const place = (x, y) => [Math.floor((x + 0.5) / 16 * view.width), Math.floor((y + 0.5) / 8 * view.height)];
  set('split', 1); out.left = at(view, ...place(5, 3));
  set('split', 0); out.right = at(view, ...place(5, 3));
  out.split = pellucid.state.split;
  out.heatHot = at(heat, ...place(5, 3)); out.heatCold = at(heat, ...place(6, 3));
  out.value = pellucid.valueAt(pellucid.data.pictures[1], 5, 3, 1);
  set('exposure', 2);
  set('split', 1); out.brighter = at(view, ...place(5, 3));
  view.dispatchEvent(new WheelEvent('wheel', {deltaY: -1, clientX: 10, clientY: 10}));
  out.zoom = pellucid.state.zoom;)JS");
  ASSERT_FALSE(out.contains("error")) << out;
  const auto shown = [](double v) {
    return v <= .0031308 ? 255 * 12.92 * v : 255 * (1.055 * std::pow(v, 1 / 2.4) - .055);
  };
  const double value = .01 * (3 * 16 + 5) + .1;
  EXPECT_NEAR(out["left"][1].get<double>(), shown(value), 1.5);
  EXPECT_NEAR(out["right"][1].get<double>(), shown(value + .25), 1.5);
  EXPECT_NEAR(out["value"].get<double>(), value + .25, 1e-3);  // half
  EXPECT_EQ(out["heatCold"], nlohmann::json({60, 60, 60}));
  EXPECT_NE(out["heatHot"], out["heatCold"]);
  EXPECT_GT(out["brighter"][0].get<int>(), out["left"][0].get<int>());
  EXPECT_GT(out["zoom"].get<double>(), 1.0);
  EXPECT_EQ(out["split"].get<double>(), 0.0);
}

}  // namespace
}  // namespace pellucid
