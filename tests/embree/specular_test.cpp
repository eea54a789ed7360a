// The textures of KHR_materials_specular: a texel does what the same factor does, for rays and GL, opaque and not.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "engine_bridge/embree/opaque_render.h"
#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/gl/opaque_pass.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

constexpr int kPictureEdge = 24, kLeft = 7, kRight = 17, kRow = 12;
constexpr float kStrength[] = {0.25f, 0.75f};
const glm::vec3 kTint[] = {{1.0f, 0.5f, 0.25f}, {0.2f, 0.9f, 0.6f}};

enum class Given { factors, textures };

// A pane, its halves apart: what the left and right half's factors say, as factors of two panes or as texels of one.
Stage panes(Given given, bool transparent) {
  Stage stage(kPictureEdge, kPictureEdge);
  Material material;
  material.metallic = 0.0f;
  material.roughness = 0.3f;
  material.baseColor = {0.1f, 0.1f, 0.1f, 1.0f};
  if (transparent) material.transmission = 0.6f;
  Light light;
  light.kind = LightKind::directional;
  light.direction = {0.0, 0.0, -1.0};
  light.intensity = 3.0f;
  stage.scene.lights.push_back(light);
  if (given == Given::textures) {
    Texture strength, tint;
    strength.name = "strength";
    tint.name = "tint";
    strength.nearest = tint.nearest = true;
    strength.texels = tint.texels = Image<glm::vec4>(2, 1);
    for (int x = 0; x < 2; ++x) {
      strength.texels.at(x, 0) = glm::vec4(0.9f, 0.8f, 0.7f, kStrength[x]);  // rgb is not read
      tint.texels.at(1 - x, 0) = glm::vec4(kTint[x], 0.3f);                  // mirrored: it has its own transform
    }
    stage.scene.textures = {strength, tint};
    material.specularTexture.texture = 0;
    material.specularColorTexture.texture = 1;
    material.specularColorTexture.uvTransform = glm::mat3(-1, 0, 0, 0, 1, 0, 1, 0, 1);  // u' = 1 - u
    stage.quad(2, 2, kPictureEdge - 2, kPictureEdge - 2, 3.0, stage.add(material));
  } else {
    for (int half = 0; half < 2; ++half) {
      material.specular = kStrength[half];
      material.specularColor = kTint[half];
      const int middle = kPictureEdge / 2;
      stage.quad(half ? middle : 2, 2, half ? kPictureEdge - 2 : middle, kPictureEdge - 2, 3.0, stage.add(material));
    }
  }
  return stage;
}

void expectClose(const glm::vec3& a, const glm::vec3& b, const char* what) {
  EXPECT_LT(glm::length(a - b), 1e-5f * glm::length(b)) << what << ": " << a.r << ' ' << a.g << ' ' << a.b;
}

TEST(SpecularTextures, DoToOpaquePixelsWhatFactorsDo) {
  const Stage asked = panes(Given::textures, false), expected = panes(Given::factors, false);
  const Window& window = asked.gbuffer.data;
  OpaqueRenderSettings settings;
  settings.samples = 1;
  settings.shadows = false;
  settings.aoRadius = 0.0f;
  GlContext context;
  OpaquePassSettings pass;
  pass.filter = TextureFilter::bilinear;
  const auto rays = [&](const Stage& stage) {
    return renderOpaque(stage.scene, stage.camera, window, window, Environment(), settings);
  };
  const auto drawn = [&](const Stage& stage) {
    return rasteriseOpaque(context, stage.scene, stage.camera, window, window, pass);
  };
  const OpaquePlanes a = rays(asked), b = rays(expected), c = drawn(asked), d = drawn(expected);
  for (const int x : {kLeft, kRight}) {
    const glm::vec3 truth(b.beauty.at(x, kRow));
    ASSERT_GT(truth.r, 0.01f);
    expectClose(glm::vec3(a.beauty.at(x, kRow)), truth, "rays");
    expectClose(glm::vec3(d.beauty.at(x, kRow)), truth, "GL, factors");
    expectClose(glm::vec3(c.beauty.at(x, kRow)), truth, "GL, textures");
  }
  EXPECT_GT(glm::length(glm::vec3(a.beauty.at(kLeft, kRow)) - glm::vec3(a.beauty.at(kRight, kRow))), 0.01f);
}

TEST(SpecularTextures, DoToFragmentsWhatFactorsDo) {
  const Stage asked = panes(Given::textures, true), expected = panes(Given::factors, true);
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  GlContext context;
  // The row's fragments, from whichever band holds it.
  Fragment found[3][2];
  int seen = 0;
  const auto keep = [&](Fragment(&pair)[2]) {
    return [&](const FragmentLists& lists) {
      if (kRow < lists.window.y0 || kRow >= lists.window.y1) return;
      for (int i = 0; i < 2; ++i) {
        const auto pixel =
            static_cast<std::size_t>((kRow - lists.window.y0) * lists.window.width() + (i ? kRight : kLeft));
        ASSERT_EQ(lists.offsets[pixel + 1] - lists.offsets[pixel], 1u);
        pair[i] = lists.fragments[lists.offsets[pixel]];
        ++seen;
      }
    };
  };
  RayFragments(expected.scene, expected.gbuffer, expected.camera).fragments(settings, keep(found[0]));
  RayFragments(asked.scene, asked.gbuffer, asked.camera).fragments(settings, keep(found[1]));
  TransparentPass(context, asked.scene, asked.gbuffer, asked.camera).fragments(settings, keep(found[2]));
  ASSERT_EQ(seen, 6);
  for (int i = 0; i < 2; ++i)
    for (int source = 1; source < 3; ++source) {
      const char* who = source == 1 ? "rays" : "GL";
      expectClose(found[source][i].radiance, found[0][i].radiance, who);
      expectClose(found[source][i].transmission, found[0][i].transmission, who);
    }
  EXPECT_GT(glm::length(found[0][0].radiance - found[0][1].radiance), 0.01f);
}

}  // namespace
}  // namespace pellucid::test
