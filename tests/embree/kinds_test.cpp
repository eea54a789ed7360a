// What glTF files hold besides plain meshes, in closed form, by GL and by rays: mirrored parents of everything, both
// sides of volumes, colours of instances, colours weighted by alpha.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/scene/placed.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

// The layers of one pixel, nearest first.
using Layers = std::vector<Fragment>;

Layers layersAt(const std::vector<FragmentLists>& bands, int x, int y) {
  for (const FragmentLists& lists : bands) {
    if (y < lists.window.y0 || y >= lists.window.y1 || x < lists.window.x0 || x >= lists.window.x1) continue;
    const auto i = static_cast<std::size_t>((y - lists.window.y0) * lists.window.width() + x - lists.window.x0);
    Layers layers(lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                  lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]));
    std::sort(layers.begin(), layers.end(), [](const Fragment& a, const Fragment& b) { return a.z < b.z; });
    return layers;
  }
  return {};
}

// Both sources, one after the other.
void eachSource(Stage& stage, PassSettings settings,
                const std::function<void(const char*, const std::vector<FragmentLists>&)>& look) {
  settings.filter = TextureFilter::bilinear;
  look("GL", stage.fragments(settings));
  std::vector<FragmentLists> bands;
  RayFragments(stage.scene, stage.gbuffer, stage.camera).fragments(settings, [&](const FragmentLists& band) {
    bands.push_back(band);
  });
  look("rays", bands);
}

// A Lambertian pane, lit from the eye's side by a sun: half of its colour over pi.
TEST(Kinds, MirrorsKeepTheSideThatIsLit) {
  for (const bool billboard : {false, true})
    for (const bool doubleSided : {false, true})
      for (const glm::dvec3 scale : {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1),
                                     glm::dvec3(-1, -1, 1), glm::dvec3(-2, 1, 1), glm::dvec3(1, 1, 0)}) {
        Stage stage(16, 16);
        Material material = unlitBlend({1, 0.5f, 0.25f}, 0.5f);
        material.unlit = false;
        material.doubleSided = doubleSided;
        material.metallic = 0.0f;
        material.ior = 1.0f;
        material.billboard = billboard;
        Primitive pane;
        pane.material = stage.add(material);
        for (const glm::vec2 corner : {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(9, 9), glm::vec2(-9, 9)}) {
          Vertex vertex{};
          vertex.position = glm::vec3(corner, 0.0f);
          vertex.normal = {0, 0, 1};
          vertex.colour = glm::vec4(1.0f);
          pane.vertices.push_back(vertex);
        }
        pane.indices = {0, 1, 2, 0, 2, 3};
        Instance instance;
        instance.worldFromObject = glm::dmat4(glm::dvec4(scale.x, 0, 0, 0), glm::dvec4(0, scale.y, 0, 0),
                                              glm::dvec4(0, 0, scale.z, 0), glm::dvec4(0, 0, -5, 1));
        // As the loader does.
        if (mirrors(instance.worldFromObject)) pane.indices = {0, 2, 1, 0, 3, 2};
        stage.scene.primitives.push_back(pane);
        stage.scene.instances.push_back(instance);
        Light sun;
        sun.kind = LightKind::directional;
        sun.intensity = 2.0f;
        stage.scene.lights.push_back(sun);
        if (billboard && scale.z == 0.0) continue;  // a card without depth has no size to turn
        eachSource(stage, {}, [&](const char* source, const std::vector<FragmentLists>& bands) {
          if (billboard && std::string(source) == "rays") return;  // rays do not meet particles
          const Layers layers = layersAt(bands, 7, 8);
          ASSERT_EQ(layers.size(), 1u) << source << " billboard " << billboard << " scale " << scale.x << ' '
                                       << scale.y;
          if (billboard) return;  // lit as a medium
          EXPECT_NEAR(layers[0].radiance.r, 0.5f * 2.0f / 3.14159265f, 1e-5f) << source << ' ' << scale.x << scale.y;
        });
      }
}

