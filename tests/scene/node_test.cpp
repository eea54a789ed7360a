// Transforms, cameras, lights, identities.
#include <cmath>
#include <set>

#include "engine_bridge/scene/placed.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

void expectNear(glm::dvec3 a, glm::dvec3 b, double tolerance = 1e-12) {
  EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

glm::dvec3 apply(const glm::dmat4& matrix, glm::dvec3 p) {
  return glm::dvec3(matrix * glm::dvec4(p, 1.0));
}

Builder lightBuilder(const Json& light, const Json& node) {
  Builder builder;
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
  builder.json["extensionsRequired"] = Json::array({"KHR_lights_punctual"});
  Json placed = node;
  placed["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.json["nodes"] = Json::array({placed});
  return builder;
}

TEST(Nodes, TrsAppliesScaleThenRotationThenTranslation) {
  Builder builder;
  builder.triangle();
  builder.json["nodes"][0].update(
      {{"translation", {1, 2, 3}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"scale", {2, 3, 4}}});
  const glm::dmat4 world = builder.load().instances.at(0).worldFromObject;
  // (1,1,1) -> scaled (2,3,4) -> a quarter turn about z (-3,2,4) -> moved (-2,4,7)
  expectNear(apply(world, {1, 1, 1}), {-2, 4, 7});
}

TEST(Nodes, ParentsAndMatricesAndUnits) {
  Builder builder;
  builder.triangle();
  builder.json["nodes"][0]["matrix"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};  // column major
  builder.json["nodes"].push_back({{"children", {0}}, {"translation", {0, 0, 10}}, {"scale", {2, 2, 2}}});
  SceneOptions options;
  options.metresPerUnit = 0.01;
  const Scene scene = builder.load(options);
  // (1,0,0) -> (0,1,0)+(5,0,0) -> doubled (10,2,0) -> (10,2,10) units -> metres
  expectNear(apply(scene.instances.at(0).worldFromObject, {1, 0, 0}), {0.1, 0.02, 0.1});
  EXPECT_EQ(scene.instances[0].node, "node 0");
}

TEST(Nodes, MirroredInstancesGetFlippedWindingAndOthersDoNot) {
  Builder builder;
  builder.triangle();
  builder.json["nodes"].push_back({{"mesh", 0}, {"scale", {-1, 1, 1}}});
  builder.json["nodes"].push_back({{"mesh", 0}, {"scale", {-1, -1, 1}}});
  builder.json["nodes"].push_back({{"mesh", 0}, {"scale", {1, 1, -2}}});
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 4u);
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
    glm::dvec3 corner[3];
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = apply(instance.worldFromObject, glm::dvec3(primitive.vertices[primitive.indices[i]].position));
    }
    const glm::dvec3 facing = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    const glm::dmat3 normalFromObject = glm::transpose(glm::inverse(glm::dmat3(instance.worldFromObject)));
    const glm::dvec3 normal = glm::normalize(normalFromObject * glm::dvec3(primitive.vertices[0].normal));
    expectNear(facing, normal);
  }
  EXPECT_EQ(scene.primitives.size(), 2u) << "one mirrored copy for both mirrored nodes";
}

TEST(Nodes, WhatAScaleLeavesWithoutAreaIsHiddenAndNoted) {
  for (const Json& scale : {Json{0, 0, 0}, Json{0, 0, 1}, Json{0, 5, 0}}) {
    Builder builder;
    builder.triangle();
    builder.json["nodes"][0].update({{"name", "gone"}, {"scale", scale}});
    const Scene scene = builder.load();
    EXPECT_TRUE(scene.instances.empty()) << scale.dump();
    EXPECT_TRUE(noted(scene, "gone"));
  }
}

// What lies in the plane that is left keeps its side, whatever rounding makes of a turned determinant of 0.
TEST(Nodes, FlattenedThingsAreDrawn) {
  for (int turn = 0; turn < 40; ++turn) {
    Builder builder;
    builder.triangle();
    const double half = 0.17 * turn, axis = 1.0 / std::sqrt(3.0);
    builder.json["nodes"][0]["scale"] = {1, 1, turn % 2 == 0 ? 0.0 : 1e-20};
    builder.json["nodes"].push_back(
        {{"children", {0}},
         {"rotation", {axis * std::sin(half), axis * std::sin(half), axis * std::sin(half), std::cos(half)}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(scene.instances[0].primitive));
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2})) << turn;
    const Placed placed = placeInstances(scene, Camera{}).at(0);
    const glm::dmat3 linear(placed.viewFromObject);
    const glm::dvec3 facing = glm::normalize(glm::cross(linear[0], linear[1]));
    expectNear(glm::normalize(glm::dvec3(placed.normalFromObject * primitive.vertices[0].normal)), facing, 1e-6);
  }
}

