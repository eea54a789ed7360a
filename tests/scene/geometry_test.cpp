// Accessors and primitives: every layout glTF allows comes out as the same triangles.
#include <cmath>
#include <limits>

#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kTallUp = {0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2};

// The corners' positions of all triangles, in order.
std::vector<glm::vec3> corners(const Primitive& primitive) {
  std::vector<glm::vec3> result;
  for (const std::uint32_t i : primitive.indices) result.push_back(primitive.vertices.at(i).position);
  return result;
}

TEST(Geometry, UnindexedTriangleGetsAFlatNormalAndDefaults) {
  Builder builder;
  builder.triangle();
  const Scene scene = builder.load();
  ASSERT_EQ(scene.primitives.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 1u);
  const Primitive& primitive = scene.primitives[0];
  EXPECT_EQ(corners(primitive), (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  for (const Vertex& vertex : primitive.vertices) {
    EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(vertex.colour, glm::vec4(1.0f));
    EXPECT_EQ(vertex.uv[0], glm::vec2(0.0f));
  }
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(primitive.material)).name, "default");
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Geometry, AllIndexTypesAgree) {
  const auto load = [](const std::function<int(Builder&)>& indices) {
    Builder builder;
    Json& primitive = builder.mesh(
        {{"POSITION", builder.floats(kSquare, "VEC3", 3)}, {"NORMAL", builder.floats(kTallUp, "VEC3", 3)}});
    primitive["indices"] = indices(builder);
    return builder.load().primitives.at(0);
  };
  const Primitive bytes = load([](Builder& b) {
    return b.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 5121, "SCALAR", 1);
  });
  const Primitive shorts = load([](Builder& b) { return b.indices({0, 1, 2, 0, 2, 3}); });
  const Primitive words = load([](Builder& b) {
    return b.accessor(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 5125, "SCALAR", 1);
  });
  EXPECT_EQ(bytes.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(shorts.indices, bytes.indices);
  EXPECT_EQ(words.indices, bytes.indices);
  EXPECT_EQ(bytes.vertices.size(), 4u);
  EXPECT_EQ(bytes.vertices[0].normal, glm::vec3(0, 0, 1)) << "normals become unit";
}

TEST(Geometry, StripAndFanAreTheTrianglesOfTheSpecification) {
  Builder strip;
  strip.mesh({{"POSITION", strip.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3)}})["mode"] = 5;
  EXPECT_EQ(corners(strip.load().primitives.at(0)),
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  Builder fan;
  fan.mesh({{"POSITION", fan.floats(kSquare, "VEC3", 3)}})["mode"] = 6;
  EXPECT_EQ(corners(fan.load().primitives.at(0)),
            (std::vector<glm::vec3>{{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}));
}

TEST(Geometry, AStripsJumpIsSilentAndADegenerateTriangleIsCounted) {
  Builder strip;
  Json& jump = strip.mesh({{"POSITION", strip.floats(kSquare, "VEC3", 3)}});
  jump["mode"] = 5;
  jump["indices"] = strip.indices({0, 1, 2, 2, 3, 3, 0});
  EXPECT_TRUE(strip.load().notes.empty());
  Builder list;
  Json& line = list.mesh({{"POSITION", list.floats({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0}, "VEC3", 3)}});
  line["indices"] = list.indices({0, 1, 2, 0, 1, 3});
  const Scene scene = list.load();
  EXPECT_EQ(scene.primitives.at(0).indices.size(), 3u);
  EXPECT_TRUE(noted(scene, "1 triangles have no area"));
}

TEST(Geometry, PositionsThatAreNotFiniteTakeTheirTrianglesAlong) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Builder builder;
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    positions[4] = bad;
    builder.mesh({{"POSITION", builder.floats(positions, "VEC3", 3)}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.primitives.at(0).vertices.size(), 3u);
    for (const Vertex& vertex : scene.primitives[0].vertices) EXPECT_TRUE(std::isfinite(vertex.position.y));
    EXPECT_TRUE(noted(scene, "1 triangles have a position that is not finite"));
  }
}

TEST(Geometry, HugeAndTinyTrianglesKeepUnitNormals) {
  for (const float size : {1e-30f, 1e-10f, 1e10f, 3e38f}) {
    Builder builder;
    builder.mesh({{"POSITION", builder.floats({0, 0, 0, size, 0, 0, 0, size, 0}, "VEC3", 3)}});
    EXPECT_EQ(builder.load().primitives.at(0).vertices.at(0).normal, glm::vec3(0, 0, 1)) << size;
  }
}

TEST(Geometry, NormalsWithoutDirectionAreReplacedByTheTriangles) {
  Builder builder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  builder.mesh({{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)},
                {"NORMAL", builder.floats({0, 0, 0, nan, 0, 0, 1, 0, 0}, "VEC3", 3)}});
  const Scene scene = builder.load();
  EXPECT_EQ(scene.primitives.at(0).vertices.at(0).normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.primitives.at(0).vertices.at(1).normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.primitives.at(0).vertices.at(2).normal, glm::vec3(1, 0, 0));
  EXPECT_TRUE(noted(scene, "2 normals have no direction"));
}

