// What the stage fetches and lights: textures the right way up, lights in closed form.
#include <gtest/gtest.h>

#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

constexpr float kPi = 3.14159265f;

// The single fragment's L_r at a pixel; coverage .5 keeps it out of the solid plane.
glm::vec3 reflectedAt(const OitPlanes& planes, int x, int y) {
  const glm::vec4 weighted = planes.radiance.at(x, y), weight = planes.weight.at(x, y);
  return glm::vec3(weighted) / glm::vec3(weight);
}

PassSettings uniformWeight() {
  PassSettings settings;
  settings.weight.kind = shading::PLD_WEIGHT_UNIFORM;
  return settings;
}

// Lambertian: no interface, all diffuse.
Material matte(float albedo) {
  Material material = unlitBlend(glm::vec3(albedo), 0.5f);
  material.unlit = false;
  material.metallic = 0.0f;
  material.roughness = 1.0f;
  material.ior = 1.0f;
  return material;
}

TEST(Textures, RowZeroIsVZeroAndTheQuadsTop) {
  Stage stage(32, 32);
  Material material = unlitBlend({1, 1, 1}, 0.5f);
  material.baseColorTexture.texture =
      stage.texture(2, 2, {{0.1f, 0, 0, 1}, {0.2f, 0, 0, 1}, {0.3f, 0, 0, 1}, {0.4f, 0, 0, 1}});
  stage.quad(0, 0, 32, 32, 2.0, stage.add(material));
  PassSettings settings = uniformWeight();
  settings.filter = TextureFilter::nearest;
  const OitPlanes planes = stage.accumulate(settings);
  EXPECT_NEAR(reflectedAt(planes, 4, 4).r, 0.1f, 1e-6f);
  EXPECT_NEAR(reflectedAt(planes, 28, 4).r, 0.2f, 1e-6f);
  EXPECT_NEAR(reflectedAt(planes, 4, 28).r, 0.3f, 1e-6f);
  EXPECT_NEAR(reflectedAt(planes, 28, 28).r, 0.4f, 1e-6f);
}

TEST(Textures, TransformAndSecondSetAreHonoured) {
  Stage stage(32, 32);
  Material material = unlitBlend({1, 1, 1}, 0.5f);
  material.baseColorTexture.texture = stage.texture(2, 1, {{0.1f, 0, 0, 1}, {0.9f, 0, 0, 1}});
  material.baseColorTexture.texCoord = 1;
  // u' = 1 - v: the top of the quad reads the right texel.
  material.baseColorTexture.uvTransform = glm::mat3(0, 0, 0, -1, 0, 0, 1, 0.5f, 1);
  stage.quad(0, 0, 32, 32, 2.0, stage.add(material));
  for (Vertex& vertex : stage.scene.primitives[0].vertices) vertex.uv[0] = glm::vec2(0.0f);
  PassSettings settings = uniformWeight();
  settings.filter = TextureFilter::nearest;
  const OitPlanes planes = stage.accumulate(settings);
  EXPECT_NEAR(reflectedAt(planes, 16, 4).r, 0.9f, 1e-6f);
  EXPECT_NEAR(reflectedAt(planes, 16, 28).r, 0.1f, 1e-6f);
}

TEST(Textures, BilinearInterpolatesBetweenTexelCentres) {
  Stage stage(64, 8);
  Material material = unlitBlend({1, 1, 1}, 0.5f);
  material.baseColorTexture.texture = stage.texture(2, 1, {{0, 0, 0, 1}, {1, 1, 1, 1}});
  stage.quad(0, 0, 64, 8, 2.0, stage.add(material));
  PassSettings settings = uniformWeight();
  settings.filter = TextureFilter::bilinear;
  const OitPlanes planes = stage.accumulate(settings);
  for (int x = 0; x < 64; ++x) {
    const float u = (static_cast<float>(x) + 0.5f) / 64.0f;
    EXPECT_NEAR(reflectedAt(planes, x, 4).r, glm::clamp(2.0f * u - 0.5f, 0.0f, 1.0f), 2.0f / 256.0f) << x;
  }
}

