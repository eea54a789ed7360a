// A scene's colours in the picture's space: each goes through the matrix once, and nothing else changes.
#include "engine_bridge/scene/working_space.h"

#include <OpenImageIO/imageio.h>

#include <cmath>

#include "engine_bridge/scene/triangle_source.h"
#include "gbuffer/colour_space.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

glm::dmat3 toSpace(const char* name) {
  return spaceOf(namedSpace(name)->chromaticities)->fromRec709;
}

const glm::vec3 kRedInAcescg{.613097f, .070194f, .020616f};

void expectNear(const glm::vec3& found, const glm::vec3& expected, const char* what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-6f) << what << ", channel " << c;
}

std::vector<std::uint8_t> image(const std::string& extension, OIIO::TypeDesc type, const std::vector<float>& pixel,
                                const std::vector<float>& chromaticities = {}) {
  const std::string path = (testFolder() / ("made." + extension)).string();
  OIIO::ImageSpec spec(1, 1, 3, type);
  if (!chromaticities.empty())
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities.data());
  const auto writer = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(writer && writer->open(path, spec) && writer->write_image(OIIO::TypeDesc::FLOAT, pixel.data()) &&
              writer->close());
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Everything that has a colour, in red, and the same image as colour and as data.
Builder colourful(const std::vector<std::uint8_t>& bytes) {
  Builder builder;
  Json& primitive =
      builder.mesh({{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)},
                    {"COLOR_0", builder.floats({1, 0, 0, .5f, .2f, .2f, .2f, 1, 0, 1, 0, 1}, "VEC4", 4)}});
  primitive["material"] = 0;
  builder.json["materials"] = Json::array(
      {{{"name", "all"},
        {"alphaMode", "BLEND"},
        {"emissiveFactor", {1, 0, 0}},
        {"emissiveTexture", {{"index", 0}}},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1, 0, 0, .25}}, {"metallicRoughnessTexture", {{"index", 0}}}, {"metallicFactor", .5}}},
        {"extensions",
         {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}},
          {"KHR_materials_transmission", {{"transmissionFactor", .5}}},
          {"KHR_materials_specular", {{"specularColorFactor", {2, 0, 0}}}},
          {"KHR_materials_volume",
           {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0, 0}}}}}}}});
  builder.json["images"] = Json::array({{{"bufferView", builder.view(bytes.data(), bytes.size())}}});
  builder.json["textures"] = Json::array({{{"source", 0}}});
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::array({{{"name", "lamp"}, {"type", "point"}, {"color", {1, 0, 0}}, {"intensity", 683}}});
  builder.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return builder;
}

TEST(WorkingSpace, EveryColourGoesThroughOnce) {
  Scene scene = colourful(image("png", OIIO::TypeDesc::UINT8, {1, 0, 0})).load();
  scene.instances.at(0).colour = {1, 0, 0, .75f};
  EXPECT_TRUE(bringInto(scene, toSpace("ACEScg")).empty());
  const Material& material = scene.materials.at(0);
  expectNear(glm::vec3(material.baseColor), kRedInAcescg, "base colour");
  EXPECT_EQ(material.baseColor.a, .25f);
  expectNear(material.emission / 10.0f, kRedInAcescg, "emission");
  expectNear(material.specularColor / 2.0f, kRedInAcescg, "specular");
  expectNear(material.attenuationColor, kRedInAcescg, "attenuation");
  EXPECT_EQ(material.metallic, .5f);
  expectNear(scene.lights.at(0).colour, kRedInAcescg, "lamp");
  EXPECT_EQ(scene.lights.at(0).intensity, 1.0f);
  expectNear(glm::vec3(scene.instances.at(0).colour), kRedInAcescg, "instance");
  EXPECT_EQ(scene.instances.at(0).colour.a, .75f);
  const std::vector<Vertex>& vertices = scene.primitives.at(0).vertices;
  expectNear(glm::vec3(vertices.at(0).colour), kRedInAcescg, "vertex");
  EXPECT_EQ(vertices.at(0).colour.a, .5f);
  EXPECT_EQ(vertices.at(1).colour, glm::vec4(.2f, .2f, .2f, 1)) << "greys keep their bits";
  const Texture& colour = scene.textures.at(static_cast<std::size_t>(material.emissiveTexture.texture));
  const Texture& data = scene.textures.at(static_cast<std::size_t>(material.metallicRoughnessTexture.texture));
  expectNear(glm::vec3(colour.texels[0]), kRedInAcescg, "texel of a colour");
  EXPECT_EQ(data.texels[0], glm::vec4(1, 0, 0, 1)) << "texel of data";
}