TEST(Geometry, InterleavedAndSparseAccessors) {
  Builder builder;
  // Position and UV, 20 bytes apart, in one view.
  std::vector<float> rows;
  for (int i = 0; i < 3; ++i) {
    for (const float v : {kSquare[static_cast<std::size_t>(3 * i)], kSquare[static_cast<std::size_t>(3 * i + 1)], 0.0f,
                          0.25f * static_cast<float>(i), 0.5f}) {
      rows.push_back(v);
    }
  }
  const int view = builder.view(rows.data(), rows.size() * sizeof(float));
  builder.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 20;
  const std::vector<std::uint16_t> which = {2};
  const std::vector<float> moved = {7, 8, 9};
  const int indexView = builder.view(which.data(), 2), valueView = builder.view(moved.data(), 12);
  Json position = {{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}};
  position["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
                        {"values", {{"bufferView", valueView}}}};
  builder.json["accessors"].push_back(position);
  builder.json["accessors"].push_back(
      {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 3}});
  builder.mesh({{"POSITION", 0}, {"TEXCOORD_0", 1}});
  const Primitive primitive = builder.load().primitives.at(0);
  EXPECT_EQ(corners(primitive), (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {7, 8, 9}}));
  EXPECT_EQ(primitive.vertices[1].uv[0], glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(primitive.vertices[2].uv[0], glm::vec2(0.5f, 0.5f));
}

TEST(Geometry, SparseWithoutAViewStartsFromZeros) {
  Builder builder;
  const std::vector<std::uint8_t> which = {1, 2};
  const std::vector<float> values = {1, 0, 0, 0, 1, 0};
  const int indexView = builder.view(which.data(), 2), valueView = builder.view(values.data(), 24);
  builder.json["accessors"].push_back({{"componentType", 5126},
                                       {"type", "VEC3"},
                                       {"count", 3},
                                       {"sparse",
                                        {{"count", 2},
                                         {"indices", {{"bufferView", indexView}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", valueView}}}}}});
  builder.mesh({{"POSITION", 0}});
  EXPECT_EQ(corners(builder.load().primitives.at(0)), (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Geometry, NormalisedIntegersAndBothColourWidths) {
  Builder builder;
  const int position = builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const int uv0 = builder.accessor(std::vector<std::uint16_t>{0, 65535, 32768, 0, 0, 0}, 5123, "VEC2", 2, true);
  const int uv1 = builder.accessor(std::vector<std::uint8_t>{0, 255, 51, 0, 0, 0}, 5121, "VEC2", 2, true);
  const int colour =
      builder.accessor(std::vector<std::uint8_t>{255, 0, 51, 102, 0, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4, true);
  builder.mesh({{"POSITION", position}, {"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}, {"COLOR_0", colour}});
  const Scene scene = builder.load();
  const Vertex& first = scene.primitives.at(0).vertices.at(0);
  EXPECT_EQ(first.uv[0], glm::vec2(0.0f, 1.0f));
  EXPECT_EQ(scene.primitives[0].vertices[1].uv[0], glm::vec2(32768.0f / 65535.0f, 0.0f));
  EXPECT_EQ(scene.primitives[0].vertices[1].uv[1], glm::vec2(0.2f, 0.0f));
  EXPECT_EQ(first.colour, glm::vec4(1.0f, 0.0f, 51.0f / 255.0f, 102.0f / 255.0f));

  Builder three;
  three.mesh({{"POSITION", three.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)},
              {"COLOR_0", three.floats({0.5f, 0.25f, 2.0f, 1, 1, 1, 1, 1, 1}, "VEC3", 3)}});
  const Scene clamped = three.load();
  EXPECT_EQ(clamped.primitives.at(0).vertices.at(0).colour, glm::vec4(0.5f, 0.25f, 1.0f, 1.0f));
  EXPECT_TRUE(noted(clamped, "1 vertex colours or texture coordinates are out of range"));
}

TEST(Geometry, OpaquePointsAndLinesAreNotedAndSkipped) {
  Builder builder;
  builder.triangle()["mode"] = 0;
  builder.triangle()["mode"] = 3;
  builder.triangle();
  const Scene scene = builder.load();
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(noted(scene, "1 primitives are lines"));
  EXPECT_TRUE(noted(scene, "its points are opaque"));
}

// As exporters write what is hidden or has no face.
TEST(Geometry, EmptyPrimitivesAreNotedAndSkipped) {
  Builder builder;
  builder.triangle();
  Json& accessors = builder.json["accessors"];
  const auto none = [&](const char* type, int component) {
    accessors.push_back({{"componentType", component}, {"count", 0}, {"type", type}});
    return accessors.size() - 1;
  };
  builder.triangle()["indices"] = none("SCALAR", 5123);
  builder.triangle()["attributes"] = {{"POSITION", none("VEC3", 5126)}};
  const Scene scene = builder.load();
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(noted(scene, "is empty and is not drawn"));
}

TEST(Geometry, OnlyVerticesThatTrianglesUseAreKept) {
  Builder builder;
  std::vector<float> positions(3000, 0.0f), normals;
  for (std::size_t i = 0; i < 1000; ++i) {
    positions[3 * i] = static_cast<float>(i);
    positions[3 * i + 1] = static_cast<float>(i * i);
    normals.insert(normals.end(), {0, 0, 1});
  }
  const int position = builder.floats(positions, "VEC3", 3), normal = builder.floats(normals, "VEC3", 3);
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}})["indices"] = builder.indices({997, 998, 999});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}})["indices"] = builder.indices({0, 1, 2, 2, 1, 999});
  const Scene scene = builder.load();
  EXPECT_EQ(scene.primitives.at(0).vertices.size(), 3u);
  EXPECT_EQ(scene.primitives.at(0).vertices[2].position.x, 999.0f);
  EXPECT_EQ(scene.primitives.at(1).vertices.size(), 4u) << "nothing is left over from the primitive before";
  EXPECT_EQ(scene.primitives.at(1).indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
}

}  // namespace
}  // namespace pellucid::test
