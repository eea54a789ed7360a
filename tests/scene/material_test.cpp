// Materials, their extensions, extras.pellucid and --set.
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

Json withExtension(const char* name, const Json& value) {
  return {{"name", "glass"}, {"extensions", {{name, value}}}};
}

Scene sceneWith(const Json& material, const SceneOptions& options = {}) {
  Builder builder;
  builder.material(material);
  return builder.load(options);
}

Material load(const Json& material, const SceneOptions& options = {}) {
  return sceneWith(material, options).materials.at(0);
}

TEST(Materials, DefaultsAreGltfs) {
  const Material material = load(Json::object());
  EXPECT_EQ(material.name, "material_0");
  EXPECT_EQ(material.alphaMode, AlphaMode::opaque);
  EXPECT_EQ(material.alphaCutoff, 0.5f);
  EXPECT_EQ(material.baseColor, glm::vec4(1.0f));
  EXPECT_EQ(material.metallic, 1.0f);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.ior, 1.5f);
  EXPECT_FALSE(material.doubleSided || material.unlit || material.volume || material.transparent());
  EXPECT_TRUE(material.castsShadow);
  EXPECT_EQ(material.baseColorTexture.texture, -1);
}

TEST(Materials, BaseValues) {
  const Material material = load(
      {{"name", "smoke"},
       {"alphaMode", "BLEND"},
       {"doubleSided", true},
       {"emissiveFactor", {0.5, 0.25, 1}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"roughnessFactor", 0.75}}},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}, {"KHR_materials_unlit", Json::object()}}}});
  EXPECT_EQ(material.alphaMode, AlphaMode::blend);
  EXPECT_TRUE(material.transparent());
  EXPECT_TRUE(material.doubleSided);
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.roughness, 0.75f);
  EXPECT_EQ(material.emission, glm::vec3(4.0f, 2.0f, 8.0f));
  const Material mask = load({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
  EXPECT_EQ(mask.alphaMode, AlphaMode::mask);
  EXPECT_EQ(mask.alphaCutoff, 0.25f);
}

// The material's reflectance head-on, as shaders/shared/surface.glsl makes it of index and tint.
glm::vec3 headOn(const Material& material) {
  const float root = (material.ior - 1.0f) / (material.ior + 1.0f);
  return glm::min(root * root * material.specularColor, glm::vec3(1.0f)) * material.specular;
}

TEST(Materials, SpecularGlossinessWinsOverMetallicRoughness) {
  const Material material = load({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 1}}},
                                  {"extensions",
                                   {{"KHR_materials_ior", {{"ior", 3.0}}},
                                    {"KHR_materials_pbrSpecularGlossiness",
                                     {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                      {"specularFactor", {0.9, 0.5, 0.04}},
                                      {"glossinessFactor", 0.75}}}}}});
  EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.roughness, 0.25f);
  EXPECT_LT(glm::length(headOn(material) - glm::vec3(0.9f, 0.5f, 0.04f)), 1e-6f);
  const Material plain = load(withExtension("KHR_materials_pbrSpecularGlossiness", Json::object()));
  EXPECT_EQ(plain.baseColor, glm::vec4(1.0f));
  EXPECT_EQ(plain.roughness, 0.0f);
  EXPECT_LT(glm::length(headOn(plain) - glm::vec3(1.0f)), 1e-6f);
}