TEST(Textures, MipmapsAverageAMinifiedCheckerboard) {
  Stage stage(16, 16);
  std::vector<glm::vec4> texels;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) texels.emplace_back(glm::vec3((x + y) % 2 ? 1.0f : 0.0f), 1.0f);
  Material material = unlitBlend({1, 1, 1}, 0.5f);
  material.baseColorTexture.texture = stage.texture(256, 256, texels);
  stage.quad(0, 0, 16, 16, 2.0, stage.add(material));
  PassSettings settings = uniformWeight();
  EXPECT_NEAR(reflectedAt(stage.accumulate(settings), 8, 8).r, 0.5f, 0.01f);
  settings.filter = TextureFilter::nearest;
  const float sampled = reflectedAt(stage.accumulate(settings), 8, 8).r;
  EXPECT_TRUE(sampled < 0.01f || sampled > 0.99f) << sampled;
}

TEST(Textures, VertexColourTransmissionEmissionAndRoughnessChannels) {
  Stage stage(16, 16);
  Material material;
  material.doubleSided = true;
  material.metallic = 1.0f;
  material.ior = 1.0f;
  material.transmission = 1.0f;
  material.emission = {2, 2, 2};
  material.baseColor = {0.8f, 0.8f, 0.8f, 1};
  material.transmissionTexture.texture = stage.texture(1, 1, {{0.5f, 1, 1, 1}});
  material.metallicRoughnessTexture.texture = stage.texture(1, 1, {{1, 1, 0.25f, 1}});
  material.emissiveTexture.texture = stage.texture(1, 1, {{0.1f, 0.2f, 0.3f, 1}});
  stage.quad(0, 0, 16, 16, 2.0, stage.add(material));
  for (Vertex& vertex : stage.scene.primitives[0].vertices) vertex.colour = {0.5f, 1, 0.25f, 1};
  const Fragment fragment = stage.fragments(uniformWeight())[0].fragments.at(0);
  // t = base * vertex colour * transmission (R) * (1 - metallic (B)).
  EXPECT_NEAR(fragment.transmission.r, 0.8f * 0.5f * 0.5f * 0.75f, 1e-6f);
  EXPECT_NEAR(fragment.transmission.g, 0.8f * 1.0f * 0.5f * 0.75f, 1e-6f);
  EXPECT_NEAR(fragment.transmission.b, 0.8f * 0.25f * 0.5f * 0.75f, 1e-6f);
  EXPECT_NEAR(fragment.radiance.r, 0.2f, 1e-6f);
  EXPECT_NEAR(fragment.radiance.g, 0.4f, 1e-6f);
  EXPECT_NEAR(fragment.radiance.b, 0.6f, 1e-6f);
}

TEST(Volume, AttenuatesOncePerCrossingInMetres) {
  Material glass;
  glass.doubleSided = glass.volume = true;
  glass.transmission = 1.0f;
  glass.metallic = 0.0f;
  glass.ior = 1.0f;
  glass.thickness = 0.1f;             // object space
  glass.attenuationDistance = 0.25f;  // metres
  glass.attenuationColor = {0.5f, 0.9f, 1.0f};
  for (const bool back : {false, true}) {
    Stage stage(8, 8);
    Instance& instance = stage.quad(0, 0, 8, 8, 1.0, stage.add(glass));
    instance.worldFromObject = glm::dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1);
    if (back) {
      std::swap(stage.scene.primitives[0].indices[1], stage.scene.primitives[0].indices[2]);
      std::swap(stage.scene.primitives[0].indices[4], stage.scene.primitives[0].indices[5]);
    }
    const Fragment fragment = stage.fragments()[0].fragments.at(0);
    const float ratio = back ? 0.0f : 0.1f * 2.0f / 0.25f;
    EXPECT_NEAR(fragment.transmission.r, std::pow(0.5f, ratio), 1e-6f);
    EXPECT_NEAR(fragment.transmission.g, std::pow(0.9f, ratio), 1e-6f);
    EXPECT_EQ(fragment.transmission.b, 1.0f);
  }
  glass.thin = true;
  Stage stage(8, 8);
  stage.quad(0, 0, 8, 8, 1.0, stage.add(glass));
  EXPECT_EQ(stage.fragments()[0].fragments.at(0).transmission.r, 1.0f);
}

