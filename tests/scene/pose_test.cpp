// Skins and morph targets in the pose that the file stores.
#include <cmath>

#include "engine_bridge/scene/placed.h"
#include "shaders/shading.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> kThreeUp = {0, 0, 1, 0, 0, 1, 0, 0, 1};

TEST(Morph, WeightsOfTheNodeThenOfTheMesh) {
  Builder builder;
  Json& primitive = builder.mesh(
      {{"POSITION", builder.floats(kTriangle, "VEC3", 3)}, {"NORMAL", builder.floats(kThreeUp, "VEC3", 3)}});
  primitive["targets"] = {{{"POSITION", builder.floats({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3", 3)}},
                          {{"POSITION", builder.floats({4, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3)},
                           {"NORMAL", builder.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3)}}};
  const Scene rest = builder.load();
  EXPECT_EQ(rest.primitives.at(0).vertices[0].position, glm::vec3(0.0f));
  builder.json["meshes"][0]["weights"] = {0.5, 0};
  builder.json["nodes"].push_back({{"mesh", 0}, {"weights", {0, 1}}});
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 2u);
  const auto vertex = [&](std::size_t instance) {
    return scene.primitives.at(static_cast<std::size_t>(scene.instances[instance].primitive)).vertices[0];
  };
  EXPECT_EQ(vertex(0).position, glm::vec3(0, 0, 1));
  EXPECT_EQ(vertex(0).normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(vertex(1).position, glm::vec3(4, 0, 0));
  EXPECT_LT(glm::length(vertex(1).normal - glm::normalize(glm::vec3(1, 0, 1))), 1e-6f);
  builder.json["nodes"][1]["weights"] = {1, 1};
  builder.json.erase("buffers");
  builder.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = builder.floats({0, 0, 0}, "VEC3", 3);
  expectRefusal(refusalOf(builder), 3, {"targets[0]", "1 elements", "expected 3"});
}

TEST(Morph, ColoursAndTextureCoordinates) {
  Builder builder;
  Json& primitive = builder.mesh({{"POSITION", builder.floats(kTriangle, "VEC3", 3)},
                                  {"TEXCOORD_0", builder.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2)},
                                  {"COLOR_0", builder.floats({.5f, .5f, .5f, 1, 1, 1, 0, 0, 0}, "VEC3", 3)}});
  primitive["targets"] = {{{"COLOR_0", builder.floats({-.5f, .25f, 0, 9, 1, -1, -1, -9, .5f, .5f, .5f, 0}, "VEC4", 4)},
                           {"TEXCOORD_0", builder.floats({1, 2, 0, 0, 0, 0}, "VEC2", 2)}}};
  builder.json["meshes"][0]["weights"] = {0.5};
  const std::vector<Vertex> vertices = builder.load().primitives.at(0).vertices;
  EXPECT_EQ(vertices[0].colour, glm::vec4(.25f, .625f, .5f, 1)) << "an alpha that only the target has is left";
  EXPECT_EQ(vertices[1].colour, glm::vec4(1, .5f, .5f, 1)) << "clamped after the sum";
  EXPECT_EQ(vertices[2].colour, glm::vec4(.25f, .25f, .25f, 1));
  EXPECT_EQ(vertices[0].uv[0], glm::vec2(.5f, 1));
}

// Two joints: the first stands, the second is turned a quarter about x and moved. The third vertex is half of each.
Builder skinned() {
  Builder builder;
  builder.mesh(
      {{"POSITION", builder.floats(kTriangle, "VEC3", 3)},
       {"NORMAL", builder.floats(kThreeUp, "VEC3", 3)},
       {"JOINTS_0", builder.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4)},
       {"WEIGHTS_0", builder.accessor(std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 120, 120, 0, 0}, 5121,
                                      "VEC4", 4, true)}});
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["nodes"][0]["translation"] = {100, 100, 100};  // does not count
  const double half = std::sqrt(0.5);
  builder.json["nodes"].push_back(Json::object());
  builder.json["nodes"].push_back({{"rotation", {half, 0, 0, half}}, {"translation", {0, 0, 5}}});
  std::vector<float> inverse(32, 0.0f);
  for (const std::size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) inverse[i] = 1.0f;
  inverse[16 + 12] = -1.0f;  // the second joint was bound at x = 1
  builder.json["skins"].push_back({{"joints", {1, 2}}, {"inverseBindMatrices", builder.floats(inverse, "MAT4", 16)}});
  return builder;
}

TEST(Skin, JointsPlaceTheVertices) {
  SceneOptions centimetres;
  centimetres.metresPerUnit = 0.01;
  for (const SceneOptions& options : {SceneOptions{}, centimetres}) {
    Builder builder = skinned();
    const Scene scene = builder.load(options);
    EXPECT_TRUE(scene.notes.empty());
    const Primitive& primitive = scene.primitives.at(0);
    const glm::dmat4& world = scene.instances.at(0).worldFromObject;
    const auto at = [&](std::size_t i) {
      return glm::vec3(world * glm::dvec4(glm::dvec3(primitive.vertices[i].position), 1.0) / options.metresPerUnit);
    };
    EXPECT_LT(glm::length(at(0) - glm::vec3(0, 0, 0)), 1e-5f);
    EXPECT_LT(glm::length(at(1) - glm::vec3(0, 0, 5)), 1e-5f);
    // Half of (0,1,0) and of (-1,0,6): y turns to z.
    EXPECT_LT(glm::length(at(2) - glm::vec3(-0.5f, 0.5f, 3)), 1e-5f);
    EXPECT_LT(glm::length(primitive.vertices[1].normal - glm::vec3(0, -1, 0)), 1e-5f);
  }
}

// The triangle as it stands in view: it faces where its normals point, and its tangent frame goes along with it: the
// hand times normal x tangent points to where v rises.
void expectOneSide(const Scene& scene, std::size_t number, const std::string& what) {
  const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(scene.instances.at(number).primitive));
  const Placed placed = placeInstances(scene, Camera{}).at(number);
  glm::dvec3 p[3], origin(0.0), up(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& vertex = primitive.vertices[primitive.indices[i]];
    p[i] = glm::dvec3(placed.viewFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0));
    if (vertex.uv[0] == glm::vec2(0.0f)) origin = p[i];
    if (vertex.uv[0] == glm::vec2(0.0f, 1.0f)) up = p[i];
  }
  const glm::dvec3 facing = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  const glm::dvec3 normal = glm::normalize(glm::dvec3(placed.normalFromObject * primitive.vertices[0].normal));
  EXPECT_LT(glm::length(facing - normal), 1e-5) << what;
  const glm::vec4 tangent = shading::unpackTangent(primitive.vertices[0].tangent);
  const glm::dvec3 along(glm::mat3(placed.viewFromObject) * glm::vec3(tangent));
  const glm::dvec3 across = glm::cross(normal, along) * static_cast<double>(tangent.w);
  EXPECT_GT(glm::dot(across, up - origin), 0.0) << what;
}

