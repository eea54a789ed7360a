// Pages show colours as --preview does: what a browser draws, pixel by pixel, against OpenColorIO on the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "composite/colour/display.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"
#include "tests/truth/browser.h"

namespace pellucid {
namespace {

using namespace test;
using nlohmann::json;

constexpr int kAcross = 48, kDown = 32;

// Half floats, as pages keep them: dim, bright, saturated and beyond the gamut.
Image<glm::vec3> pageColours(std::uint64_t seed) {
  Image<glm::vec3> picture(kAcross, kDown);
  Random random(seed);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double light = std::exp2(random.between(-12, 6));
    for (int c = 0; c < 3; ++c) {
      const auto value = static_cast<float>(light * random.between(i % 5 == 0 ? -0.2 : 0.0, 1.0));
      const int steps = std::max(std::ilogb(value == 0.0f ? 1.0f : value), -14) - 10;
      picture[i][c] = std::scalbn(std::round(std::scalbn(value, -steps)), steps);
    }
  }
  return picture;
}

void writeColours(const std::string& path, const Image<glm::vec3>& colours, const NamedSpace* space) {
  std::vector<std::pair<std::string, Image<float>>> channels;
  for (int c = 0; c < 3; ++c) {
    Image<float> plane(kAcross, kDown);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = colours[i][c];
    channels.emplace_back(std::string(1, "RGB"[c]), plane);
  }
  channels.emplace_back("Z", Image<float>(kAcross, kDown, 10.0f));
  writeLayers(path, {0, 0, kAcross, kDown}, {0, 0, kAcross, kDown}, {{"", channels}}, {}, nullptr, false, nullptr,
              space ? numbersOf(space->chromaticities) : std::vector<float>());
}

// A config with a table of one and of three dimensions in files of its own, and a look.
std::string configWithTables(const std::string& folder) {
  std::ofstream one(folder + "/curve.spi1d");
  one << "Version 1\nFrom -0.125 4.0\nLength 512\nComponents 1\n{\n";
  for (int i = 0; i < 512; ++i) one << std::pow(std::max(0.0, -0.125 + 4.125 * i / 511) / 4, 0.45) << "\n";
  one << "}\n";
  std::ofstream three(folder + "/cube.spi3d");
  three << "SPILUT 1.0\n3 3\n9 9 9\n";
  for (int r = 0; r < 9; ++r)
    for (int g = 0; g < 9; ++g)
      for (int b = 0; b < 9; ++b)
        three << r << " " << g << " " << b << " " << 0.7 * r / 8 + 0.3 * g / 8 << " " << std::sqrt(g / 8.0) << " "
              << 0.5 * b / 8 + 0.5 * r * g / 64.0 << "\n";
  std::ofstream(folder + "/own.ocio") << R"(ocio_profile_version: 2
search_path: .
roles: {aces_interchange: reference, default: reference, scene_linear: reference}
displays:
  screen:
    - !<View> {name: curve, colorspace: curved}
    - !<View> {name: cube, colorspace: cubed}
    - !<View> {name: dimmed, colorspace: curved, looks: dim}
looks:
  - !<Look> {name: dim, process_space: reference, transform: !<CDLTransform> {slope: [0.5, 0.4, 0.3], power: [1.2, 1, 1]}}
colorspaces:
  - !<ColorSpace> {name: reference}
  - !<ColorSpace> {name: curved, from_scene_reference: !<FileTransform> {src: curve.spi1d, interpolation: linear}}
  - !<ColorSpace>
    name: cubed
    from_scene_reference: !<GroupTransform>
      children:
        - !<FileTransform> {src: curve.spi1d, interpolation: linear}
        - !<FileTransform> {src: cube.spi3d, interpolation: tetrahedral}
)";
  return folder + "/own.ocio";
}

struct ShownCase {
  const char *config, *view, *look;
  double exposure;
  const char* space;
};

class PageDisplay : public ::testing::TestWithParam<ShownCase> {};