// KHR_materials_volume: doubleSided has no effect on the boundaries of a volume. Light that crosses the box loses what
// two interfaces take and what it passes through absorbs.
TEST(Kinds, VolumesHaveTwoSides) {
  for (const bool doubleSided : {false, true})
    for (const float base : {1.0f, 0.5f})
      for (const float ior : {1.0f, 1.5f})
        for (const bool thin : {false, true}) {
          Stage stage(16, 16);
          stage.camera.orthographic = true;
          stage.camera.focal = {2.0, 2.0};
          Material glass;
          glass.name = "glass";
          glass.doubleSided = doubleSided;
          glass.baseColor = glm::vec4(glm::vec3(base), 1.0f);
          glass.metallic = glass.roughness = 0.0f;
          glass.transmission = 1.0f;
          glass.ior = ior;
          glass.volume = true;
          glass.thickness = 2.0f;
          glass.attenuationDistance = 2.0f;
          glass.attenuationColor = {0.25f, 0.5f, 0.81f};
          if (thin) glass.thin = true;
          const int material = stage.add(glass);
          for (const float side : {1.0f, -1.0f}) {
            Primitive face;
            face.material = material;
            for (const glm::vec2 corner : {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(9, 9), glm::vec2(-9, 9)}) {
              Vertex vertex{};
              vertex.position = glm::vec3(corner, -5.0f + side);
              vertex.normal = {0, 0, side};
              vertex.colour = glm::vec4(1.0f);
              face.vertices.push_back(vertex);
            }
            face.indices =
                side > 0 ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2};
            stage.place(std::move(face));
          }
          eachSource(stage, {}, [&](const char* source, const std::vector<FragmentLists>& bands) {
            const Layers layers = layersAt(bands, 7, 8);
            ASSERT_EQ(layers.size(), thin && !doubleSided ? 1u : 2u) << source << doubleSided << thin;
            glm::vec3 through(1.0f);
            for (const Fragment& layer : layers) through *= layer.transmission;
            const float interface_ = 1.0f - std::pow((ior - 1.0f) / (ior + 1.0f), 2.0f);
            glm::vec3 expected(std::pow(base * interface_, static_cast<float>(layers.size())));
            if (!thin) expected *= glass.attenuationColor;
            for (int c = 0; c < 3; ++c)
              EXPECT_NEAR(through[c], expected[c], 1e-5f) << source << " double " << doubleSided;
          });
        }
}

TEST(Kinds, InstancesColourTheirVertices) {
  Stage stage(16, 16);
  const int material = stage.add(unlitBlend({1, 1, 0.5f}, 0.5f));
  Instance first = stage.quad(0, 0, 8, 16, 2.0, material);
  const int plain = first.primitive;
  for (Vertex& vertex : stage.scene.primitives[0].vertices) vertex.colour = {0.5f, 1, 1, 1};
  stage.scene.instances[0].colour = {1, 0.25f, 1, 0.5f};
  Instance second = stage.scene.instances[0];  // the same mesh, eight pixels to the right
  second.worldFromObject[3].x = 2.0 * 8 / 16;
  second.colour = glm::vec4(1.0f);
  second.identity = 77;
  stage.scene.instances.push_back(second);
  ASSERT_EQ(stage.scene.instances[1].primitive, plain);
  eachSource(stage, {}, [&](const char* source, const std::vector<FragmentLists>& bands) {
    const Layers left = layersAt(bands, 3, 8), right = layersAt(bands, 12, 8);
    ASSERT_EQ(left.size(), 1u) << source;
    ASSERT_EQ(right.size(), 1u) << source;
    EXPECT_NEAR(left[0].coverage, 0.25f, 1e-6f) << source;
    EXPECT_NEAR(left[0].radiance.r, 0.25f * 0.5f, 1e-6f) << source;
    EXPECT_NEAR(left[0].radiance.g, 0.25f * 0.25f, 1e-6f) << source;
    EXPECT_NEAR(right[0].coverage, 0.5f, 1e-6f) << source;
    EXPECT_NEAR(right[0].radiance.g, 0.5f, 1e-6f) << source;
  });
}

TEST(Kinds, ColoursAreWeightedByAlpha) {
  Stage stage(64, 4);
  Material material = unlitBlend({1, 1, 1}, 1.0f);
  material.coverage = 0.5f;
  const glm::vec4 a(1, 0.25f, 0.5f, 0.9f), b(0, 1, 20, 0.1f);
  material.baseColorTexture.texture = stage.texture(2, 1, {a, b});
  stage.quad(0, 0, 64, 4, 2.0, stage.add(material));
  eachSource(stage, {}, [&](const char* source, const std::vector<FragmentLists>& bands) {
    for (int x = 0; x < 64; ++x) {
      const Layers layers = layersAt(bands, x, 2);
      ASSERT_EQ(layers.size(), 1u);
      const float alpha = layers[0].coverage / 0.5f, second = (alpha - a.a) / (b.a - a.a);
      for (int c = 0; c < 3; ++c) {
        const float expected = (a[c] * a.a * (1 - second) + b[c] * b.a * second) / alpha;
        EXPECT_NEAR(layers[0].radiance[c] / layers[0].coverage, expected, 2e-6f * std::max(1.0f, expected))
            << source << x;
      }
    }
  });
}

}  // namespace
}  // namespace pellucid::test
