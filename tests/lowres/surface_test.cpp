// Thin layers of low resolution on opaque surfaces and just behind them, as the C library meets them: the depths around
// a pixel tell its surface.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/low_resolution.h"
#include "composite/resolve.h"

namespace pellucid::test {
namespace {

constexpr int kSize = 96, kInside = 24;

struct Surface {
  const char* name;
  double (*depth)(double x, double y);  // at a place in pixels, metres
};

// Opacity of what addLowResolution() makes of one layer of opacity 1/2 in every texel, at `scale` times the depth that
// the surface has at the texel's sample: the least and the most, away from the picture's border.
glm::dvec2 shownOf(const Surface& surface, int factor, double scale) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, kSize, kSize};
  gbuffer.viewZ = Image<float>(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) gbuffer.viewZ.at(x, y) = static_cast<float>(surface.depth(x + 0.5, y + 0.5));
  OitPlanes planes = emptyPlanes(gbuffer.display, gbuffer.data);
  const LowView view = lowViewOf(gbuffer, planes.solid, Camera{}, factor);
  OitPlanes low = emptyPlanes(view.gbuffer.display, view.gbuffer.data);
  for (int j = 0; j < low.weight.height(); ++j)
    for (int i = 0; i < low.weight.width(); ++i) {
      shading::Layer layer;
      layer.radiance = glm::vec3(0.5f);
      layer.coverage = 1.0f;
      layer.transmission = glm::vec3(0.5f);
      layer.z = static_cast<float>(scale * surface.depth((i + 0.5) * factor, (j + 0.5) * factor));
      if (layer.z > view.gbuffer.viewZ.at(i, j)) continue;  // the low pass has tested it
      const shading::OitTargets t =
          shading::packSums(shading::layerSums(layer, low.info.weight, shading::PLD_NORMALISE_SPECTRAL));
      low.radiance.at(i, j) = t.radiance, low.weight.at(i, j) = t.weight, low.opacity.at(i, j) = t.opacity;
      low.depth.at(i, j) = t.depth, low.light.at(i, j) = t.light, low.frontZ.at(i, j) = layer.z;
    }
  addLowResolution(low, view, {0.5, 0.5}, planes);
  const Veil veil = resolve(planes, {});
  glm::dvec2 shown(1.0, 0.0);
  for (int y = kInside; y < kSize - kInside; ++y)
    for (int x = kInside; x < kSize - kInside; ++x) {
      const double opacity = 1.0 - static_cast<double>(veil.transmission[static_cast<std::size_t>(y * kSize + x)].r);
      shown = {std::min(shown.x, opacity), std::max(shown.y, opacity)};
    }
  return shown;
}

TEST(LowResolution, ThinLayersAreMetOnSlantedAndRoundSurfaces) {
  const Surface surfaces[] = {
      {"facing", [](double, double) { return 5.0; }},
      {"slanted", [](double x, double) { return 5.0 / (1.0 + 0.002 * (x - 48.0)); }},
      {"steep", [](double x, double y) { return 5.0 / (1.0 + 0.008 * (x - 48.0) - 0.005 * (y - 48.0)); }},
      {"parallel rays", [](double x, double y) { return 5.0 + 0.04 * (x - 48.0) + 0.02 * (y - 48.0); }},
      {"round",
       [](double x, double y) {
         return 5.0 - 0.01 * std::sqrt(200.0 * 200.0 - (x - 48) * (x - 48) - (y - 48) * (y - 48));
       }},
  };
  for (const Surface& surface : surfaces)
    for (const int factor : {2, 4, 8}) {
      SCOPED_TRACE(testing::Message() << surface.name << ", 1/" << factor);
      const glm::dvec2 on = shownOf(surface, factor, 1.0), behind = shownOf(surface, factor, 1.01);
      std::printf("%s, 1/%d: %.4f to %.4f of .5 on it, %.4f at most behind it\n", surface.name, factor, on.x, on.y,
                  behind.y);
      EXPECT_NEAR(on.x, 0.5, 1e-6);
      EXPECT_NEAR(on.y, 0.5, 1e-6);
      EXPECT_EQ(behind.y, 0.0);
    }
}

}  // namespace
}  // namespace pellucid::test
