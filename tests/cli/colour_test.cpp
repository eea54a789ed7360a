// Pictures in other linear spaces: the glTF's colours come into them, and everything that is said and refused.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "gbuffer/colour_space.h"
#include "gbuffer/exr_document.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;
using nlohmann::json;

constexpr int kSize = 16;
const glm::vec3 kBehind{.2f, .4f, .6f};

glm::dmat3 matrixOf(const NamedSpace& row) {
  return spaceOf(row.chromaticities)->fromRec709;
}

class Colours : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder =
        freshFolder(std::string("colour-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  std::string at(const std::string& name) const { return options.folder + "/" + name; }
  void picture(const std::string& name, const glm::vec3& colour, const NamedSpace* space = nullptr) const {
    const auto plane = [](float value) { return Image<float>(kSize, kSize, value); };
    const std::vector<ExtraLayer> layers{
        {"", {{"R", plane(colour.r)}, {"G", plane(colour.g)}, {"B", plane(colour.b)}, {"Z", plane(10)}}}};
    writeLayers(at(name), {0, 0, kSize, kSize}, {0, 0, kSize, kSize}, layers, {}, nullptr, false, nullptr,
                space ? numbersOf(space->chromaticities) : std::vector<float>());
  }
  void card(const std::string& name, const json& material, const GlbOptions& more = {}) const {
    writeGlb(at(name), {Quad{{-9, -9, -3}, {18, 0, 0}, {0, 18, 0}, material}}, more);
  }
  Ended run(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  Ended composite(const std::string& opaque, const std::vector<std::string>& more = {}) const {
    return run(
        {"composite", opaque, "card.glb", "-o", "out.exr", "--aa", "1", "--method", "over", "--environment", "0,0,0"},
        more);
  }
  glm::vec3 middle(const std::string& name = "out.exr") const {
    const ExrDocument out = readExr(at(name));
    glm::vec3 colour;
    for (int c = 0; c < 3; ++c)
      colour[c] = out.parts[0].find(std::string(1, "RGB"[c]))->at(kSize * kSize / 2 + kSize / 2);
    return colour;
  }
  // The card over the picture in every built-in space.
  template <class Expected>
  void expectInEverySpace(const glm::vec3& behind, double slack, Expected expected) {
    for (const NamedSpace& row : namedSpaces()) {
      picture("shot.exr", behind, &row);
      const Ended ended = composite("shot.exr");
      ASSERT_EQ(ended.code, 0) << ended.err;
      EXPECT_NE(ended.err.find(std::string("colours in ") + row.name + " by chromaticities"), std::string::npos)
          << ended.err;
      const glm::vec3 found = middle();
      const glm::dvec3 right = expected(matrixOf(row));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(found[c]), right[c], slack) << row.name << ", channel " << c;
    }
  }
  RunOptions options;
};

json lamp(const json& colour) {
  return {
      {"extensionsUsed", {"KHR_lights_punctual"}},
      {"extensions",
       {{"KHR_lights_punctual", {{"lights", {{{"type", "directional"}, {"color", colour}, {"intensity", 683}}}}}}}}};
}

GlbOptions lit(const json& colour) {
  GlbOptions more;
  more.extra = lamp(colour);
  more.nodes = json::array({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
  return more;
}

json matte(const json& colour) {
  return {{"alphaMode", "BLEND"},
          {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

json filter(const json& colour) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0}, {"roughnessFactor", 0}}},
          {"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1}}}}}};
}

TEST_F(Colours, ARedCard) {
  card("card.glb", unlit(1, 0, 0, .5f));
  expectInEverySpace(kBehind, 1e-6, [](const glm::dmat3& m) { return .5 * m[0] + .5 * glm::dvec3(kBehind); });
  picture("shot.exr", kBehind, namedSpace("ACEScg"));
  card("card.glb", unlit(1, 0, 0, 1));
  ASSERT_EQ(composite("shot.exr").code, 0);
  EXPECT_NEAR(middle().r, .6131f, 5e-5f);
  EXPECT_NEAR(middle().g, .0702f, 5e-5f);
  EXPECT_NEAR(middle().b, .0206f, 5e-5f);
}

TEST_F(Colours, ASaturatedFilter) {
  card("card.glb", filter({.02, .9, .05, 1}));
  expectInEverySpace(kBehind, 1e-6,
                     [](const glm::dmat3& m) { return (m * glm::dvec3(.02, .9, .05)) * glm::dvec3(kBehind); });
  card("card.glb", filter({.3, .3, .3, 1}));
  expectInEverySpace(kBehind, 1e-6, [](const glm::dmat3&) { return .3 * glm::dvec3(kBehind); });
}

TEST_F(Colours, ALamp) {
  card("card.glb", matte({1, 1, 1, 1}), lit({1, .5, .1}));
  expectInEverySpace(kBehind, 1e-6, [](const glm::dmat3& m) { return m * glm::dvec3(1, .5, .1) / M_PI; });
}

TEST_F(Colours, AGreySceneIsTheSameInEverySpace) {
  std::vector<Quad> quads;
  for (int i = 0; i < 3; ++i) {
    json glass = filter({.7, .7, .7, 1});
    glass["pbrMetallicRoughness"]["roughnessFactor"] = .2;
    glass["extensions"]["KHR_materials_ior"]["ior"] = 1.5;
    const auto z = -3.0f - static_cast<float>(i);
    quads.push_back(Quad{{-9, -9, z}, {18, 0, 1}, {0, 18, 0}, i == 1 ? matte({.5, .5, .5, .4}) : glass});
  }
  writeGlb(at("card.glb"), quads, lit({1, 1, 1}));
  picture("sky.exr", glm::vec3(.3f));
  glm::vec3 first(0.0f);
  for (const NamedSpace& row : namedSpaces()) {
    picture("shot.exr", glm::vec3(.45f), &row);
    const Ended ended = run({"composite", "shot.exr", "card.glb", "-o", "out.exr", "--environment", "sky.exr"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    if (&row == &namedSpaces()[0]) first = middle();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle()[c], first[c], 1e-5f) << row.name;
  }
  EXPECT_GT(first.r, 0.0f);
}

TEST_F(Colours, AnEnvironmentIsOfItsOwnSpace) {
  card("card.glb", matte({1, 1, 1, 1}));
  picture("sky.exr", {.9f, .3f, .1f});
  const NamedSpace& aces = *namedSpace("ACEScg");
  picture("aces-sky.exr", glm::vec3(matrixOf(aces) * glm::dvec3(.9, .3, .1)), &aces);
  const auto over = [&](const NamedSpace* space, const char* sky) {
    picture("shot.exr", kBehind, space);
    EXPECT_EQ(run({"composite", "shot.exr", "card.glb", "-o", "out.exr", "--aa", "1", "--environment", sky}).code, 0);
    return middle();
  };
  const glm::vec3 plain = over(nullptr, "sky.exr"), wide = over(&aces, "sky.exr");
  const glm::vec3 expected(matrixOf(aces) * glm::dvec3(plain)), own = over(&aces, "aces-sky.exr"),
                                                                back = over(nullptr, "aces-sky.exr");
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(wide[c], expected[c], 1e-5f);
    EXPECT_NEAR(own[c], expected[c], 1e-5f);
    EXPECT_NEAR(back[c], plain[c], 1e-5f);
  }
}

TEST_F(Colours, Rec709KeepsEveryBit) {
  card("card.glb", matte({.8, .3, .1, .5}), lit({1, .5, .1}));
  picture("plain.exr", kBehind);
  picture("stated.exr", kBehind, &namedSpaces()[0]);
  ASSERT_EQ(composite("plain.exr").code, 0);
  const ExrDocument plain = readExr(at("out.exr"));
  ASSERT_EQ(composite("stated.exr").code, 0);
  const ExrDocument stated = readExr(at("out.exr"));
  for (const ExrChannel& channel : plain.parts[0].channels)
    EXPECT_EQ(channel.bytes, stated.parts[0].find(channel.name)->bytes) << channel.name;
  EXPECT_FALSE(plain.parts[0].attributes.contains("chromaticities"));
  EXPECT_FALSE(plain.parts[0].attributes.contains("pellucid:workingSpace"));
  EXPECT_TRUE(stated.parts[0].attributes.contains("chromaticities"));
}

TEST_F(Colours, TheSpaceIsSaidAndKept) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("plain.exr", kBehind);
  const Ended plain = composite("plain.exr", {"--json"});
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_NE(plain.err.find("colours in Linear Rec.709 (sRGB), as nothing says otherwise (--working-space NAME would)"),
            std::string::npos)
      << plain.err;
  EXPECT_EQ(json::parse(plain.out)["colourSpace"]["by"], "nothing");
  const Ended asked = composite("plain.exr", {"--json", "--working-space", "lin_ap1"});
  ASSERT_EQ(asked.code, 0) << asked.err;
  EXPECT_EQ(json::parse(asked.out)["colourSpace"]["name"], "ACEScg");
  EXPECT_NEAR(middle().r, .5f * .613097f + .1f, 1e-6f);
  EXPECT_EQ(readExr(at("out.exr")).parts[0].text("pellucid:workingSpace").value_or(""), "ACEScg");
  picture("aces.exr", kBehind, namedSpace("ACEScg"));
  ASSERT_EQ(composite("aces.exr").code, 0);
  EXPECT_EQ(readExr(at("out.exr")).parts[0].attributes.at("chromaticities"),
            readExr(at("aces.exr")).parts[0].attributes.at("chromaticities"));
  const Ended seen = run({"inspect", "aces.exr", "--json"});
  EXPECT_EQ(json::parse(seen.out)["colourSpace"]["name"], "ACEScg");
}

TEST_F(Colours, ConfigsOnTheCommandLine) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("plain.exr", kBehind);
  picture("plate_1.exr", kBehind);
  std::ofstream(at("own.ocio")) << R"(ocio_profile_version: 2
roles: {aces_interchange: reference, default: reference, scene_linear: working}
file_rules:
  - !<Rule> {name: plates, extension: exr, pattern: "*plate*", colorspace: working}
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: raw, colorspace: log}
colorspaces:
  - !<ColorSpace> {name: reference}
  - !<ColorSpace> {name: working, to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}}
  - !<ColorSpace> {name: log, to_scene_reference: !<BuiltinTransform> {style: ACEScct_to_ACES2065-1}}
)";
  const auto red = [&](const Ended& ended) {
    EXPECT_EQ(ended.code, 0) << ended.err;
    return (middle().r - .1f) / .5f;
  };
  EXPECT_NEAR(red(composite("plain.exr", {"--ocio", "own.ocio", "--working-space", "scene_linear"})), .613097f, 2e-6f);
  EXPECT_NEAR(red(composite("plate_1.exr", {"--ocio", "own.ocio"})), .613097f, 2e-6f);
  EXPECT_NEAR(red(composite("plain.exr", {"--ocio", "own.ocio"})), .439632f, 3e-6f) << "by the rule for all others";
  RunOptions own = options;
  options.environment = {"OCIO=" + at("own.ocio")};
  EXPECT_NEAR(red(composite("plate_1.exr")), .613097f, 2e-6f);
  EXPECT_NEAR(red(composite("plain.exr", {"--working-space", "working"})), .613097f, 2e-6f);
  picture("plain.exr", kBehind, namedSpace("Linear Rec.2020"));
  EXPECT_NEAR(red(composite("plain.exr")), .627404f, 2e-6f) << "chromaticities come first";
  const Ended log = composite("plain.exr", {"--working-space", "log"});
  EXPECT_EQ(log.code, 2) << log.err;
  EXPECT_NE(log.err.find("expected a linear RGB space"), std::string::npos) << log.err;
  options = own;
}