TEST(Lights, DirectionalLambert) {
  for (const double tilt : {0.0, 0.5, 1.2, 1.8}) {
    Stage stage(16, 16);
    stage.quad(0, 0, 16, 16, 2.0, stage.add(matte(0.6f)));
    Light sun;
    sun.kind = LightKind::directional;
    sun.intensity = 3.0f;
    sun.colour = {1.0f, 0.5f, 0.25f};
    sun.direction = {std::sin(tilt), 0, -std::cos(tilt)};
    stage.scene.lights = {sun};
    const glm::vec3 found = reflectedAt(stage.accumulate(uniformWeight()), 8, 8);
    const float expected = 0.6f / kPi * 3.0f * std::max(0.0f, static_cast<float>(std::cos(tilt)));
    EXPECT_NEAR(found.r, expected, 2e-6f);
    EXPECT_NEAR(found.g, 0.5f * expected, 2e-6f);
    EXPECT_NEAR(found.b, 0.25f * expected, 2e-6f);
  }
}

TEST(Lights, PointOverAPlaneWithRange) {
  for (const float range : {0.0f, 3.0f}) {
    Stage stage(64, 64);
    stage.quad(0, 0, 64, 64, 4.0, stage.add(matte(0.6f)));
    // The camera stands elsewhere: lights are given in the world.
    const glm::dvec3 eye(10, -20, 30);
    stage.camera.viewFromWorld[3] = glm::dvec4(-eye, 1.0);
    stage.scene.instances[0].worldFromObject[3] = glm::dvec4(eye, 1.0);
    Light bulb;
    bulb.intensity = 5.0f;
    bulb.range = range;
    bulb.position = eye + glm::dvec3(0.3, -0.2, -2.5);
    stage.scene.lights = {bulb};
    const OitPlanes planes = stage.accumulate(uniformWeight());
    for (const int x : {3, 20, 32, 50})
      for (const int y : {5, 30, 60}) {
        const glm::dvec3 point(stage.at(x + 0.5, y + 0.5, 4.0));
        const glm::dvec3 path = glm::dvec3(0.3, -0.2, -2.5) - point;
        const double d = glm::length(path);
        double expected = 0.6 / static_cast<double>(kPi) * 5.0 * (path.z / d) / (d * d);
        if (range > 0) expected *= std::max(0.0, 1.0 - std::pow(d / static_cast<double>(range), 4));
        EXPECT_NEAR(static_cast<double>(reflectedAt(planes, x, y).r), expected, 3e-6) << x << ' ' << y;
      }
  }
}

TEST(Lights, SpotConeIsFullInsideAndDarkOutside) {
  Stage stage(64, 64);
  stage.quad(0, 0, 64, 64, 4.0, stage.add(matte(0.6f)));
  Light spot;
  spot.kind = LightKind::spot;
  spot.intensity = 5.0f;
  spot.innerCone = 0.1f;
  spot.outerCone = 0.2f;
  stage.scene.lights = {spot};  // at the eye, along the view axis
  const OitPlanes planes = stage.accumulate(uniformWeight());
  for (const int x : {33, 40, 44, 46, 60}) {
    const glm::dvec3 point(stage.at(x + 0.5, 32.5, 4.0));
    const double d = glm::length(point), cosine = 4.0 / d;
    const double cone = std::clamp((cosine - std::cos(0.2)) / (std::cos(0.1) - std::cos(0.2)), 0.0, 1.0);
    const double expected = 0.6 / static_cast<double>(kPi) * 5.0 * cosine / (d * d) * cone * cone;
    EXPECT_NEAR(static_cast<double>(reflectedAt(planes, x, 32).r), expected, 1e-5) << x;
  }
}