TEST(Materials, UnlitOnesDoNotTransmit) {
  const Scene scene = sceneWith(
      {{"name", "glass"},
       {"extensions",
        {{"KHR_materials_unlit", Json::object()}, {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  EXPECT_EQ(scene.materials.at(0).transmission, 0.0f);
  EXPECT_FALSE(scene.materials.at(0).transparent());
  EXPECT_TRUE(noted(scene, "material glass: is unlit"));
}

TEST(Materials, BothSidesOfAVolumeAreDrawn) {
  const auto both = [](bool doubleSided, double transmission, double thickness, bool unlit) {
    Json material = {{"doubleSided", doubleSided},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}},
                       {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}};
    if (unlit) material["extensions"]["KHR_materials_unlit"] = Json::object();
    return load(material).bothSides();
  };
  EXPECT_TRUE(both(true, 0, 0, false));
  EXPECT_TRUE(both(false, 1, 2, false));
  EXPECT_FALSE(both(false, 1, 0, false)) << "thin";
  EXPECT_FALSE(both(false, 0, 2, false)) << "nothing gets in";
  EXPECT_FALSE(both(false, 1, 2, true));
  Material thin;
  thin.transmission = 1.0f;
  thin.volume = true;
  EXPECT_TRUE(thin.bothSides());
  thin.thin = true;
  EXPECT_FALSE(thin.bothSides());
}

// Below the cutoff everything is clear: where no alpha reaches it, nothing is there.
TEST(Materials, AMaskThatNothingReachesIsNotDrawn) {
  const auto instances = [](double cutoff, double factor, float vertexAlpha) {
    Builder builder;
    builder.material({{"name", "leaf"},
                      {"alphaMode", "MASK"},
                      {"alphaCutoff", cutoff},
                      {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, factor}}}}});
    builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        builder.floats({1, 1, 1, vertexAlpha, 1, 1, 1, 0, 1, 1, 1, 0}, "VEC4", 4);
    const Scene scene = builder.load();
    EXPECT_EQ(noted(scene, "material leaf: no alpha reaches its cutoff"), scene.instances.empty());
    return scene.instances.size();
  };
  EXPECT_EQ(instances(1.0, 1.0, 1.0f), 1u);
  EXPECT_EQ(instances(1.0001, 1.0, 1.0f), 0u);
  EXPECT_EQ(instances(0.5, 0.5, 1.0f), 1u);
  EXPECT_EQ(instances(0.5, 0.45, 1.0f), 0u);
  EXPECT_EQ(instances(0.5, 1.0, 0.25f), 1u) << "a vertex colour counts only where it is above 1's share";
  EXPECT_EQ(instances(0.0, 0.0, 0.0f), 1u);
}

TEST(Materials, TransmissionIsTransparentThoughOpaqueByMode) {
  const Material material = load(withExtension("KHR_materials_transmission", {{"transmissionFactor", 0.9}}));
  EXPECT_EQ(material.transmission, 0.9f);
  EXPECT_EQ(material.alphaMode, AlphaMode::opaque);
  EXPECT_TRUE(material.transparent());
  EXPECT_FALSE(load(withExtension("KHR_materials_transmission", Json::object())).transparent());
}

TEST(Materials, VolumeDistancesAreMetresAndThicknessIsObjectSpace) {
  SceneOptions options;
  options.metresPerUnit = 0.01;
  const Material material =
      load(withExtension("KHR_materials_volume",
                         {{"thicknessFactor", 2}, {"attenuationDistance", 50}, {"attenuationColor", {0.5, 1, 0.25}}}),
           options);
  EXPECT_TRUE(material.volume);
  EXPECT_EQ(material.thickness, 2.0f);
  EXPECT_FLOAT_EQ(material.attenuationDistance, 0.5f);
  EXPECT_EQ(material.attenuationColor, glm::vec3(0.5f, 1.0f, 0.25f));
  const Material thin = load(withExtension("KHR_materials_volume", {{"attenuationDistance", 1e300}}));
  EXPECT_FALSE(thin.volume);
  EXPECT_EQ(thin.attenuationDistance, 0.0f) << "as good as infinite";
  Builder zero;
  zero.material(withExtension("KHR_materials_volume", {{"attenuationDistance", 0}}));
  expectRefusal(refusalOf(zero), 3, {"attenuationDistance"});
}

TEST(Materials, IndexOfRefraction) {
  EXPECT_EQ(load(withExtension("KHR_materials_ior", {{"ior", 1.33}})).ior, 1.33f);
  EXPECT_EQ(load(withExtension("KHR_materials_ior", Json::object())).ior, 1.5f);
  const Scene low = sceneWith(withExtension("KHR_materials_ior", {{"ior", 0.5}}));
  EXPECT_EQ(low.materials.at(0).ior, 1.0f);
  EXPECT_TRUE(noted(low, "ior is 0.5"));
}