TEST(Nodes, HiddenNodesHideWhatHangsOnThemButCameras) {
  Builder builder = lightBuilder({{"type", "point"}}, Json::object());
  builder.json.erase("extensionsRequired");
  builder.json["extensionsRequired"] = Json::array({"KHR_lights_punctual", "KHR_node_visibility"});
  for (int i = 0; i < 3; ++i) builder.triangle();
  Json& nodes = builder.json["nodes"];
  nodes[1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  nodes[1]["children"] = {0, 2, 4};
  nodes[2]["extensions"]["KHR_node_visibility"]["visible"] = true;  // its parent's false wins
  nodes[3]["extensions"]["KHR_node_visibility"] = Json::object();
  nodes.push_back({{"camera", 0}});
  builder.json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}});
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].node, "node 3");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
}

TEST(Nodes, ALastRowOffByRoundingIsTaken) {
  const auto loaded = [](double a, double b, double c, double w) {
    Builder builder;
    builder.triangle();
    builder.json["nodes"][0]["matrix"] = {2, 0, 0, a, 0, 2, 0, b, 0, 0, 2, c, 5, 6, 7, w};
    return builder.load().instances.at(0).worldFromObject;
  };
  EXPECT_EQ(loaded(0, 0, 0, 1)[3], glm::dvec4(5, 6, 7, 1));
  expectNear(glm::dvec3(loaded(1e-9, -1e-7, 1e-6, .9999999)[3]), {5, 6, 7}, 1e-5);
  EXPECT_EQ(loaded(0, 0, 1e-9, 1.0000001192092896)[3].w, 1.0);
  for (const double w : {0.0, 0.5, 2.0, 1.001})
    expectRefusal(refusalOf([&] { loaded(0, 0, 0, w); }), 3, {"nodes[0].matrix", "last row"});
  expectRefusal(refusalOf([&] { loaded(0, 0.01, 0, 1); }), 3, {"nodes[0].matrix", "last row"});
}

TEST(Nodes, TheDefaultSceneDecidesWhatIsDrawn) {
  Builder builder;
  for (int i = 0; i < 3; ++i) builder.triangle();
  builder.json["scenes"] = Json::array({{{"nodes", {0}}}, {{"nodes", {2, 1}}}});
  builder.json["scene"] = 1;
  Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].node, "node 2");
  EXPECT_EQ(scene.instances[1].node, "node 1");
  builder.json.erase("scene");
  scene = builder.load();
  EXPECT_EQ(scene.instances.size(), 3u);
  EXPECT_TRUE(noted(scene, "2 scenes and no default"));
}

TEST(Nodes, IdentitiesDifferAndStay) {
  Builder builder;
  Json& primitive = builder.triangle();
  const Json one = primitive;
  builder.json["meshes"][0]["primitives"].push_back(one);
  for (int i = 0; i < 999; ++i) builder.json["nodes"].push_back({{"mesh", 0}});
  const std::string path = builder.writeGlb();
  const Scene scene = loadScene({path, path}, {});
  std::set<std::uint32_t> identities;
  for (const Instance& instance : scene.instances) identities.insert(instance.identity);
  ASSERT_EQ(scene.instances.size(), 4000u);
  // 4000 of 2^32 values: a chance collision has probability 0.002; these are fixed, and have none.
  EXPECT_EQ(identities.size(), 4000u);
  const Scene again = loadScene({path, path}, {});
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    ASSERT_EQ(scene.instances[i].identity, again.instances[i].identity);
  }
}

TEST(Nodes, FilesAreAppendedInOrder) {
  Builder first, second;
  first.material({{"name", "a"}});
  second.material({{"name", "b"}});
  const Scene scene = loadScene({first.writeGlb("1.glb"), second.writeGlb("2.glb")}, {});
  ASSERT_EQ(scene.materials.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "a");
  EXPECT_EQ(scene.primitives[static_cast<std::size_t>(scene.instances[1].primitive)].material, 1);
}

