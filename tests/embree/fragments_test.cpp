// Fragment lists by rays against those of the GL pass.
#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/gl/transparent_pass.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "gbuffer/errors.h"
#include "tests/embree/traced_scenes.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

struct Lists {  // of the whole window, by identity
  int width = 0;
  std::vector<std::vector<Fragment>> pixels;
  Image<glm::vec4> solid;

  Lists() = default;
  explicit Lists(const Window& data)
      : width(data.width()),
        pixels(static_cast<std::size_t>(data.width()) * static_cast<std::size_t>(data.height())),
        solid(data.width(), data.height(), glm::vec4(0, 0, 0, INFINITY)) {}

  void add(const FragmentLists& lists, const Window& data) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i) {
        const int column = x - data.x0, row = y - data.y0;
        auto& list = pixels[static_cast<std::size_t>(row * width + column)];
        list.assign(lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                    lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]));
        std::sort(list.begin(), list.end(),
                  [](const Fragment& a, const Fragment& b) { return a.identity < b.identity; });
        solid.at(column, row) = lists.solid[i];
      }
  }
};

PassSettings settingsOf(MaskEdge mask) {
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  settings.mask = mask;
  settings.surroundings = {0.2f, 0.3f, 0.4f};
  return settings;
}

Lists traced(const Scene& scene, const GBuffer& gbuffer, const Camera& camera, const PassSettings& settings) {
  Lists lists(gbuffer.data);
  RayFragments(scene, gbuffer, camera).fragments(settings, [&](const FragmentLists& band) {
    lists.add(band, gbuffer.data);
  });
  return lists;
}

Lists drawn(const Scene& scene, const GBuffer& gbuffer, const Camera& camera, const PassSettings& settings) {
  Lists lists(gbuffer.data);
  GlContext context;
  TransparentPass(context, scene, gbuffer, camera).fragments(settings, [&](const FragmentLists& band) {
    lists.add(band, gbuffer.data);
  });
  return lists;
}

bool sameTriangles(const std::vector<Fragment>& a, const std::vector<Fragment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Fragment& p, const Fragment& q) { return p.identity == q.identity; });
}

struct Comparison {
  std::size_t pixels = 0, away = 0, sameCount = 0, fragments = 0, farZ = 0, farLight = 0, deepest = 0;
  double part() const { return away ? static_cast<double>(sameCount) / static_cast<double>(away) : 0.0; }
};

// Away from edges: the rays a sixteenth of a pixel around see the same triangles as the centre's.
Comparison compare(const std::string& name, const Scene& scene, const GBuffer& gbuffer, const Camera& camera,
                   MaskEdge mask) {
  const PassSettings settings = settingsOf(mask);
  const Lists gl = drawn(scene, gbuffer, camera, settings);
  const Lists centre = traced(scene, gbuffer, camera, settings);
  std::vector<bool> away(centre.pixels.size(), true);
  for (const glm::dvec2 offset : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 1)}) {
    PassSettings beside = settings;
    beside.sample += offset / 16.0;
    const Lists other = traced(scene, gbuffer, camera, beside);
    for (std::size_t i = 0; i < away.size(); ++i)
      away[i] = away[i] && sameTriangles(centre.pixels[i], other.pixels[i]) &&
                std::isinf(centre.solid[i].a) == std::isinf(other.solid[i].a);
  }
  Comparison result;
  for (std::size_t i = 0; i < away.size(); ++i) {
    ++result.pixels;
    const auto& a = centre.pixels[i];
    const auto& b = gl.pixels[i];
    if (!away[i]) continue;
    ++result.away;
    result.deepest = std::max(result.deepest, a.size());
    result.sameCount += a.size() == b.size() && std::isinf(centre.solid[i].a) == std::isinf(gl.solid[i].a) ? 1 : 0;
    if (!sameTriangles(a, b)) continue;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ++result.fragments;
      result.farZ += std::abs(a[k].z - b[k].z) <= 1e-3f * a[k].z ? 0 : 1;
      const glm::vec3 light = glm::abs(a[k].radiance - b[k].radiance),
                      through = glm::abs(a[k].transmission - b[k].transmission);
      const float most = std::max(
          {light.r, light.g, light.b, through.r, through.g, through.b, std::abs(a[k].coverage - b[k].coverage)});
      result.farLight +=
          most <= 0.01f * std::max(1.0f, std::max({a[k].radiance.r, a[k].radiance.g, a[k].radiance.b})) ? 0 : 1;
    }
  }
  std::printf(
      "%s: %zu of %zu pixels away from edges, same count on %.4f%% of them (up to %zu layers); of %zu fragments %zu "
      "differ in z by 1e-3, %zu in light or coverage by .01\n",
      name.c_str(), result.away, result.pixels, 100.0 * result.part(), result.deepest, result.fragments, result.farZ,
      result.farLight);
  return result;
}

void expectSame(const std::string& name, const Scene& scene, const GBuffer& gbuffer, const Camera& camera,
                MaskEdge mask) {
  const Comparison result = compare(name, scene, gbuffer, camera, mask);
  EXPECT_GT(result.away, result.pixels / 3);
  EXPECT_GT(result.fragments, 1000u);
  EXPECT_GE(result.part(), 0.999);
  EXPECT_LE(result.farZ, result.fragments / 1000);
  // Texels and highlights may change within the 1/256 of a pixel that GL snaps vertices by.
  EXPECT_LE(result.farLight, result.fragments / 1000);
}