TEST(WorkingSpace, TheIdentityChangesNoBit) {
  Builder builder = colourful(image("png", OIIO::TypeDesc::UINT8, {1, .5f, .1f}));
  const Scene before = builder.load();
  Scene scene = before;
  EXPECT_TRUE(bringInto(scene, glm::dmat3(1.0)).empty());
  EXPECT_EQ(scene.materials.at(0).baseColor, before.materials.at(0).baseColor);
  EXPECT_EQ(scene.textures.at(0).texels[0], before.textures.at(0).texels[0]);
  EXPECT_EQ(scene.primitives.at(0).vertices.at(0).colour, before.primitives.at(0).vertices.at(0).colour);
}

TEST(WorkingSpace, TrianglesThatStayInTheirFileAreTheSame) {
  Builder builder = colourful(image("png", OIIO::TypeDesc::UINT8, {1, 0, 0}));
  SceneOptions streaming;
  streaming.streamBytes = 1 << 16;
  Scene streamed = builder.load(streaming), decoded = builder.load();
  for (Scene* scene : {&streamed, &decoded}) bringInto(*scene, toSpace("Linear Rec.2020"));
  ASSERT_TRUE(streamed.primitives.at(0).streamed);
  const Scene found = decodedScene(streamed);
  const auto &a = found.primitives.at(0).vertices, &b = decoded.primitives.at(0).vertices;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].colour, b[i].colour);
    const ColourRange range = coloursOf(streamed.primitives[0]);
    for (int c = 0; c < 4; ++c) {
      EXPECT_LE(range.least[c], a[i].colour[c]);
      EXPECT_GE(range.most[c], a[i].colour[c]);
    }
  }
}

TEST(WorkingSpace, AFloatTextureIsOfItsOwnSpace) {
  // A green of ACEScg that linear Rec.709 cannot hold.
  const std::vector<float> aces = numbersOf(namedSpace("ACEScg")->chromaticities);
  Builder builder = colourful(image("exr", OIIO::TypeDesc::FLOAT, {.1f, 2, .1f}, aces));
  Scene scene = builder.load();
  EXPECT_TRUE(bringInto(scene, toSpace("ACEScg")).empty());
  const auto texture = static_cast<std::size_t>(scene.materials.at(0).emissiveTexture.texture);
  expectNear(glm::vec3(scene.textures.at(texture).texels[0]), {.1f, 2, .1f}, "texel");
  Scene narrow = builder.load();
  const std::vector<std::string> notes = bringInto(narrow, glm::dmat3(1.0));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(narrow.textures.at(texture).texels[0].r, 0.0f);
}

TEST(WorkingSpace, WhatLeavesANarrowSpaceIsSaid) {
  Scene scene = colourful(image("png", OIIO::TypeDesc::UINT8, {1, 0, 0})).load();
  const glm::dmat3 narrow = glm::inverse(toSpace("ACEScg"));
  const std::vector<std::string> notes = bringInto(scene, narrow);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("outside the picture's colour space"), std::string::npos) << notes[0];
  const glm::vec3 attenuation = scene.materials.at(0).attenuationColor;
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(attenuation[c] >= 0.0f && attenuation[c] <= 1.0f);
}

}  // namespace
}  // namespace pellucid::test