SceneCamera cameraFrom(const Json& camera, const Json& node, double metresPerUnit = 1.0) {
  Builder builder;
  builder.json["cameras"] = Json::array({camera});
  Json placed = {{"camera", 0}, {"name", "shot"}};
  placed.update(node);
  builder.json["nodes"] = Json::array({placed});
  SceneOptions options;
  options.metresPerUnit = metresPerUnit;
  return builder.load(options).cameras.at(0);
}

TEST(Cameras, PerspectiveUsesThePicturesAspect) {
  const Json lens = {{"type", "perspective"},
                     {"perspective", {{"yfov", kPi / 2}, {"znear", 0.1}, {"zfar", 50}, {"aspectRatio", 3.0}}}};
  const SceneCamera source = cameraFrom(lens, {{"translation", {0, 0, 500}}}, 0.01);
  const Camera camera = cameraOf(source, Window{0, 0, 300, 100}, 1.0);
  EXPECT_NEAR(camera.focal.x, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(camera.focal.y, 1.0, 1e-15);
  EXPECT_FALSE(camera.orthographic);
  EXPECT_DOUBLE_EQ(camera.rangeNear, 0.001);
  EXPECT_DOUBLE_EQ(camera.rangeFar, 0.5);
  EXPECT_EQ(camera.origin, "glTF node shot");
  EXPECT_EQ(source.aspect, 3.0);
  expectNear(apply(camera.viewFromWorld, {0, 0, 0}), {0, 0, -5});
  // Pixels three times as wide make the picture three times as wide.
  EXPECT_NEAR(cameraOf(source, Window{-10, 5, 90, 105}, 3.0).focal.x, 1.0 / 3.0, 1e-15);
  expectRefusal(refusalOf([&] { cameraOf(source, Window{0, 0, 0, 100}, 1.0); }), 4, {"shot", "0x100"});
  expectRefusal(refusalOf([&] { cameraOf(source, Window{0, 0, 10, 10}, std::nan("")); }), 4, {"shot"});
}

// Exporters take a scale of zero apart into it.
TEST(Nodes, ARotationOfZerosTurnsNothing) {
  Builder builder;
  builder.triangle();
  builder.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  builder.json["nodes"][0]["translation"] = {1, 2, 3};
  const Scene scene = builder.load();
  const glm::dmat4& placed = scene.instances.at(0).worldFromObject;
  EXPECT_EQ(glm::dmat3(placed), glm::dmat3(1.0));
  EXPECT_EQ(placed[3], glm::dvec4(1, 2, 3, 1));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("nodes[0].rotation is 0 0 0 0"), std::string::npos) << scene.notes[0];
}

TEST(Cameras, Orthographic) {
  const Json lens = {{"type", "orthographic"},
                     {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 100}}}};
  const Camera camera = cameraOf(cameraFrom(lens, Json::object()), Window{0, 0, 200, 100}, 1.0);
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.focal, glm::dvec2(0.25, 0.5));
}

// Focal lengths are half a picture over what lies at its edge, one metre away or in metres: a field's half sizes.
TEST(Cameras, AnotherShapeIsFittedWithoutStretch) {
  struct Case {
    double width, height;  // half the field's, at one metre
    int across, down;
    const char* said;
  };
  const Case cases[] = {{3, 1, 200, 100, "width"}, {1, 1, 200, 100, "height"}, {2, 1, 200, 100, ""},
                        {1, 1, 100, 200, "width"}, {.5, 1, 100, 200, ""},      {.25, 1, 100, 200, "height"},
                        {2.0003, 1, 200, 100, ""}};
  for (const Case& one : cases)
    for (const bool orthographic : {false, true}) {
      SceneCamera source;
      source.name = "shot";
      source.orthographic = orthographic;
      source.yfov = 2 * std::atan(one.height);
      source.aspect = one.width / one.height;
      source.xmag = one.width;
      source.ymag = one.height;
      const Camera camera = cameraOf(source, Window{0, 0, one.across, one.down}, 1.0);
      const double across = 0.5 * one.across * camera.focal.x, down = 0.5 * one.down * camera.focal.y;
      EXPECT_NEAR(across / down, 1.0, 1e-3) << "pixels a metre in x and y";
      EXPECT_LE(one.width * camera.focal.x, 1.0 + 1e-3) << "the field's width lies in the picture";
      EXPECT_LE(one.height * camera.focal.y, 1.0 + 1e-3) << "its height, too";
      EXPECT_NEAR(std::max(one.width * camera.focal.x, one.height * camera.focal.y), 1.0, 1e-3) << "and fills it";
      const bool said = camera.origin.find("aspect") != std::string::npos;
      EXPECT_EQ(said, *one.said != '\0') << camera.origin;
      EXPECT_NE(camera.origin.find(one.said), std::string::npos) << camera.origin;
    }
}

