// Faults of some exporters' files that need not keep what else they hold from being drawn.
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

Builder triangle() {
  Builder builder;
  builder.mesh({{"POSITION", builder.floats(kTriangle, "VEC3", 3)}});
  return builder;
}

glm::vec3 seenAt(const Scene& scene, std::size_t vertex) {
  const glm::vec3& position = scene.primitives.at(0).vertices[vertex].position;
  return glm::vec3(scene.instances.at(0).worldFromObject * glm::dvec4(glm::dvec3(position), 1.0));
}

// Two joints of the second of which the triangle's second vertex hangs.
Builder skinned() {
  Builder builder = triangle();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      builder.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4);
  attributes["WEIGHTS_0"] = builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["nodes"].push_back(Json::object());
  builder.json["nodes"].push_back({{"translation", {0, 0, 5}}});
  builder.json["nodes"].push_back({{"translation", {0, 7, 0}}, {"children", {2}}});
  builder.json["skins"].push_back({{"joints", {1, 2}}});
  return builder;
}

TEST(Lenient, JointsThatTheSceneDoesNotHoldStandWhereTheirParentsPlaceThem) {
  SceneOptions centimetres;
  centimetres.metresPerUnit = 0.01;
  for (const SceneOptions& options : {SceneOptions{}, centimetres}) {
    Builder builder = skinned();
    const glm::vec3 inside = seenAt(builder.load(options), 1);
    builder.json["scenes"] = {{{"nodes", {0, 1}}}};
    const Scene scene = builder.load(options);
    EXPECT_TRUE(noted(scene, "skins[0].joints[1] is 2, a node that the scene does not hold"));
    EXPECT_LT(glm::length(seenAt(scene, 1) - inside), 1e-6f);
    const auto unit = static_cast<float>(options.metresPerUnit);
    EXPECT_LT(glm::length(seenAt(scene, 1) - unit * glm::vec3(1, 7, 5)), 1e-6f);
  }
  Builder circle = skinned();
  circle.json["scenes"] = {{{"nodes", {0, 1}}}};
  circle.json["nodes"][2]["children"] = {3};
  expectRefusal(refusalOf(circle), 3, {"is its own ancestor"});
}

TEST(Lenient, ASkinOfAMeshWithoutJointsMovesNothing) {
  Builder builder = skinned();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase("JOINTS_0");
  attributes.erase("WEIGHTS_0");
  builder.json["nodes"][0]["translation"] = {3, 0, 0};
  const Scene scene = builder.load();
  EXPECT_TRUE(noted(scene, "nodes[0] has a skin, and no primitive of its mesh has JOINTS_0"));
  EXPECT_EQ(seenAt(scene, 1), glm::vec3(4, 0, 0)) << "where its node stands";
}

TEST(Lenient, OtherNumbersOfTargetsThanOfWeights) {
  const auto moved = [](const Json& weights, bool targets) {
    Builder builder = triangle();
    if (targets)
      builder.json["meshes"][0]["primitives"][0]["targets"] = {
          {{"POSITION", builder.floats({0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3", 3)}},
          {{"POSITION", builder.floats({0, 0, 0, 0, 4, 0, 0, 0, 0}, "VEC3", 3)}}};
    builder.json["meshes"][0]["weights"] = weights;
    const Scene scene = builder.load();
    EXPECT_EQ(noted(scene, "another number of morph targets than of weights"), !targets || weights.size() != 2);
    return seenAt(scene, 1);
  };
  EXPECT_EQ(moved({0.5, 0.25}, true), glm::vec3(2, 1, 0));
  EXPECT_EQ(moved({0.5}, true), glm::vec3(2, 0, 0)) << "what has no weight stands still";
  EXPECT_EQ(moved({0.5, 0.25, 8.0}, true), glm::vec3(2, 1, 0)) << "what has no target moves nothing";
  EXPECT_EQ(moved({0.5}, false), glm::vec3(1, 0, 0));
}

TEST(Lenient, LightsOfOtherKindsAreLeftOut) {
  Builder builder = triangle();
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "area"}, {"name", "window"}},
                                                                 {{"type", "point"}, {"intensity", 683.0}}};
  for (const int light : {0, 1})
    builder.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
  const Scene scene = builder.load();
  EXPECT_TRUE(noted(scene, "light window: is area, which is none of directional, point and spot, and is left out"));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].kind, LightKind::point);
}

TEST(Lenient, WholeNumbersAsColoursArePartsOfTheLargest) {
  const auto colour = [](bool normalised, bool morphed) {
    Builder builder = triangle();
    Json& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = builder.accessor(
        std::vector<std::uint8_t>{51, 102, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4, normalised);
    if (morphed) {
      primitive["targets"] = {{{"COLOR_0", builder.accessor(std::vector<std::uint8_t>(12, 51), 5121, "VEC4", 4)}}};
      builder.json["meshes"][0]["weights"] = {1.0};
    }
    const Scene scene = builder.load();
    EXPECT_EQ(noted(scene, "whole numbers as COLOR_0"), !normalised);
    return scene.primitives.at(0).vertices[0].colour;
  };
  for (const bool normalised : {true, false}) {
    EXPECT_LT(glm::length(colour(normalised, false) - glm::vec4(0.2f, 0.4f, 1, 1)), 1e-6f);
    EXPECT_LT(glm::length(colour(normalised, true) - glm::vec4(0.4f, 0.6f, 1, 1)), 1e-6f);
  }
}

TEST(Lenient, NamesInLatin1) {
  Builder builder = triangle();
  builder.json["nodes"][0]["name"] =
      "Stra\xC3\x9F"
      "e";
  std::string text = builder.json.dump();
  const std::size_t at = text.find("\xC3\x9F");
  text.replace(at, 2, "\xDF");
  const std::string path = (testFolder() / "latin.gltf").string();
  text.insert(1, R"("buffers":[{"byteLength":36,"uri":"latin.bin"}],)");
  writeBytes(testFolder() / "latin.bin", builder.binary.data(), builder.binary.size());
  writeBytes(path, text.data(), text.size());
  const Scene scene = loadScene({path}, {});
  EXPECT_TRUE(noted(scene, "has text that is not UTF-8 and is read as Latin-1"));
  EXPECT_EQ(scene.instances.at(0).node,
            "Stra\xC3\x9F"
            "e");
}

}  // namespace
}  // namespace pellucid::test
