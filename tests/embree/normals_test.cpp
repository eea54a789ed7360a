// Normal textures: directions that can be worked out by hand, and rays against GL.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "engine_bridge/embree/opaque_render.h"
#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/gl/opaque_pass.h"
#include "engine_bridge/scene/tangents.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

constexpr int kEdge = 48;

Texture textureOf(int edge, const std::function<glm::vec3(glm::vec2)>& slope) {
  Texture texture;
  texture.name = "normals";
  texture.texels = Image<glm::vec4>(edge, edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x)
      texture.texels.at(x, y) =
          glm::vec4(slope((glm::vec2(x, y) + 0.5f) / static_cast<float>(edge)) * 0.5f + 0.5f, 1.0f);
  return texture;
}

// Two renderers' normals in the middle of a quad that faces the eye.
struct Seen {
  glm::vec3 rays, gl;
};
Seen middleOf(const Scene& scene, const Stage& stage) {
  OpaqueRenderSettings settings;
  settings.samples = 1;
  settings.aoRadius = 0.0f;
  const Window& window = stage.gbuffer.data;
  GlContext context;
  OpaquePassSettings pass;
  pass.filter = TextureFilter::bilinear;
  return {renderOpaque(scene, stage.camera, window, window, Environment(), settings).normal.at(kEdge / 2, kEdge / 2),
          rasteriseOpaque(context, scene, stage.camera, window, window, pass).normal.at(kEdge / 2, kEdge / 2)};
}

// The texel says .6 towards rising u, .8 out of the surface.
Stage leaningStage(const glm::mat3& uvTransform, bool mirroredUv) {
  Stage stage(kEdge, kEdge);
  Material material;
  material.doubleSided = true;
  material.normalTexture.texture = 0;
  material.normalTexture.uvTransform = uvTransform;
  stage.scene.textures.push_back(textureOf(4, [](glm::vec2) { return glm::vec3(0.6f, 0.0f, 0.8f); }));
  stage.quad(4, 4, kEdge - 4, kEdge - 4, 3.0, stage.add(material));
  Primitive& primitive = stage.scene.primitives[0];
  if (mirroredUv)
    for (Vertex& vertex : primitive.vertices) vertex.uv[0].x = 1.0f - vertex.uv[0].x;
  gltf::makeTangents(primitive, material.normalTexture);
  return stage;
}

void expectNormal(const Stage& stage, glm::vec3 expected, const char* what) {
  const Seen seen = middleOf(stage.scene, stage);
  EXPECT_LT(glm::length(seen.rays - expected), 1e-5f) << what << ": rays";
  EXPECT_LT(glm::length(seen.gl - expected), 1e-5f) << what << ": gl";
}

TEST(Normals, LeanTowardsRisingU) {
  expectNormal(leaningStage(glm::mat3(1.0f), false), {0.6f, 0.0f, 0.8f}, "plain");
  expectNormal(leaningStage(glm::mat3(1.0f), true), {-0.6f, 0.0f, 0.8f}, "mirrored picture");
  // u' = -v: u rises upwards.
  const glm::mat3 turned(0, 1, 0, -1, 0, 0, 0, 0, 1);
  expectNormal(leaningStage(turned, false), {0.0f, 0.6f, 0.8f}, "turned by the texture's transform");
}

// Green points up in the picture, whichever way the picture is mirrored.
TEST(Normals, GreenPointsUpInThePicture) {
  for (const bool mirrored : {false, true}) {
    Stage stage = leaningStage(glm::mat3(1.0f), mirrored);
    stage.scene.textures[0] = textureOf(4, [](glm::vec2) { return glm::vec3(0.0f, 0.6f, 0.8f); });
    expectNormal(stage, {0.0f, 0.6f, 0.8f}, mirrored ? "mirrored" : "plain");
  }
}