TEST(Materials, IorZeroReflectsWhatTheSpecularExtensionSays) {
  const auto reflectance = [](float ior) { return (ior - 1.0f) * (ior - 1.0f) / ((ior + 1.0f) * (ior + 1.0f)); };
  const Scene mirror = sceneWith(withExtension("KHR_materials_ior", {{"ior", 0}}));
  EXPECT_GT(reflectance(mirror.materials.at(0).ior), 0.99999f);
  EXPECT_TRUE(noted(mirror, "ior 0"));
  // 4%, the head-on reflectance of ior 1.5
  const Material glass = load({{"extensions",
                                {{"KHR_materials_ior", {{"ior", 0}}},
                                 {"KHR_materials_specular", {{"specularColorFactor", {0.04, 0.04, 0.04}}}}}}});
  EXPECT_NEAR(glass.ior, 1.5f, 1e-5f);
}

TEST(Materials, SpecularFactorsAreRead) {
  EXPECT_TRUE(sceneWith(withExtension("KHR_materials_specular", Json::object())).notes.empty());
  const Scene scene = sceneWith(
      withExtension("KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0.25}}}));
  EXPECT_EQ(scene.materials.at(0).specular, 0.5f);
  EXPECT_EQ(scene.materials.at(0).specularColor, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Materials, WhatIsNotDrawnOfItIsNoted) {
  EXPECT_TRUE(noted(sceneWith({{"occlusionTexture", {{"index", 0}}}}), "occlusion texture is not used"));
}

TEST(Materials, DispersionIsRead) {
  const Scene scene = sceneWith(withExtension("KHR_materials_dispersion", {{"dispersion", 0.36}}));
  EXPECT_EQ(scene.materials.at(0).dispersion, 0.36f);
  EXPECT_EQ(sceneWith(Json::object()).materials.at(0).dispersion, 0.0f);
}

TEST(Materials, DiffuseTransmissionFactorOnly) {
  const Scene plain =
      sceneWith(withExtension("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5}}));
  EXPECT_EQ(plain.materials.at(0).diffuseTransmission, 0.5f);
  EXPECT_TRUE(plain.notes.empty());
  const Scene tinted =
      sceneWith(withExtension("KHR_materials_diffuse_transmission", {{"diffuseTransmissionColorFactor", {1, 0, 0}}}));
  EXPECT_TRUE(noted(tinted, "only the factor"));
}

TEST(Materials, ValuesOutOfRangeAreClampedAndNoted) {
  const Scene scene =
      sceneWith({{"pbrMetallicRoughness", {{"roughnessFactor", 7}, {"baseColorFactor", {2, -1, 0.5, 1}}}}});
  EXPECT_EQ(scene.materials.at(0).roughness, 1.0f);
  EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1.0f, 0.0f, 0.5f, 1.0f));
  EXPECT_TRUE(noted(scene, "roughnessFactor is 7"));
  EXPECT_EQ(scene.notes.size(), 3u);
}

TEST(Materials, ValuesOfAnotherKindAreRefused) {
  const auto refusal = [](const Json& material) {
    Builder builder;
    builder.material(material);
    return refusalOf(builder);
  };
  expectRefusal(refusal({{"alphaMode", "GLOW"}}), 3, {"materials[0].alphaMode", "GLOW"});
  expectRefusal(refusal({{"alphaCutoff", "high"}}), 3, {"alphaCutoff", "a number"});
  expectRefusal(refusal({{"doubleSided", 1}}), 3, {"doubleSided", "true or false"});
  expectRefusal(refusal({{"emissiveFactor", {1, 2}}}), 3, {"emissiveFactor", "expected 3"});
  expectRefusal(refusal({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}), 3, {"index", "below 0"});
}

TEST(Extensions, RequiredAndUnknownIsRefusedByName) {
  for (const char* name : {"KHR_materials_clearcoat", "KHR_texture_basisu", "ACME_anything"}) {
    Builder builder;
    builder.triangle();
    builder.json["extensionsRequired"] = Json::array({name});
    expectRefusal(refusalOf(builder), 4, {"scene.glb", name});
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"];
    builder.json.erase("extensionsRequired");
    EXPECT_TRUE(noted(builder.load(), name));
  }
}

TEST(Extensions, WhatIsReadOrHarmlessIsNotNoted) {
  Builder builder;
  builder.triangle();
  const Json names = {"EXT_mesh_gpu_instancing",
                      "EXT_meshopt_compression",
                      "KHR_draco_mesh_compression",
                      "KHR_mesh_quantization",
                      "KHR_lights_punctual",
                      "KHR_materials_diffuse_transmission",
                      "KHR_materials_dispersion",
                      "KHR_materials_emissive_strength",
                      "KHR_materials_ior",
                      "KHR_materials_pbrSpecularGlossiness",
                      "KHR_materials_specular",
                      "KHR_materials_transmission",
                      "KHR_materials_unlit",
                      "KHR_materials_volume",
                      "KHR_node_visibility",
                      "KHR_texture_transform",
                      "KHR_xmp"};
  builder.json["extensionsUsed"] = names;
  builder.json["extensionsRequired"] = names;
  EXPECT_TRUE(builder.load().notes.empty());
}

TEST(Extras, PellucidKeys) {
  const Material material = load({{"extras",
                                   {{"artist", "someone"},
                                    {"pellucid",
                                     {{"collimation", 0.25},
                                      {"coverage", 0.5},
                                      {"additive", true},
                                      {"lowResolution", true},
                                      {"castsShadow", false},
                                      {"thin", true}}}}}});
  EXPECT_EQ(material.collimation, 0.25f);
  EXPECT_EQ(material.coverage, 0.5f);
  EXPECT_TRUE(material.additive);
  EXPECT_TRUE(material.lowResolution);
  EXPECT_FALSE(material.castsShadow);
  EXPECT_EQ(material.thin, true);
  EXPECT_TRUE(material.transparent());
  EXPECT_TRUE(noted(sceneWith({{"extras", {{"pellucid", {{"colimation", 1}}}}}}), "colimation"));
  EXPECT_TRUE(sceneWith({{"extras", "anything"}}).notes.empty());
  for (const Json& bad : {Json{{"collimation", 1.5}}, Json{{"thin", 0.5}}, Json{{"coverage", Json::array()}}}) {
    Builder builder;
    builder.material({{"extras", {{"pellucid", bad}}}});
    expectRefusal(refusalOf(builder), 3, {"extras.pellucid", "collimation"});
  }
}

SceneOptions set(const std::vector<std::string>& overrides) {
  SceneOptions options;
  options.overrides = overrides;
  return options;
}

TEST(Set, EveryKeyWorksAndWinsOverExtras) {
  const Json material = {{"name", "Glass.001"}, {"extras", {{"pellucid", {{"coverage", 0.5}, {"thin", true}}}}}};
  const Material changed =
      load(material, set({"Glass.001.coverage=0.75", "Glass.001.thin=false", "Glass.001.collimation=0",
                          "Glass.001.additive=on", "Glass.001.lowResolution=1", "Glass.001.castsShadow=off"}));
  EXPECT_EQ(changed.coverage, 0.75f);
  EXPECT_EQ(changed.thin, false);
  EXPECT_EQ(changed.collimation, 0.0f);
  EXPECT_TRUE(changed.additive && changed.lowResolution);
  EXPECT_FALSE(changed.castsShadow);
  EXPECT_EQ(load(material, set({"Glass.001.coverage=0.75", "Glass.001.coverage=0.25"})).coverage, 0.25f);
  EXPECT_EQ(load({{"name", "a=b"}}, set({"a=b.coverage=0.5"})).coverage, 0.5f);
}

TEST(Set, MistakesAreUsageErrorsThatListTheChoices) {
  const auto refusal = [](const std::string& text) {
    Builder builder;
    builder.material({{"name", "glass"}});
    builder.material({{"name", "smoke"}});
    return refusalOf(builder, set({text}));
  };
  expectRefusal(refusal("wood.thin=true"), 2, {"wood", "glass, smoke"});
  expectRefusal(refusal("glass.colour=1"), 2, {"colour", "collimation", "castsShadow"});
  expectRefusal(refusal("glass.coverage=2"), 2, {"coverage", "0 to 1"});
  expectRefusal(refusal("glass.coverage=nan"), 2, {"nan", "0 to 1"});
  expectRefusal(refusal("glass.coverage=0.5x"), 2, {"0.5x"});
  expectRefusal(refusal("glass.thin=perhaps"), 2, {"perhaps", "true or false"});
  expectRefusal(refusal("glass.thin="), 2, {"glass.thin="});
  for (const char* text : {"", "glass", "glass.thin", "=", ".thin=true", "glass=true"}) {
    EXPECT_EQ(refusal(text).code, 2) << text;
  }
}

}  // namespace
}  // namespace pellucid::test