TEST_F(Colours, WhatIsRefused) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("plain.exr", kBehind);
  const Ended unknown = composite("absent.exr", {"--working-space", "sepia"});
  EXPECT_EQ(unknown.code, 2) << "before any file is opened";
  EXPECT_NE(unknown.err.find("--working-space: found 'sepia', expected auto, Linear Rec.709"), std::string::npos)
      << unknown.err;
  EXPECT_EQ(composite("plain.exr", {"--ocio", "absent.ocio"}).code, 3);
  std::ofstream(at("broken.ocio")) << "ocio_profile_version: [2\n";
  const Ended broken = composite("plain.exr", {"--ocio", "broken.ocio"});
  EXPECT_EQ(broken.code, 3);
  EXPECT_NE(broken.err.find("broken.ocio: --ocio: found no valid OpenColorIO config"), std::string::npos) << broken.err;
  options.environment = {"OCIO=" + at("broken.ocio")};
  const Ended variable = composite("plain.exr");
  EXPECT_EQ(variable.code, 3);
  EXPECT_NE(variable.err.find("$OCIO"), std::string::npos) << variable.err;
}

TEST_F(Colours, PlanesOfAnotherSpaceAreRefused) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("plain.exr", kBehind);
  picture("aces.exr", kBehind, namedSpace("ACEScg"));
  const auto accumulate = [&](const char* opaque, const char* planes, const std::vector<std::string>& more = {}) {
    const Ended ended = run({"accumulate", opaque, "card.glb", "-o", planes}, more);
    ASSERT_EQ(ended.code, 0) << ended.err;
  };
  accumulate("aces.exr", "aces-planes.exr");
  accumulate("plain.exr", "plain-planes.exr");
  accumulate("plain.exr", "asked-planes.exr", {"--working-space", "ACEScg"});
  const auto resolve = [&](const char* opaque, const std::vector<std::string>& planes) {
    return run({"resolve", opaque}, [&] {
      std::vector<std::string> rest = planes;
      rest.insert(rest.end(), {"-o", "resolved.exr"});
      return rest;
    }());
  };
  EXPECT_EQ(resolve("aces.exr", {"aces-planes.exr"}).code, 0);
  EXPECT_NEAR(middle("resolved.exr").r, .5f * .613097f + .1f, 1e-6f);
  EXPECT_EQ(resolve("plain.exr", {"asked-planes.exr"}).code, 0) << "--working-space overrules here too";
  EXPECT_NEAR(middle("resolved.exr").r, .5f * .613097f + .1f, 1e-6f);
  for (const auto& [opaque, planes] : {std::pair("plain.exr", "aces-planes.exr"), {"aces.exr", "plain-planes.exr"}}) {
    const Ended ended = resolve(opaque, {planes});
    EXPECT_EQ(ended.code, 4);
    EXPECT_NE(ended.err.find("colour space: found"), std::string::npos) << ended.err;
  }
  EXPECT_EQ(resolve("aces.exr", {"aces-planes.exr", "plain-planes.exr"}).code, 4);
  const Ended held = run({"accumulate", "aces.exr", "card.glb", "-o", "held.exr", "--held-out-by", "plain-planes.exr"});
  EXPECT_EQ(held.code, 4) << held.err;
}

