// Shadows that transparent things cast on each other and on themselves: the GL pass by maps against fragments by rays,
// whose lights are dimmed by rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "tests/shadow/scenes.h"

namespace pellucid {
namespace {

using namespace test;
using Form = ShadowMapSettings::Form;

// Looks along -z at sheets of smoke that face a sun behind the camera.
struct Sheets {
  explicit Sheets(int count, float alpha) {
    gbuffer.display = gbuffer.data = {0, 0, 32, 32};
    gbuffer.viewZ = Image<float>(32, 32, std::numeric_limits<float>::infinity());
    camera.focal = {2, 2};
    for (int i = 0; i < count; ++i) {
      Primitive sheet = quad(0, 1.5f);
      for (Vertex& vertex : sheet.vertices) {
        vertex.position = {vertex.position.x, -vertex.position.z,
                           -4.0f - 2.0f * static_cast<float>(i) / static_cast<float>(count)};
        vertex.normal = {0, 0, 1};
      }
      Material smoke = glass(glm::vec3(1.0f));
      smoke.transmission = 0.0f;
      smoke.alphaMode = AlphaMode::blend;
      smoke.roughness = 1.0f;
      smoke.baseColor.a = alpha;
      add(scene, sheet, smoke);
    }
    scene.lights = {sun({.1, .05, -1})};
  }
  Scene scene;
  GBuffer gbuffer;
  Camera camera;
};

// Fragments of every pixel, by depth.
std::vector<std::vector<Fragment>> sorted(const std::vector<FragmentLists>& tiles) {
  std::vector<std::vector<Fragment>> pixels;
  for (const FragmentLists& lists : tiles)
    for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i) {
      pixels.emplace_back(lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i]),
                          lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[i + 1]));
      std::sort(pixels.back().begin(), pixels.back().end(),
                [](const Fragment& a, const Fragment& b) { return a.z < b.z; });
    }
  return pixels;
}

std::vector<std::vector<Fragment>> byGl(const Sheets& sheets, const PassSettings& settings) {
  GlContext context;
  TransparentPass pass(context, sheets.scene, sheets.gbuffer, sheets.camera);
  std::vector<FragmentLists> tiles;
  pass.fragments(settings, [&](const FragmentLists& lists) { tiles.push_back(lists); });
  return sorted(tiles);
}

std::vector<std::vector<Fragment>> byRays(const Sheets& sheets, PassSettings settings, bool traced) {
  settings.filter = TextureFilter::bilinear;
  RayFragments rays(sheets.scene, sheets.gbuffer, sheets.camera);
  if (traced) rays.shadowBy(std::make_shared<const ShadowRays>(sheets.scene, sheets.camera));
  std::vector<FragmentLists> tiles;
  rays.fragments(settings, [&](const FragmentLists& lists) { tiles.push_back(lists); });
  return sorted(tiles);
}

PassSettings shadowedBy(const Sheets& sheets, Form form) {
  GlContext context;
  ShadowMapSettings maps;
  maps.form = form;
  maps.size = 1024;
  PassSettings settings;
  settings.shadows =
      std::make_shared<const ShadowMaps>(renderShadowMaps(context, sheets.scene, sheets.camera, nullptr, maps));
  return settings;
}

double lightOf(const Fragment& fragment) {
  return static_cast<double>(fragment.radiance.g / fragment.coverage);
}

TEST(SelfShadow, SmokeDarkensAwayFromTheLight) {
  for (const auto& [count, alpha] : {std::pair(1, .5f), std::pair(4, .4f), std::pair(40, .05f)}) {
    const Sheets sheets(count, alpha);
    const auto open = byGl(sheets, {}), truth = byRays(sheets, {}, true);
    const std::size_t middle = 16 * 32 + 16;
    ASSERT_EQ(truth[middle].size(), static_cast<std::size_t>(count));
    for (const Form form : {Form::variance, Form::corrected}) {
      const auto mapped = byGl(sheets, shadowedBy(sheets, form));
      double error = 0, unshadowed = 0, brightest = 0, number = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        ASSERT_EQ(mapped[i].size(), truth[i].size());
        for (std::size_t k = 0; k < truth[i].size(); ++k) {
          error += std::abs(lightOf(mapped[i][k]) - lightOf(truth[i][k]));
          unshadowed += std::abs(lightOf(open[i][k]) - lightOf(truth[i][k]));
          brightest = std::max(brightest, lightOf(open[i][k]));
          EXPECT_LE(lightOf(mapped[i][k]), lightOf(open[i][k]) * 1.00001);
          ++number;
        }
      }
      error /= number * brightest;
      unshadowed /= number * brightest;
      std::printf(
          "%2d sheets, %s: light of a fragment off by %.4f of the full light; %.4f without shadows; last sheet "
          "%.3f of the first, by rays %.3f\n",
          count, form == Form::variance ? "variance" : "corrected", error, unshadowed,
          lightOf(mapped[middle].back()) / lightOf(mapped[middle].front()),
          lightOf(truth[middle].back()) / lightOf(truth[middle].front()));
      if (count == 1)
        EXPECT_LT(error, 1e-5);  // a lone sheet does not shadow itself; rays shade it at the rounded depth
      else
        EXPECT_LT(error, (count == 4 ? .4 : .2) * unshadowed);  // four sheets are no slab
    }
  }
}

// The CPU's lookup of the same maps, in fragments by rays.
TEST(SelfShadow, RaysReadTheSameMaps) {
  const Sheets sheets(4, .4f);
  const PassSettings settings = shadowedBy(sheets, Form::variance);
  const auto gl = byGl(sheets, settings), cpu = byRays(sheets, settings, false);
  double worst = 0;
  for (std::size_t i = 0; i < gl.size(); ++i)
    for (std::size_t k = 0; k < gl[i].size(); ++k)
      worst = std::max(worst, std::abs(lightOf(gl[i][k]) - lightOf(cpu[i][k])));
  std::printf("GL against CPU: at most %.2g\n", worst);
  EXPECT_LT(worst, 1e-4);  // positions are rasterised on one side, traced on the other
}

}  // namespace
}  // namespace pellucid