// glTF 2.0, 3.7.4: what mirrors flips the winding; for a skin that is its joints, not its node.
TEST(Skin, MirroredJointsFlipTheWinding) {
  const double half = std::sqrt(0.5);
  for (const Json& scale : {Json{1, 1, 1}, Json{-1, 1, 1}, Json{1, -1, 1}, Json{1, 1, -1}, Json{-1, -1, 1},
                            Json{-1, -1, -1}, Json{-2, 3, .5}})
    for (const bool instanced : {false, true})
      for (const int joint : {0, 1}) {
        Builder builder = skinned();
        Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["TANGENT"] = builder.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
        attributes["TEXCOORD_0"] = builder.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
        const auto k = static_cast<std::uint8_t>(joint);
        attributes["JOINTS_0"] =
            builder.accessor(std::vector<std::uint8_t>{k, 0, 0, 0, k, 0, 0, 0, k, 0, 0, 0}, 5121, "VEC4", 4);
        attributes["WEIGHTS_0"] = builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
        if (joint == 1)  // the joint alone
          builder.json["nodes"][2]["scale"] = scale;
        else  // or all of it
          builder.json["nodes"].push_back(
              {{"scale", scale}, {"rotation", {0, half, 0, half}}, {"children", {0, 1, 2}}});
        if (instanced)
          builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
              {"SCALE", builder.floats({1, 1, 1, -1, 1, 1}, "VEC3", 3)}};
        const Scene scene = builder.load();
        ASSERT_EQ(scene.instances.size(), instanced ? 2u : 1u);
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
          expectOneSide(scene, i, scale.dump() + " joint " + std::to_string(joint) + " instance " + std::to_string(i));
      }
}

TEST(Skin, DamageIsRefused) {
  const auto changed = [](const std::function<void(Builder&)>& change) {
    Builder builder = skinned();
    change(builder);
    return refusalOf(builder);
  };
  expectRefusal(changed([](Builder& b) { b.json["skins"][0]["joints"] = {1}; }), 3, {"JOINTS_0", "joint 1", "below 1"});
  expectRefusal(changed([](Builder& b) { b.json["skins"][0]["joints"] = {1, 9}; }), 3, {"skins[0].joints[1]", "9"});
  expectRefusal(changed([](Builder& b) {
                  b.json["skins"][0]["joints"] = {1, 2, 2};
                }),
                3, {"inverseBindMatrices", "are 2", "3 joints"});
  expectRefusal(changed([](Builder& b) { b.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0"); }), 3,
                {"WEIGHTS_0"});
  Builder unbound = skinned();
  const int weights = unbound.floats(std::vector<float>(12, 0.0f), "VEC4", 4);
  unbound.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
  EXPECT_TRUE(noted(unbound.load(), "3 vertices of skins have no weight"));
}

}  // namespace
}  // namespace pellucid::test