TEST(Normals, TheBackOfASurfaceIsTheSameRelief) {
  Stage stage = leaningStage(glm::mat3(1.0f), false);
  // Turned about y: the eye sees the back; what leant to +x leans to -x, and away.
  stage.scene.instances[0].worldFromObject = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -3)) *
                                             glm::rotate(glm::dmat4(1.0), M_PI, glm::dvec3(0, 1, 0)) *
                                             glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 3));
  // World normal of the relief is (-.6, 0, -.8); its other side is seen.
  expectNormal(stage, {0.6f, 0.0f, 0.8f}, "back");
}

TEST(Normals, ScaleFlattensSlopes) {
  Stage stage = leaningStage(glm::mat3(1.0f), false);
  stage.scene.materials[0].normalScale = 0.5f;
  expectNormal(stage, glm::normalize(glm::vec3(0.3f, 0.0f, 0.8f)), "half");
  stage.scene.materials[0].normalScale = 0.0f;
  expectNormal(stage, {0.0f, 0.0f, 1.0f}, "none");
}

// Both handednesses at one edge: its vertices are doubled, and nothing is averaged away.
TEST(Normals, MirroredHalvesKeepTheirOwnTangents) {
  Primitive primitive;
  // A strip of two quads; u runs 0, 1, 0.
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 2; ++y) {
      Vertex vertex{};
      vertex.position = {static_cast<float>(x), static_cast<float>(y), 0.0f};
      vertex.normal = {0, 0, 1};
      vertex.uv[0] = {x == 1 ? 1.0f : 0.0f, 1.0f - static_cast<float>(y)};
      primitive.vertices.push_back(vertex);
    }
  primitive.indices = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
  gltf::makeTangents(primitive, TextureRef{});
  EXPECT_EQ(primitive.vertices.size(), 8u);
  for (std::size_t corner = 0; corner < 12; ++corner) {
    const glm::vec4 tangent = shading::unpackTangent(primitive.vertices[primitive.indices[corner]].tangent);
    const bool left = corner < 6;
    EXPECT_LT(glm::length(glm::vec3(tangent) - glm::vec3(left ? 1 : -1, 0, 0)), 1e-6f) << corner;
    EXPECT_EQ(tangent.w, left ? 1.0f : -1.0f) << corner;
  }
}

TEST(Normals, PackedTangentsComeBack) {
  for (int i = 0; i < 200; ++i) {
    const float angle = 0.7f * static_cast<float>(i), z = -1.0f + 0.01f * static_cast<float>(i);
    const float across = std::sqrt(1.0f - z * z), hand = i % 3 ? 1.0f : -1.0f;
    const glm::vec3 tangent(across * std::cos(angle), across * std::sin(angle), z);
    const glm::vec4 back = shading::unpackTangent(shading::packTangent(tangent, hand));
    EXPECT_LT(glm::length(glm::vec3(back) - tangent), 1e-6f);
    EXPECT_EQ(back.w, hand);
  }
  EXPECT_EQ(shading::unpackTangent(glm::vec2(0.0f)), glm::vec4(0.0f));
}

// A rippled, slanted, stretched and mirrored pane: lit, opaque and transparent.
Stage ripples(bool transparent) {
  Stage stage(kEdge, kEdge);
  Material material;
  material.doubleSided = true;
  material.metallic = 0.0f;
  material.roughness = 0.4f;
  material.normalTexture.texture = 0;
  material.normalScale = 0.7f;
  if (transparent) {
    material.alphaMode = AlphaMode::blend;
    material.baseColor = {0.8f, 0.5f, 0.3f, 0.6f};
  }
  stage.scene.textures.push_back(textureOf(32, [](glm::vec2 at) {
    const double x = 12.0 * static_cast<double>(at.x), y = 9.0 * static_cast<double>(at.y);
    return glm::vec3(glm::normalize(glm::dvec3(0.5 * std::sin(x), 0.4 * std::cos(y), 1.0)));
  }));
  const int index = stage.add(material);
  stage.slanted(2, 4, 30, 44, 3.0, 2.2, index);
  stage.slanted(20, 8, 46, 40, 2.6, 3.4, index);
  for (Primitive& primitive : stage.scene.primitives) gltf::makeTangents(primitive, material.normalTexture);
  stage.scene.instances[1].worldFromObject = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.1, 0.0)) *
                                             glm::scale(glm::dmat4(1.0), glm::dvec3(0.9, 1.1, 1.0));
  Light light;
  light.intensity = 12.0f;
  light.position = {1.0, 1.5, 0.5};
  stage.scene.lights.push_back(light);
  return stage;
}