// Exporters write null for what they leave out.
TEST(Nodes, MembersThatAreNullAreAbsent) {
  Builder builder;
  Json& primitive = builder.mesh({{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)}});
  primitive["material"] = 0;
  Json& json = builder.json;
  json["materials"].push_back({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", Json::object()}});
  json["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  json["nodes"].push_back({{"camera", 0}});
  const auto setNull = [](Json& object, const std::vector<const char*>& members) {
    for (const char* member : members) object[member] = nullptr;
  };
  setNull(json, {"scene", "animations", "skins", "extensionsUsed", "extensionsRequired", "extras"});
  setNull(json["nodes"][0], {"name", "children", "skin", "camera", "extensions", "matrix", "rotation", "weights"});
  setNull(json["meshes"][0]["primitives"][0], {"mode", "targets", "indices"});
  setNull(json["accessors"][0], {"normalized", "byteOffset", "sparse"});
  setNull(json["bufferViews"][0], {"byteStride", "target"});
  setNull(json["materials"][0], {"name", "emissiveFactor", "normalTexture", "alphaCutoff", "extensions"});
  setNull(json["materials"][0]["pbrMetallicRoughness"], {"baseColorTexture", "baseColorFactor", "roughnessFactor"});
  setNull(json["cameras"][0]["perspective"], {"aspectRatio", "zfar"});
  const Scene scene = builder.load();
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1.0f));
  json["meshes"][0]["primitives"][0]["attributes"] = nullptr;
  expectRefusal(refusalOf(builder), 3, {"attributes"});
}

TEST(Cameras, ScaleDoesNotCount) {
  const Json lens = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
  const double h = std::sqrt(0.5);
  const SceneCamera camera =
      cameraFrom(lens, {{"scale", {2, 5, -3}}, {"rotation", {0, h, 0, h}}, {"translation", {1, 2, 3}}});
  const glm::dmat3 rotation(camera.viewFromWorld);
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(product[i][j], i == j ? 1.0 : 0.0, 1e-12);
  }
  EXPECT_NEAR(glm::determinant(rotation), 1.0, 1e-12);
  expectNear(apply(camera.viewFromWorld, {1, 2, 3}), {0, 0, 0});
  EXPECT_EQ(camera.zfar, 0.0) << "no zfar is an infinite range";
}