TEST_P(PageDisplay, IsTheLibrarysOwnToOneStepOf255) {
  const ShownCase& one = GetParam();
  const std::string folder = freshFolder("page-display");
  const bool own = *one.config != '\0';
  const std::string path = own ? configWithTables(folder) : "";
  const Image<glm::vec3> colours[] = {pageColours(1), pageColours(2)};
  writeColours(folder + "/a.exr", colours[0], namedSpace(one.space));
  writeColours(folder + "/b.exr", colours[1], nullptr);
  std::vector<std::string> command{"compare",
                                   "a.exr",
                                   "b.exr",
                                   "--metadata",
                                   "ignore",
                                   "--html",
                                   "page.html",
                                   "--view-transform",
                                   one.view,
                                   "--exposure",
                                   std::to_string(one.exposure)};
  if (own) command.insert(command.end(), {"--ocio", path});
  if (*one.look) command.insert(command.end(), {"--look", one.look});
  RunOptions options;
  options.folder = folder;
  const Ended ended = runProgram(command, options);
  ASSERT_EQ(ended.code, 1) << ended.err;
  if (!haveBrowser()) GTEST_SKIP() << "no chromium (apt package chromium)";
  const json out = probePage(folder, folder + "/page.html", R"JS(
  out.names = pellucid.data.pictures.map(p => p.name);
  out.programs = pellucid.programs.map(p => !!p);
  out.shown = pellucid.data.pictures.map((p, i) => {
    const pixels = pellucid.exposed(i).getContext('2d').getImageData(0, 0, p.width, p.height).data;
    return Array.from(pixels).filter((v, k) => k % 4 < 3);
  });
  out.said = find('shownby').textContent;)JS");
  ASSERT_FALSE(out.contains("error")) << out;
  ASSERT_EQ(out["programs"], json({true, true})) << out["said"];
  EXPECT_NE(out["said"].get<std::string>().find(std::string("view ") + one.view), std::string::npos) << out["said"];
  const ColourConfig config = own ? ColourConfig::read(path, "--ocio") : ColourConfig::builtIn();
  double worst = 0;
  for (std::size_t picture = 0; picture < 2; ++picture) {
    ASSERT_EQ(out["names"][picture], std::string(picture == 0 ? "A " : "B "));
    const char* space = picture == 0 ? one.space : own ? "ACES2065-1" : "Linear Rec.709 (sRGB)";
    Image<glm::vec3> right = colours[picture];
    DisplayTransform(config, {"", one.view, one.exposure, one.look}, *spaceOf(namedSpace(space)->chromaticities))
        .apply(right);
    for (std::size_t i = 0; i < right.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(out["shown"][picture][3 * i + static_cast<std::size_t>(c)].get<double>() -
                                         255.0 * static_cast<double>(right[i][c])));
  }
  std::printf("[ figure ] view %s, %s, exposure %g: %.2f steps of 255 from the CPU at worst\n", one.view, one.space,
              one.exposure, worst);
  EXPECT_LE(worst, 1.0);
}

INSTANTIATE_TEST_SUITE_P(
    All, PageDisplay,
    ::testing::Values(ShownCase{"", "sRGB", "", 0, "Linear Rec.709 (sRGB)"}, ShownCase{"", "sRGB", "", -2, "ACEScg"},
                      ShownCase{"", "ACES SDR", "", 0, "ACES2065-1"},
                      ShownCase{"", "ACES SDR", "", 1.5, "Linear Rec.2020"},
                      ShownCase{"", "raw", "", 0, "Linear P3-D65"}, ShownCase{"own", "curve", "", 0, "ACEScg"},
                      ShownCase{"own", "cube", "", 0, "ACES2065-1"}, ShownCase{"own", "dimmed", "", 1, "ACEScg"},
                      ShownCase{"own", "curve", "dim", -1, "Linear Rec.709 (sRGB)"}));

}  // namespace
}  // namespace pellucid
