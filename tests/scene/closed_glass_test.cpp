// Closed meshes of glass from an exporter that writes no volumes: which of them are bodies, and what is said.
#include <cmath>

#include "shaders/closed_body_text.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

const char* const kBlender = "Khronos glTF Blender I/O v3.4.50";

struct Shape {
  std::vector<float> points;
  std::vector<std::uint16_t> indices;
};

Shape boxShape(float x, float y, float z) {
  Shape shape;
  for (int k = 0; k < 8; ++k)
    for (const float value : {k & 1 ? x : -x, k & 2 ? y : -y, k & 4 ? z : -z}) shape.points.push_back(value + 3.0f);
  shape.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return shape;
}

Shape ballShape(int rings, float stretch) {
  Shape shape;
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < around; ++i) {
      const float up = 3.14159265f * static_cast<float>(j) / static_cast<float>(rings),
                  turn = 3.14159265f * static_cast<float>(i) / static_cast<float>(rings);
      for (const float value : {std::sin(up) * std::cos(turn), stretch * std::cos(up), -std::sin(up) * std::sin(turn)})
        shape.points.push_back(value);
    }
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const auto a = static_cast<std::uint16_t>(j * around + i),
                 b = static_cast<std::uint16_t>(j * around + (i + 1) % around);
      const auto c = static_cast<std::uint16_t>(a + around), d = static_cast<std::uint16_t>(b + around);
      for (const std::uint16_t index : {a, c, d, a, d, b}) shape.indices.push_back(index);
    }
  return shape;
}

Shape octahedron() {
  return {{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1},
          {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}};
}

struct Glass {
  std::string generator = kBlender;
  Json material = {{"name", "glass"}, {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
  std::vector<Shape> shapes;
  Json used = Json::array({"KHR_materials_transmission"});
  bool asked = true;
  std::vector<std::string> overrides = {};
  std::size_t streamBytes = 0;

  Scene load() const {
    Builder builder;
    builder.json["asset"]["generator"] = generator;
    builder.json["extensionsUsed"] = used;
    builder.json["materials"].push_back(material);
    for (const Shape& shape : shapes) {
      const int points = builder.floats(shape.points, "VEC3", 3), indices = builder.indices(shape.indices);
      Json& primitive = builder.mesh({{"POSITION", points}});
      primitive["indices"] = indices;
      primitive["material"] = 0;
    }
    SceneOptions options;
    options.closedGlass = asked;
    options.overrides = overrides;
    options.streamBytes = streamBytes;
    return builder.load(options);
  }
};

bool says(const Scene& scene, const std::string& words) {
  for (const std::string& note : scene.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

void expectThin(const Glass& glass, const char* what) {
  const Scene scene = glass.load();
  EXPECT_FALSE(scene.materials.at(0).hasInterior()) << what;
  EXPECT_FALSE(says(scene, "--thin")) << what;
  for (const Primitive& primitive : scene.primitives) EXPECT_FALSE(primitive.body) << what;
}

TEST(ClosedGlass, BoxesAndBallsAreBodies) {
  Glass box;
  box.shapes = {boxShape(1.0f, 0.02f, 2.0f)};
  const Scene slab = box.load();
  EXPECT_TRUE(slab.materials.at(0).hasInterior());
  ASSERT_TRUE(slab.primitives.at(0).body);
  EXPECT_EQ(slab.primitives[0].body->kind, shading::PLD_BODY_BOX);
  const glm::dvec3 corner(slab.primitives[0].body->fromObject * glm::dvec4(4.0, 3.02, 5.0, 1.0));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(corner[k], 1.0, 1e-4);
  EXPECT_TRUE(says(slab, "material glass is glass of index 1.5 and fills a box")) << slab.notes.at(0);
  EXPECT_TRUE(says(slab, "--thin file leaves it a thin sheet"));

  Glass ball;
  ball.shapes = {ballShape(10, 0.5f)};
  for (const std::size_t pages : {std::size_t{0}, std::size_t{1} << 20}) {
    ball.streamBytes = pages;
    const Scene bead = ball.load();
    ASSERT_TRUE(bead.primitives.at(0).body) << pages;
    EXPECT_EQ(bead.primitives[0].body->kind, shading::PLD_BODY_BALL);
    EXPECT_NEAR(bead.primitives[0].body->fromObject[1][1], 2.0, 1e-5);
    EXPECT_TRUE(says(bead, "fills a ball"));
  }
  ball.shapes.push_back(boxShape(1, 1, 1));
  EXPECT_TRUE(says(ball.load(), "fills balls and boxes"));
}

TEST(ClosedGlass, WhatIsNotClosedOrOfAnotherShapeStaysThin) {
  Glass glass;
  glass.shapes = {boxShape(1, 1, 1)};
  glass.shapes[0].indices.resize(33);
  expectThin(glass, "a triangle is missing");
  glass.shapes = {boxShape(1, 1, 1)};
  const std::vector<std::uint16_t> once = glass.shapes[0].indices;
  glass.shapes[0].indices.insert(glass.shapes[0].indices.end(), once.begin(), once.end());
  expectThin(glass, "every triangle is there twice");
  glass.shapes = {octahedron()};
  expectThin(glass, "corners on a ball, faces far within it");
  glass.shapes = {boxShape(1, 1, 0)};
  expectThin(glass, "flat");
  glass.shapes = {boxShape(1, 1, 1), octahedron()};
  expectThin(glass, "one of two");
}

TEST(ClosedGlass, FilesThatSpeakOfVolumesAndOtherMaterialsStayAsTheyAre) {
  Glass glass;
  glass.shapes = {boxShape(1, 1, 1)};
  Glass other = glass;
  other.generator = "COLLADA2GLTF";
  expectThin(other, "another exporter");
  other = glass;
  other.used.push_back("KHR_materials_volume");
  expectThin(other, "the file knows volumes");
  other = glass;
  other.material["extensions"]["KHR_materials_ior"] = {{"ior", 1.0}};
  expectThin(other, "of index 1");
  other = glass;
  other.material.erase("extensions");
  other.material["alphaMode"] = "BLEND";
  expectThin(other, "no transmission");
  other = glass;
  other.material["extras"] = {{"pellucid", {{"thin", true}}}};
  expectThin(other, "it says so");
  other = glass;
  other.asked = false;
  expectThin(other, "--thin file");
  other = glass;
  other.overrides = {"glass.thin=true"};
  EXPECT_FALSE(other.load().materials.at(0).hasInterior());
}

}  // namespace
}  // namespace pellucid::test