TEST(RayFragments, ShippedSamples) {
  for (const std::string name : {"bars", "bottles", "smoke"}) {
    const std::string stem = makeSample(name);
    const Scene scene = sceneOf(stem + ".glb");
    const OpaqueFile opaque = readOpaque(stem + ".exr", ReadOptions{});
    ASSERT_TRUE(opaque.gbuffer.camera.has_value());
    expectSame(name, scene, opaque.gbuffer, *opaque.gbuffer.camera, MaskEdge::smooth);
  }
}

TEST(RayFragments, BlenderScene) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
  const Scene scene = sceneOf(assets() + "/blender/transparent_lit.glb");
  const OpaqueFile opaque = readOpaque(assets() + "/blender/gbuffer.exr", ReadOptions{});
  const Camera camera = cameraIn(scene, opaque.gbuffer.display);
  expectSame("blender, hard masks", scene, opaque.gbuffer, camera, MaskEdge::hard);
  expectSame("blender, smooth masks", scene, opaque.gbuffer, camera, MaskEdge::smooth);
}

// A closed mesh cut into many triangles, with edges exactly through pixel centres: one fragment a side, everywhere.
TEST(RayFragments, SharedEdgesGiveOneFragment) {
  Stage stage(33, 33);
  const int glass = stage.add(unlitBlend(glm::vec3(0.5f), 0.5f));
  Primitive primitive;
  primitive.material = glass;
  constexpr int edge = 33;
  for (int y = 0; y <= edge; ++y)
    for (int x = 0; x <= edge; ++x) {
      Vertex vertex{};
      vertex.position = stage.at(x + 0.5 - 1.0, y + 0.5 - 1.0, 2.0);
      vertex.normal = {0, 0, 1};
      vertex.colour = glm::vec4(1.0f);
      primitive.vertices.push_back(vertex);
    }
  for (std::uint32_t y = 0; y < edge; ++y)
    for (std::uint32_t x = 0; x < edge; ++x) {
      const std::uint32_t a = y * (edge + 1) + x, b = a + 1, c = a + edge + 1, d = c + 1;
      for (const std::uint32_t i : {a, c, b, b, c, d}) primitive.indices.push_back(i);
    }
  stage.place(primitive);
  const Lists lists = traced(stage.scene, stage.gbuffer, stage.camera, settingsOf(MaskEdge::smooth));
  std::size_t wrong = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) wrong += lists.pixels[static_cast<std::size_t>(y * 33 + x)].size() == 1 ? 0 : 1;
  EXPECT_EQ(wrong, 0u);
}

TEST(RayFragments, SingleSidedBacksAndWhatLiesBehindAreLeftOut) {
  Stage stage(8, 8);
  Material material = unlitBlend(glm::vec3(1.0f), 0.5f);
  material.doubleSided = false;
  const int front = stage.add(material);
  Material solid = unlitBlend(glm::vec3(0.25f), 1.0f);
  const int wall = stage.add(solid);
  stage.quad(-1, -1, 9, 9, 2.0, front);
  stage.quad(9, -1, -1, 9, 3.0, front);  // turns its back
  stage.quad(-1, -1, 9, 9, 4.0, wall);
  stage.quad(-1, -1, 9, 9, 5.0, front);  // behind the wall
  stage.quad(-1, -1, 9, 9, 7.0, wall);
  const Lists lists = traced(stage.scene, stage.gbuffer, stage.camera, settingsOf(MaskEdge::smooth));
  for (const auto& pixel : lists.pixels) {
    ASSERT_EQ(pixel.size(), 1u);
    EXPECT_NEAR(pixel[0].z, 2.0f, 1e-6f);
    EXPECT_EQ(pixel[0].coverage, 0.5f);
  }
  for (std::size_t i = 0; i < lists.solid.size(); ++i) EXPECT_NEAR(lists.solid[i].a, 4.0f, 1e-5f);
}

// Bands, threads and the budget change nothing.
TEST(RayFragments, ThreadsAndBudgetChangeNoBit) {
  const Scene scene = sceneOf(makeSample("bottles") + ".glb");
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 160, 90};
  gbuffer.viewZ = Image<float>(160, 90, INFINITY);
  const Camera camera = cameraIn(scene, gbuffer.display);
  PassSettings settings = settingsOf(MaskEdge::smooth);
  const Lists many = traced(scene, gbuffer, camera, settings);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  settings.budgetBytes = 4096;
  const Lists few = traced(scene, gbuffer, camera, settings);
  std::size_t fragments = 0;
  for (std::size_t i = 0; i < many.pixels.size(); ++i) {
    ASSERT_EQ(many.pixels[i].size(), few.pixels[i].size());
    fragments += many.pixels[i].size();
    if (many.pixels[i].empty()) continue;
    EXPECT_EQ(std::memcmp(many.pixels[i].data(), few.pixels[i].data(), many.pixels[i].size() * sizeof(Fragment)), 0);
  }
  EXPECT_GT(fragments, 1000u);
}

TEST(RayFragments, MipmapsAreRefused) {
  Stage stage(4, 4);
  RayFragments lists(stage.scene, stage.gbuffer, stage.camera);
  EXPECT_THROW(lists.fragments(PassSettings{}, [](const FragmentLists&) {}), UsageError);
}

}  // namespace
}  // namespace pellucid::test