TEST(Normals, RaysAndGlAgreeOnOpaqueRipples) {
  const Stage stage = ripples(false);
  OpaqueRenderSettings settings;
  settings.samples = 1;
  settings.shadows = false;
  settings.aoRadius = 0.0f;
  const Window& window = stage.gbuffer.data;
  const OpaquePlanes rayed = renderOpaque(stage.scene, stage.camera, window, window, Environment(), settings);
  GlContext context;
  OpaquePassSettings pass;
  pass.filter = TextureFilter::bilinear;
  const OpaquePlanes drawn = rasteriseOpaque(context, stage.scene, stage.camera, window, window, pass);
  double worst = 0, most = 0, worstLight = 0;
  std::size_t pixels = 0, off = 0;
  for (std::size_t i = 0; i < rayed.normal.size(); ++i) {
    if (std::abs(rayed.viewZ[i] - drawn.viewZ[i]) > 1e-3f || std::isinf(rayed.viewZ[i])) continue;  // edges
    ++pixels;
    const double angle = glm::degrees(static_cast<double>(glm::length(glm::cross(rayed.normal[i], drawn.normal[i]))));
    worst = std::max(worst, angle);
    off += angle > 0.1 ? 1 : 0;
    most = std::max(most, glm::degrees(std::acos(static_cast<double>(std::min(rayed.normal[i].z, 1.0f)))));
    worstLight = std::max(worstLight, static_cast<double>(std::abs(rayed.beauty[i].r - drawn.beauty[i].r)));
  }
  std::printf(
      "ripples: %zu pixels, normals lean by up to %.0f degrees, rays and GL differ by at most %.4f degrees and %.2g\n",
      pixels, most, worst, worstLight);
  EXPECT_GT(pixels, 1000u);
  EXPECT_GT(most, 15.0) << "there is relief";
  EXPECT_EQ(off, 0u);
  EXPECT_LT(worstLight, 1e-3);
}

TEST(Normals, RaysAndGlAgreeOnTransparentRipples) {
  const Stage stage = ripples(true);
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  std::map<std::pair<std::size_t, std::uint32_t>, Fragment> traced;
  const auto each = [&](const FragmentLists& lists, auto&& use) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i)
        for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k)
          use(std::make_pair(static_cast<std::size_t>(y * kEdge + x), lists.fragments[k].identity), lists.fragments[k]);
  };
  RayFragments(stage.scene, stage.gbuffer, stage.camera).fragments(settings, [&](const FragmentLists& lists) {
    each(lists, [&](const auto& key, const Fragment& fragment) { traced[key] = fragment; });
  });
  GlContext context;
  std::size_t fragments = 0;
  double worst = 0, brightest = 0;
  TransparentPass(context, stage.scene, stage.gbuffer, stage.camera)
      .fragments(settings, [&](const FragmentLists& lists) {
        each(lists, [&](const auto& key, const Fragment& fragment) {
          const auto other = traced.find(key);
          if (other == traced.end()) return;  // edges
          ++fragments;
          worst = std::max(worst, static_cast<double>(glm::length(fragment.radiance - other->second.radiance)));
          brightest = std::max(brightest, static_cast<double>(fragment.radiance.r));
        });
      });
  std::printf("ripples: %zu fragments as bright as %.2f, rays and GL differ by at most %.2g\n", fragments, brightest,
              worst);
  EXPECT_GT(fragments, 1000u);
  EXPECT_LT(worst, 1e-3);
}

}  // namespace
}  // namespace pellucid::test