// Most files are drawn through another camera: a broken one is left out, and said.
TEST(Cameras, BrokenOnesAreLeftOutAndNoted) {
  const auto expectLeftOut = [](const Json& camera, const Json& node, const std::vector<std::string>& words) {
    Builder builder;
    const Json good = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
    builder.json["cameras"] = Json::array({camera, good});
    Json placed = {{"camera", 0}, {"name", "broken"}};
    placed.update(node);
    builder.json["nodes"] = Json::array({placed, {{"camera", 1}, {"name", "good"}}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.cameras.size(), 1u) << camera.dump();
    EXPECT_EQ(scene.cameras[0].name, "good");
    EXPECT_TRUE(noted(scene, "the camera of node broken is left out"));
    for (const std::string& word : words) EXPECT_TRUE(noted(scene, word)) << scene.notes.front();
  };
  const auto leftOut = [&](const Json& lens, const std::vector<std::string>& words) {
    expectLeftOut({{"type", "perspective"}, {"perspective", lens}}, Json::object(), words);
  };
  leftOut({{"yfov", 0}, {"znear", 0.1}}, {"yfov"});
  leftOut({{"yfov", 3.2}, {"znear", 0.1}}, {"yfov"});
  leftOut({{"yfov", 1}, {"znear", -0.1}}, {"znear"});
  leftOut({{"yfov", 1}, {"znear", 2}, {"zfar", 1}}, {"znear 2", "zfar 1"});
  leftOut({{"znear", 2}}, {"yfov"});
  leftOut("glass", {"perspective"});
  expectLeftOut({{"type", "fisheye"}}, Json::object(), {"fisheye"});
  expectLeftOut({{"type", "orthographic"}, {"orthographic", {{"xmag", 0}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}},
                Json::object(), {"xmag"});
  expectLeftOut({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}, {{"scale", {1, 0, 1}}},
                {"orientation"});
  expectLeftOut({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}, {{"camera", 7}}, {"7"});
}

TEST(Lights, PhotometricUnitsDirectionsAndRanges) {
  const double h = std::sqrt(0.5);
  SceneOptions options;
  options.metresPerUnit = 0.5;
  const Json spot = {
      {"type", "spot"},    {"name", "key"}, {"color", {1, 0.5, 0.25}},
      {"intensity", 1366}, {"range", 8},    {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}};
  // A quarter turn about x sends -z to +y; scale touches neither range nor direction.
  const Json node = {{"rotation", {h, 0, 0, h}}, {"translation", {2, 4, 6}}, {"scale", {3, 3, 3}}};
  const Light light = lightBuilder(spot, node).load(options).lights.at(0);
  EXPECT_EQ(light.kind, LightKind::spot);
  EXPECT_EQ(light.name, "key");
  EXPECT_FLOAT_EQ(light.intensity, 2.0f);
  EXPECT_EQ(light.colour, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(light.range, 4.0f);
  EXPECT_FLOAT_EQ(light.innerCone, 0.2f);
  EXPECT_FLOAT_EQ(light.outerCone, 0.4f);
  expectNear(light.position, {1, 2, 3});
  expectNear(light.direction, {0, 1, 0});
}

TEST(Lights, DefaultsAndLumensPerWatt) {
  SceneOptions options;
  options.lumensPerWatt = 1.0;
  const Light sun =
      lightBuilder({{"type", "directional"}, {"intensity", 3}}, Json::object()).load(options).lights.at(0);
  EXPECT_EQ(sun.kind, LightKind::directional);
  EXPECT_EQ(sun.intensity, 3.0f);
  expectNear(sun.direction, {0, 0, -1});
  const Light spot =
      lightBuilder({{"type", "spot"}, {"spot", Json::object()}}, Json::object()).load(options).lights.at(0);
  EXPECT_EQ(spot.intensity, 1.0f);
  EXPECT_EQ(spot.range, 0.0f);
  EXPECT_EQ(spot.innerCone, 0.0f);
  EXPECT_FLOAT_EQ(spot.outerCone, static_cast<float>(kPi / 4));
}

TEST(Lights, BrokenOnes) {
  Builder none = lightBuilder({{"type", "point"}}, Json::object());
  none.json.erase("extensions");
  expectRefusal(refusalOf(none), 3, {"light"});
  Builder beyond = lightBuilder({{"type", "point"}}, Json::object());
  beyond.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  expectRefusal(refusalOf(beyond), 3, {"light", "below 1"});
  const Scene negative = lightBuilder({{"type", "point"}, {"intensity", -1}}, Json::object()).load();
  EXPECT_EQ(negative.lights.at(0).intensity, 0.0f);
  EXPECT_TRUE(noted(negative, "intensity"));
  const Scene cones =
      lightBuilder({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}, Json::object())
          .load();
  EXPECT_LT(cones.lights.at(0).innerCone, cones.lights.at(0).outerCone);
  EXPECT_TRUE(noted(cones, "hard edge"));
}

TEST(Options, UnitsMustBePositive) {
  Builder builder;
  builder.triangle();
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    SceneOptions options;
    options.metresPerUnit = bad;
    expectRefusal(refusalOf(builder, options), 2, {"--unit"});
    options.metresPerUnit = 1.0;
    options.lumensPerWatt = bad;
    expectRefusal(refusalOf(builder, options), 2, {"--lumens-per-watt"});
  }
}

}  // namespace
}  // namespace pellucid::test
