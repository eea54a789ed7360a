// Fragments that hide everything, and the rims of cut-out surfaces.
#include <gtest/gtest.h>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/solidity.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

Material cutOut(glm::vec3 colour, int texture) {
  Material material = unlitBlend(colour, 1.0f);
  material.alphaMode = AlphaMode::mask;
  material.baseColorTexture.texture = texture;
  return material;
}

// Alpha rises from 0 to 1 over the texture's width.
int ramp(Stage& stage, int width) {
  std::vector<glm::vec4> texels;
  for (int i = 0; i < width; ++i)
    texels.emplace_back(1.0f, 1.0f, 1.0f, (static_cast<float>(i) + 0.5f) / static_cast<float>(width));
  return stage.texture(width, 1, texels);
}

TEST(Mask, SmoothRimFollowsTheSharedFormula) {
  Stage stage(64, 8);
  stage.quad(0, 0, 64, 8, 2.0, stage.add(cutOut({0.5f, 0.5f, 0.5f}, ramp(stage, 16))));
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  const OitPlanes planes = stage.accumulate(settings);
  // Alpha grows by 1/64 a pixel: the rim is one pixel wide around alpha = cutoff, x = 32.
  for (int x = 4; x < 60; ++x) {
    const float alpha = (static_cast<float>(x) + 0.5f) / 64.0f;
    const float expected = shading::rimCoverage(alpha, 0.5f, 1.0f / 64.0f);
    const bool solid = std::isfinite(planes.solid.at(x, 4).a);
    EXPECT_NEAR(solid ? 1.0f : planes.opacity.at(x, 4).r, expected, 1e-3f) << x;  // texture filters have 8 bits
    EXPECT_EQ(solid, x >= 32) << x;  // pixel 32 lies exactly half a pixel inside
  }
}

TEST(Mask, HardCutHasNoRim) {
  Stage stage(64, 8);
  stage.quad(0, 0, 64, 8, 2.0, stage.add(cutOut({0.5f, 0.5f, 0.5f}, ramp(stage, 16))));
  PassSettings settings;
  settings.filter = TextureFilter::nearest;
  settings.mask = MaskEdge::hard;
  const OitPlanes planes = stage.accumulate(settings);
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(planes.weight.at(x, 4).a, 0.0f) << x;
    EXPECT_EQ(std::isfinite(planes.solid.at(x, 4).a), x >= 32) << x;
  }
}

TEST(Mask, ZeroCutoffPassesEverything) {
  Stage stage(16, 8);
  Material material = cutOut({0.5f, 0.5f, 0.5f}, stage.texture(1, 1, {glm::vec4(1, 1, 1, 0)}));
  material.alphaCutoff = 0.0f;
  stage.quad(0, 0, 16, 8, 2.0, stage.add(material));
  EXPECT_EQ(stage.accumulate().solid.at(8, 4).a, 2.0f);
}

TEST(Solid, NearestIsKeptAndBoundsTheLayers) {
  Stage stage(16, 8);
  const int leaf = stage.add(unlitBlend({0.1f, 0.8f, 0.2f}, 1.0f));
  const int glass = stage.add(unlitBlend({1, 1, 1}, 0.25f));
  stage.quad(0, 0, 16, 8, 6.0, leaf);
  stage.quad(0, 0, 16, 8, 4.0, leaf);
  stage.quad(0, 0, 16, 8, 3.0, glass);
  stage.quad(0, 0, 16, 8, 5.0, glass);
  const OitPlanes planes = stage.accumulate();
  const glm::vec4 solid = planes.solid.at(8, 4);
  EXPECT_EQ(glm::vec3(solid), glm::vec3(0.1f, 0.8f, 0.2f));
  EXPECT_NEAR(solid.a, 4.0f, 1e-6f);
  EXPECT_EQ(planes.weight.at(8, 4).a, 1.0f);  // the glass at 3 alone
  EXPECT_EQ(planes.opacity.at(8, 4).r, 0.25f);
  EXPECT_NE(planes.info.solidHash, "");
}

TEST(Solid, OpaqueDepthHidesSolidsToo) {
  Stage stage(8, 8);
  stage.quad(0, 0, 8, 8, 6.0, stage.add(unlitBlend({1, 1, 1}, 1.0f)));
  stage.gbuffer.viewZ = Image<float>(8, 8, 5.0f);
  const OitPlanes planes = stage.accumulate();
  EXPECT_EQ(planes.solid.at(4, 4).a, kSky);
  EXPECT_EQ(planes.info.solidHash, "");
}

TEST(Solid, TiesTakeTheLargestOfEachChannelInAnyOrder) {
  for (const auto kind : {SubmissionOrder::file, SubmissionOrder::reverse}) {
    Stage stage(16, 8);
    stage.quad(0, 0, 16, 8, 4.0, stage.add(unlitBlend({0.9f, 0.1f, 0.3f}, 1.0f)));
    stage.quad(0, 0, 16, 8, 4.0, stage.add(unlitBlend({0.2f, 0.7f, 0.3f}, 1.0f)));
    PassSettings settings;
    settings.order.kind = kind;
    EXPECT_EQ(glm::vec3(stage.accumulate(settings).solid.at(8, 4)), glm::vec3(0.9f, 0.7f, 0.3f));
  }
}