TEST_F(Colours, DeepFilesAreOfTheirOwnSpace) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("plain.exr", kBehind);
  picture("aces.exr", kBehind, namedSpace("ACEScg"));
  ASSERT_EQ(run({"fragments", "aces.exr", "card.glb", "-o", "deep.exr"}).code, 0);
  const auto over = [&](const char* opaque) {
    EXPECT_EQ(run({"composite", opaque, "deep.exr", "-o", "out.exr", "--aa", "1", "--method", "over"}).code, 0);
    return middle();
  };
  EXPECT_NEAR(over("aces.exr").g, .5f * .070194f + .2f, 1e-6f);
  EXPECT_NEAR(over("plain.exr").r, .5f + .1f, 1e-6f);
  EXPECT_NEAR(over("plain.exr").g, .2f, 1e-6f);
}

TEST_F(Colours, Previews) {
  card("card.glb", unlit(1, 0, 0, .5f));
  picture("aces.exr", kBehind, namedSpace("ACEScg"));
  const Ended ended = composite("aces.exr", {"--preview", "shown.png", "--exposure", "1", "--view-transform", "raw"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("shown.png: display sRGB, view raw, exposure 1"), std::string::npos) << ended.err;
  EXPECT_EQ(slurp(at("shown.png")).substr(1, 3), "PNG");
  EXPECT_EQ(run({"gbuffer", "card.glb", "-o", "g.exr", "--size", "8x8", "--preview", "g.png"}).code, 0);
  EXPECT_EQ(slurp(at("g.png")).substr(1, 3), "PNG");
  for (const std::vector<std::string>& bad :
       std::vector<std::vector<std::string>>{{"--exposure", "1"},
                                             {"--display", "sRGB"},
                                             {"--preview", "shown.exr"},
                                             {"--preview", "shown.png", "--display", "cinema"},
                                             {"--preview", "shown.png", "--view-transform", "film"}})
    EXPECT_EQ(composite("absent.exr", bad).code, 2) << bad[0];
  EXPECT_EQ(run({"resolve", "absent.exr", "p.exr", "-o", "o.exr", "--ocio", "x.ocio"}).code, 2);
}

TEST_F(Colours, RenderedInAnotherSpace) {
  json wall = matte({1, 0, 0, 1});
  wall["alphaMode"] = "OPAQUE";
  card("card.glb", wall);
  const auto render = [&](const std::vector<std::string>& more) {
    return run({"gbuffer", "card.glb", "-o", "shot.exr", "--size", "16x16", "--environment", "1,1,1"}, more);
  };
  ASSERT_EQ(render({}).code, 0);
  const float plain = middle("shot.exr").r;
  EXPECT_FALSE(readExr(at("shot.exr")).parts[0].attributes.contains("chromaticities"));
  const Ended ended = render({"--working-space", "ACEScg", "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(json::parse(ended.out)["colourSpace"]["name"], "ACEScg");
  EXPECT_NEAR(middle("shot.exr").r, .613097f * plain, 1e-4f) << "of 16 random samples";
  EXPECT_NEAR(middle("shot.exr").g, .070194f * plain, 1e-4f);
  card("card.glb", unlit(0, 1, 0, .5f));
  const Ended onto = composite("shot.exr");
  EXPECT_NE(onto.err.find("colours in ACEScg by chromaticities"), std::string::npos) << onto.err;
  EXPECT_EQ(render({"--working-space", "sepia"}).code, 2);
}

}  // namespace
}  // namespace pellucid
