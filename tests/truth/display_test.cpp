// What a display is shown: against IEC 61966-2-1 in double, and against OpenColorIO's own steps one by one.
#include "composite/colour/display.h"

#include <OpenColorIO/OpenColorIO.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "gbuffer/errors.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

namespace ocio = OCIO_NAMESPACE;
using namespace test;

ColourSpace spaceNamed(const char* name) {
  return *spaceOf(namedSpace(name)->chromaticities);
}

Image<glm::vec3> colours() {
  Image<glm::vec3> picture(16, 16);
  Random random(3);
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture[i] = glm::vec3(random.uniformf(), random.uniformf(), random.uniformf()) * 1.2f;
  return picture;
}

double encoded(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

TEST(Display, TheFirstViewIsSrgb) {
  const ColourConfig config = ColourConfig::builtIn();
  for (const char* name : {"Linear Rec.709 (sRGB)", "ACEScg", "Linear P3-D65"}) {
    const ColourSpace space = spaceNamed(name);
    const DisplayTransform transform(config, {"", "", -1.0}, space);
    EXPECT_EQ(transform.title(), "display sRGB, view sRGB, exposure -1");
    const Image<glm::vec3> linear = colours();
    Image<glm::vec3> shown = linear;
    transform.apply(shown);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const glm::dvec3 rec709 = glm::inverse(space.fromRec709) * (0.5 * glm::dvec3(linear[i]));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[i][c], encoded(rec709[c]), 2e-4) << name;
    }
  }
}

TEST(Display, AcesIsTheLibrarysOwn) {
  const ColourSpace space = spaceNamed("ACES2065-1");
  Image<glm::vec3> shown = colours();
  ocio::GroupTransformRcPtr steps = ocio::GroupTransform::Create();
  for (const char* style :
       {"ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0", "DISPLAY - CIE-XYZ-D65_to_sRGB"}) {
    ocio::BuiltinTransformRcPtr step = ocio::BuiltinTransform::Create();
    step->setStyle(style);
    steps->appendTransform(step);
  }
  const auto direct = ocio::Config::CreateRaw()->getProcessor(steps)->getDefaultCPUProcessor();
  Image<glm::vec3> expected = shown;
  for (std::size_t i = 0; i < expected.size(); ++i) direct->applyRGB(&expected[i].x);
  DisplayTransform(ColourConfig::builtIn(), {"sRGB", "ACES SDR", 0.0}, space).apply(shown);
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[i][c], std::clamp(expected[i][c], 0.0f, 1.0f), 1e-4f);
}

TEST(Display, RawShowsTheNumbers) {
  Image<glm::vec3> shown(2, 1);
  shown[0] = {.25f, .5f, 3};
  shown[1] = {std::numeric_limits<float>::quiet_NaN(), -1, std::numeric_limits<float>::infinity()};
  DisplayTransform(ColourConfig::builtIn(), {"sRGB", "raw", 0.0}, spaceNamed("ACEScg")).apply(shown);
  EXPECT_EQ(shown[0], glm::vec3(.25f, .5f, 1));
  EXPECT_EQ(shown[1], glm::vec3(0));
}

TEST(Display, WhatThereIsNotIsRefused) {
  const ColourConfig config = ColourConfig::builtIn();
  EXPECT_NO_THROW(checkDisplay(config, {}));
  for (const DisplayChoice& choice : {DisplayChoice{"cinema", "", 0}, DisplayChoice{"sRGB", "film", 0}}) {
    try {
      checkDisplay(config, choice);
      FAIL() << choice.display;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("expected one of sRGB"), std::string::npos) << error.what();
    }
  }
}

// A look stands in the place of the view's own, in its own space: here half the light.
TEST(Display, LooksTakeThePlaceOfTheViews) {
  const std::string path = freshFolder("truth-look") + "/config.ocio";
  std::ofstream(path) << R"(ocio_profile_version: 2
roles:
  aces_interchange: reference
  default: reference
  scene_linear: reference
displays:
  screen:
    - !<View> {name: plain, colorspace: reference}
    - !<View> {name: dim, colorspace: reference, looks: quarter}
    - !<View> {name: raw, colorspace: data}
looks:
  - !<Look>
    name: half
    process_space: reference
    transform: !<CDLTransform> {slope: [0.5, 0.5, 0.5]}
  - !<Look>
    name: quarter
    process_space: reference
    transform: !<CDLTransform> {slope: [0.25, 0.25, 0.25]}
colorspaces:
  - !<ColorSpace>
    name: reference
  - !<ColorSpace>
    name: data
    isdata: true
)";
  const ColourConfig config = ColourConfig::read(path, "--ocio");
  const ColourSpace space = spaceNamed("ACES2065-1");
  const struct {
    const char *view, *look;
    float factor;
  } rows[] = {{"plain", "", 1}, {"plain", "half", 0.5f}, {"dim", "", 0.25f}, {"dim", "half", 0.5f}};
  for (const auto& row : rows) {
    Image<glm::vec3> shown(1, 1, glm::vec3(0.2f, 0.4f, 0.8f));
    DisplayTransform(config, {"screen", row.view, 0.0, row.look}, space).apply(shown);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(shown[0][c], row.factor * glm::vec3(0.2f, 0.4f, 0.8f)[c], 1e-5f) << row.view << " " << row.look;
  }
  for (const DisplayChoice& choice :
       {DisplayChoice{"screen", "plain", 0.0, "third"}, DisplayChoice{"screen", "raw", 0.0, "half"}}) {
    try {
      checkDisplay(config, choice);
      FAIL() << choice.look;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("--look"), std::string::npos) << error.what();
    }
  }
}

TEST(Display, AsPng) {
  Image<glm::vec3> shown(3, 2);
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = glm::vec3(static_cast<float>(40 * i) / 255.0f, 0, 1);
  const std::string path = freshFolder("truth-display") + "/shown.png";
  writePng(path, shown);
  const auto in = OIIO::ImageInput::open(path);
  ASSERT_TRUE(in);
  std::vector<std::uint8_t> bytes(18);
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(bytes[3 * i], 40 * i);
  EXPECT_THROW(writePng("/nowhere/at/all.png", shown), ResourceError);
}

}  // namespace
}  // namespace pellucid
