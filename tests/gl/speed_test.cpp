// Figures for the log, not gates: the machine under a test is not a quiet one. Fails only on wrong counts.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

constexpr int kFrameWidth = 1920, kFrameHeight = 1080, kLayers = 8;

void report(const char* what, const Material& material, bool lights) {
  Stage stage(kFrameWidth, kFrameHeight);
  const int index = stage.add(material);
  for (int i = 0; i < kLayers; ++i) stage.quad(0, 0, kFrameWidth, kFrameHeight, 2.0 + i, index);
  for (int i = 0; lights && i < 3; ++i) {
    Light light;
    light.intensity = 1.0f;
    light.position = {i - 1.0, 1, -1};
    stage.scene.lights.push_back(light);
  }
  PassSettings settings;
  if (lights) settings.surroundings = glm::vec3(0.2f);
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  double sums = 1e9, lists = 1e9;
  for (int run = 0; run < 3; ++run) {
    const OitPlanes planes = pass.accumulate(settings);
    sums = std::min(sums, pass.statistics().seconds);
    ASSERT_EQ(planes.weight.at(960, 540).a, static_cast<float>(kLayers));
  }
  for (int run = 0; run < 2; ++run) {
    std::size_t fragments = 0;
    pass.fragments(settings, [&](const FragmentLists& tile) { fragments += tile.fragments.size(); });
    lists = std::min(lists, pass.statistics().seconds);
    ASSERT_EQ(fragments, std::size_t{kLayers} * kFrameWidth * kFrameHeight);
  }
  std::printf("%d full-screen layers at %dx%d, %s: planes %.0f ms, lists %.0f ms\n", kLayers, kFrameWidth, kFrameHeight,
              what, sums * 1e3, lists * 1e3);
}

TEST(Speed, UnlitLayers) {
  report("unlit blend", unlitBlend({0.5f, 0.4f, 0.3f}, 0.3f), false);
}

TEST(Speed, LitGlass) {
  Material glass;
  glass.doubleSided = true;
  glass.transmission = 0.9f;
  glass.metallic = 0.0f;
  glass.roughness = 0.3f;
  report("glass, 3 lights and surroundings", glass, true);
}

}  // namespace
}  // namespace pellucid::test
