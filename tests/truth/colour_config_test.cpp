// Our spaces against OpenColorIO's own transforms, and its configs as files.
#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "composite/colour/config.h"
#include "gbuffer/errors.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

namespace ocio = OCIO_NAMESPACE;
using namespace test;

// The first matrix of a built-in transform: of displays, what stands before their curve.
glm::dmat3 matrixOf(const char* style, bool inverse = false) {
  ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  const ocio::GroupTransformRcPtr steps = ocio::Config::CreateRaw()->getProcessor(transform)->createGroupTransform();
  double rows[16] = {};
  for (int i = 0; i < steps->getNumTransforms(); ++i)
    if (const auto step = OCIO_DYNAMIC_POINTER_CAST<ocio::MatrixTransform>(steps->getTransform(i))) {
      step->getMatrix(rows);
      break;
    }
  glm::dmat3 matrix;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) matrix[c][r] = rows[4 * r + c];
  return inverse ? glm::inverse(matrix) : matrix;
}

struct Expected {
  const char* name;
  glm::dmat3 fromRec709;
};

std::vector<Expected> byOpenColorIO() {
  const glm::dmat3 ap1 = matrixOf("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", true);
  const glm::dmat3 ap0 = matrixOf("ACEScg_to_ACES2065-1") * ap1;
  const glm::dmat3 xyz = matrixOf("UTILITY - ACES-AP1_to_CIE-XYZ-D65_BFD") * ap1;
  return {{"Linear Rec.709 (sRGB)", matrixOf("DISPLAY - CIE-XYZ-D65_to_sRGB") * xyz},
          {"ACEScg", ap1},
          {"ACES2065-1", ap0},
          {"Linear Rec.2020", matrixOf("DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.2020") * xyz},
          {"Linear P3-D65", matrixOf("DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65") * xyz}};
}

// A red, a grey, a saturated filter and a lamp.
const glm::vec3 kColours[] = {{1, 0, 0}, {.18f, .18f, .18f}, {.02f, .9f, .05f}, {12, 9, 3}};

double largestError(const glm::dmat3& ours, const glm::dmat3& theirs) {
  double largest = 0;
  for (const glm::vec3& colour : kColours) {
    const glm::dvec3 off = glm::abs(glm::dvec3(converted(ours, colour)) - theirs * glm::dvec3(colour));
    largest = std::max({largest, off.x, off.y, off.z});
  }
  return largest / 12;  // of the brightest
}

TEST(ColourConfig, BuiltInSpacesAreOpenColorIOs) {
  const ColourConfig config = ColourConfig::builtIn();
  for (const Expected& row : byOpenColorIO()) {
    const double table = largestError(spaceOf(namedSpace(row.name)->chromaticities)->fromRec709, row.fromRec709);
    const double library = largestError(config.space(row.name).fromRec709, row.fromRec709);
    std::printf("%-24s %.2g from OpenColorIO's transforms, as a config %.2g\n", row.name, table, library);
    EXPECT_LT(table, 1e-6) << row.name;
    EXPECT_LT(library, 1e-6) << row.name;
  }
}

class ConfigFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder =
        freshFolder(std::string("truth-config-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  std::string write(const std::string& text) const {
    std::ofstream(folder + "/config.ocio") << text;
    return folder + "/config.ocio";
  }
  std::string folder;
};

// A reference of ACES2065-1, a camera's log space, a role, data, and a rule for names of files.
const char* const kOwn = R"(ocio_profile_version: 2
roles:
  aces_interchange: reference
  default: reference
  scene_linear: working
file_rules:
  - !<Rule> {name: plates, extension: exr, pattern: "*plate*", colorspace: working}
  - !<Rule> {name: logs, extension: exr, pattern: "*log*", colorspace: camera}
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: raw, colorspace: data}
colorspaces:
  - !<ColorSpace>
    name: reference
  - !<ColorSpace>
    name: working
    aliases: [house_linear]
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: camera
    to_scene_reference: !<BuiltinTransform> {style: ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1}
  - !<ColorSpace>
    name: half
    to_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: data
    isdata: true
)";

TEST_F(ConfigFile, OfOurOwn) {
  const ColourConfig config = ColourConfig::read(write(kOwn), "--ocio");
  const glm::dmat3 ap1 = byOpenColorIO()[1].fromRec709;
  for (const char* name : {"working", "house_linear", "scene_linear"}) {
    EXPECT_EQ(config.space(name).name, "working") << name;
    EXPECT_LT(largestError(config.space(name).fromRec709, ap1), 1e-6) << name;
  }
  const std::optional<ColourSpace> plate = config.spaceOfFile("shots/plate_01.exr");
  ASSERT_TRUE(plate);
  EXPECT_EQ(plate->name, "working");
  EXPECT_EQ(plate->source, SpaceSource::fileRule);
  const std::optional<ColourSpace> other = config.spaceOfFile("beauty.exr");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->name, "reference");
  EXPECT_EQ(other->source, SpaceSource::defaultRule);
  EXPECT_FALSE(config.spaceOfFile("a_log.exr")) << "a picture in a log space is not linear";
}