struct Case {
  const char* what;
  bool solid;
  Material material;
};

TEST(Solid, PassIsSkippedExactlyWhereNothingCanBeSolid) {
  Stage stage(8, 8);
  const int fades = stage.texture(2, 1, {glm::vec4(1, 1, 1, 0.2f), glm::vec4(1, 1, 1, 0.9f)});
  const int reachesOne = stage.texture(2, 1, {glm::vec4(1, 1, 1, 0.2f), glm::vec4(1, 1, 1, 1)});
  const int holes = stage.texture(2, 1, {glm::vec4(0, 1, 1, 1), glm::vec4(1, 1, 1, 1)});
  std::vector<Case> cases;
  auto add = [&](const char* what, bool solid, auto change) {
    Material material;
    material.metallic = 0.0f;
    change(material);
    cases.push_back({what, solid, material});
  };
  add("blend .5", false, [](Material& m) { m.alphaMode = AlphaMode::blend, m.baseColor.a = 0.5f; });
  add("blend 1", true, [](Material& m) { m.alphaMode = AlphaMode::blend; });
  add("blend, texture to .9", false,
      [&](Material& m) { m.alphaMode = AlphaMode::blend, m.baseColorTexture.texture = fades; });
  add("blend, texture to 1", true,
      [&](Material& m) { m.alphaMode = AlphaMode::blend, m.baseColorTexture.texture = reachesOne; });
  add("mask", true, [&](Material& m) { m.alphaMode = AlphaMode::mask; });
  add("clear glass", false, [](Material& m) { m.transmission = 1.0f; });
  add("half transmissive", false, [](Material& m) { m.transmission = 0.5f; });
  add("metal 'glass'", true, [](Material& m) { m.transmission = 1.0f, m.metallic = 1.0f; });
  add("black glass", true, [](Material& m) { m.transmission = 1.0f, m.baseColor = glm::vec4(0, 0, 0, 1); });
  add("red glass", false, [](Material& m) { m.transmission = 1.0f, m.baseColor = glm::vec4(1, 0, 0, 1); });
  add("glass, transmission texture with holes", true,
      [&](Material& m) { m.transmission = 1.0f, m.transmissionTexture.texture = holes; });
  add("endless ink", true, [](Material& m) {
    m.transmission = 1.0f, m.volume = true, m.thickness = 1000.0f, m.attenuationDistance = 1.0f;
    m.attenuationColor = glm::vec3(0.1f);
  });
  add("additive", false, [](Material& m) { m.additive = true, m.alphaMode = AlphaMode::blend; });
  add("coverage .5", false, [](Material& m) { m.coverage = 0.5f; });
  for (Case& one : cases) {
    one.material.doubleSided = true;
    stage.scene.materials.push_back(one.material);
  }
  GlContext context;
  const gl::SceneTextures textures(stage.scene);
  for (const Case& one : cases) EXPECT_EQ(gl::canBeSolid(one.material, {}, textures, 1.0f), one.solid) << one.what;
  // And what the rule calls solid is what the shader finds so, where no texture varies.
  for (const Case& one : cases) {
    if (one.material.baseColorTexture.texture >= 0 || one.material.transmissionTexture.texture >= 0) continue;
    Stage drawn(8, 8);
    drawn.quad(0, 0, 8, 8, 2.0, drawn.add(one.material));
    EXPECT_EQ(std::isfinite(drawn.accumulate().solid.at(4, 4).a), one.solid) << one.what;
  }
}

// A smooth sphere's silhouette has normals that graze the eye: glass must not turn solid there.
TEST(Solid, GlassSilhouettesStayGlass) {
  Stage stage(128, 128);
  Material glass;
  glass.transmission = 1.0f;
  glass.metallic = 0.0f;
  glass.doubleSided = true;
  Primitive sphere;
  sphere.material = stage.add(glass);
  const int rings = 24, sectors = 48;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s <= sectors; ++s) {
      const double theta = 3.14159265358979 * r / rings, phi = 2 * 3.14159265358979 * s / sectors;
      Vertex vertex{};
      vertex.normal = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      vertex.position = vertex.normal + glm::vec3(0, 0, -4);
      vertex.colour = glm::vec4(1.0f);
      sphere.vertices.push_back(vertex);
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const std::uint32_t a = r * (sectors + 1) + s, b = a + sectors + 1;
      for (const std::uint32_t i : {a, b, a + 1, a + 1, b, b + 1}) sphere.indices.push_back(i);
    }
  stage.place(std::move(sphere));
  for (const FragmentLists& lists : stage.fragments()) {
    for (std::size_t i = 0; i < lists.solid.size(); ++i) ASSERT_EQ(lists.solid[i].a, kSky);
    ASSERT_GT(lists.fragments.size(), 1000u);
    for (const Fragment& fragment : lists.fragments) ASSERT_GT(fragment.transmission.g, 0.0f);
  }
}

}  // namespace
}  // namespace pellucid::test