TEST(Lights, BothSidesOfAPaneFaceTheEye) {
  // The normal is turned to the eye, so a back face is lit from the camera's side too.
  Stage stage(8, 8);
  stage.quad(0, 0, 8, 8, 2.0, stage.add(matte(0.6f)));
  std::swap(stage.scene.primitives[0].indices[1], stage.scene.primitives[0].indices[2]);
  std::swap(stage.scene.primitives[0].indices[4], stage.scene.primitives[0].indices[5]);
  for (Vertex& vertex : stage.scene.primitives[0].vertices) vertex.normal = -vertex.normal;
  Light sun;
  sun.kind = LightKind::directional;
  sun.intensity = 3.0f;
  stage.scene.lights = {sun};
  EXPECT_NEAR(reflectedAt(stage.accumulate(uniformWeight()), 4, 4).r, 0.6f / kPi * 3.0f, 2e-6f);
}

TEST(Lights, SurroundingsAndFresnel) {
  Stage stage(65, 65);
  Material glass;
  glass.doubleSided = true;
  glass.transmission = 1.0f;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.ior = 1.5f;
  stage.quad(0, 0, 65, 65, 2.0, stage.add(glass));
  PassSettings settings = uniformWeight();
  settings.surroundings = {1.0f, 0.5f, 0.0f};
  const std::vector<FragmentLists> lists = stage.fragments(settings);
  const Fragment& middle = lists[0].fragments.at(lists[0].offsets[32 * 65 + 32]);
  EXPECT_NEAR(middle.radiance.r, 0.04f, 1e-6f);  // ((1.5 - 1) / (1.5 + 1))^2
  EXPECT_NEAR(middle.radiance.g, 0.02f, 1e-6f);
  EXPECT_EQ(middle.radiance.b, 0.0f);
  EXPECT_NEAR(middle.transmission.r, 0.96f, 1e-6f);
  EXPECT_EQ(middle.coverage, 1.0f);
}

TEST(Additive, AddsWithoutCovering) {
  Stage stage(8, 8);
  Material flame = unlitBlend({3.0f, 2.0f, 1.0f}, 0.5f);
  flame.additive = true;
  stage.quad(0, 0, 8, 8, 2.0, stage.add(flame));
  const OitPlanes planes = stage.accumulate();
  EXPECT_EQ(glm::vec3(planes.light.at(4, 4)), glm::vec3(1.5f, 1.0f, 0.5f));
  EXPECT_EQ(glm::vec3(planes.opacity.at(4, 4)), glm::vec3(0.0f));
  EXPECT_EQ(glm::vec3(planes.depth.at(4, 4)), glm::vec3(0.0f));
}

TEST(Extremes, FiniteWhateverTheMaterial) {
  Stage stage(32, 32);
  for (int i = 0; i < 16; ++i) {
    Material material;
    material.doubleSided = true;
    material.transmission = i & 1 ? 1.0f : 0.3f;
    material.metallic = i & 2 ? 1.0f : 0.0f;
    material.roughness = i & 4 ? 0.0f : 1.0f;
    material.ior = i & 8 ? 2.4f : 1.0f;
    material.emission = glm::vec3(i & 1 ? 1e30f : 1e-30f);
    stage.slanted(0, 0, 32, 32, 0.001 + i, 1e6, stage.add(material));
    for (Vertex& vertex : stage.scene.primitives.back().vertices)
      if (i & 4) vertex.normal = {0, 0, 0};
  }
  Light bulb;  // lies on the first surface's edge
  bulb.intensity = 1e6f;
  bulb.position = glm::dvec3(stage.at(0.5, 16.5, 1.001));
  stage.scene.lights = {bulb};
  PassSettings settings;
  settings.surroundings = glm::vec3(1e6f);
  const OitPlanes planes = stage.accumulate(settings);
  for (std::size_t i = 0; i < planes.radiance.size(); ++i)
    for (const glm::vec4& value :
         {planes.radiance[i], planes.weight[i], planes.opacity[i], planes.depth[i], planes.light[i]})
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(value[c]) && value[c] >= 0.0f) << "pixel " << i;
}

}  // namespace
}  // namespace pellucid::test