std::string refused(const std::function<void()>& work, int& code) {
  code = 0;
  try {
    work();
  } catch (const Error& error) {
    code = error.exitCode();
    return error.what();
  }
  return "";
}

TEST_F(ConfigFile, WhatIsRefused) {
  int code = 0;
  const ColourConfig config = ColourConfig::read(write(kOwn), "--ocio");
  for (const char* name : {"sepia", "camera", "data", "half"}) {
    const std::string said = refused([&] { config.space(name); }, code);
    EXPECT_EQ(code, 2) << said;
    EXPECT_NE(said.find(name), std::string::npos) << said;
    EXPECT_NE(said.find("expected"), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
  const std::string broken[] = {folder + "/absent.ocio", folder};
  for (const std::string& path : broken) {
    const std::string said = refused([&] { ColourConfig::read(path, "$OCIO"); }, code);
    EXPECT_EQ(code, 3) << said;
    EXPECT_NE(said.find("$OCIO"), std::string::npos) << said;
  }
  const std::string own = kOwn;
  for (const std::string& text :
       {std::string(), std::string("nonsense"), own.substr(0, own.size() / 2),
        "ocio_profile_version: 9\n" + own.substr(own.find('\n') + 1),
        own.substr(0, own.find("scene_linear")) + "scene_linear: nowhere\n" + own.substr(own.find("file_rules"))}) {
    const std::string said = refused([&] { ColourConfig::read(write(text), "--ocio"); }, code);
    EXPECT_EQ(code, 3) << text << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST_F(ConfigFile, WithoutTheRoleAKnownNameTells) {
  std::string text = kOwn;
  text.erase(text.find("  aces_interchange"), std::string("  aces_interchange: reference\n").size());
  int code = 0;
  const ColourConfig mute = ColourConfig::read(write(text), "--ocio");
  const std::string said = refused([&] { mute.space("working"); }, code);
  EXPECT_EQ(code, 4) << said;
  EXPECT_NE(said.find("aces_interchange"), std::string::npos) << said;
  text.replace(text.find("[house_linear]"), 14, "[ACEScg]");
  const ColourConfig told = ColourConfig::read(write(text), "--ocio");
  EXPECT_LT(largestError(told.space("reference").fromRec709, byOpenColorIO()[2].fromRec709), 1e-6);
}

// A config names its neighbours alone: by dots, by an absolute path, by links to files and folders it leads nowhere
// else, unless the folder is allowed.
TEST_F(ConfigFile, NamesOnlyFilesUnderItsFolder) {
  namespace fs = std::filesystem;
  const std::string own = folder + "/own", away = folder + "/away";
  fs::create_directories(own + "/luts");
  fs::create_directories(away);
  const char* const cube = "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
  for (const std::string& file : {own + "/luts/near.cube", away + "/secret.cube"}) std::ofstream(file) << cube;
  fs::create_symlink(away + "/secret.cube", own + "/luts/link.cube");
  fs::create_symlink(away, own + "/luts/door");
  fs::create_symlink(own + "/luts/near.cube", own + "/luts/inner.cube");
  const auto config = [&](const std::string& name, const std::string& place) {
    const std::string path = own + "/config.ocio";
    const std::string file = "!<GroupTransform> {children: [!<FileTransform> {src: " + name + "}]}";
    std::ofstream(path)
        << "ocio_profile_version: 2\nsearch_path: luts\nroles:\n  default: lin\ndisplays:\n  d:\n"
           "    - !<View> {name: v, colorspace: lin}\n"
        << (place == "look" ? "looks:\n  - !<Look>\n    name: l\n    process_space: lin\n    transform: " + file + "\n"
                            : "")
        << (place == "view" ? "view_transforms:\n  - !<ViewTransform>\n    name: t\n"
                              "    from_scene_reference: " +
                                  file + "\n"
                            : "")
        << "colorspaces:\n  - !<ColorSpace>\n    name: lin\n"
        << (place == "space" ? "    from_scene_reference: " + file + "\n" : "")
        << (place == "named" ? "named_transforms:\n  - !<NamedTransform>\n    name: n\n    transform: " + file + "\n"
                             : "");
    return path;
  };
  for (const char* place : {"space", "look", "view", "named"}) {
    for (const std::string& name :
         {std::string("near.cube"), std::string("inner.cube"), std::string("../luts/near.cube")})
      EXPECT_NO_THROW(ColourConfig::read(config(name, place), "--ocio")) << place << " " << name;
    for (const std::string& name :
         {std::string("../../away/secret.cube"), away + "/secret.cube", std::string("link.cube"),
          std::string("door/secret.cube"), std::string("./../luts/../../away/secret.cube")}) {
      const std::string path = config(name, place);
      try {
        ColourConfig::read(path, "--ocio");
        FAIL() << place << " " << name;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("--asset-root"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("secret.cube"), std::string::npos) << error.what();
      }
      EXPECT_NO_THROW(ColourConfig::read(path, "--ocio", away)) << place << " " << name;
    }
  }
  EXPECT_THROW(ColourConfig::read(config("near.cube", "space"), "--ocio", folder + "/none"), InputError);
}

}  // namespace
}  // namespace pellucid
