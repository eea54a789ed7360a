// PT17 figs. 12c and d: the colour where tinted bottles overlap, with and without self-modulation, against `over`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "composite/fold_exact.h"
#include "composite/over.h"
#include "composite/resolve.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

// Degrees of the hexagonal hue; chroma is the largest less the smallest channel.
struct Hue {
  double angle, chroma;
};
Hue hueOf(const glm::vec4& rgb) {
  const double r = static_cast<double>(rgb.r), g = static_cast<double>(rgb.g), b = static_cast<double>(rgb.b);
  const double a = r - 0.5 * (g + b), y = std::sqrt(0.75) * (g - b);
  return {std::atan2(y, a) * 180 / 3.14159265358979, std::max({r, g, b}) - std::min({r, g, b})};
}

// Layers of a pixel from which on more than one bottle covers it: a bottle shows its two faces.
constexpr float kOverlap = 3.0f;

TEST(SelfModulation, HueWhereBottlesOverlap) {
  const std::string folder = freshFolder("self-modulation");
  RunOptions generator;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({folder, "bottles", "180"}, generator).code, 0);
  const GBuffer gbuffer = readOpaque(folder + "/bottles.exr", {}).gbuffer;
  const Scene scene = loadScene({folder + "/bottles.glb"}, {});
  ASSERT_TRUE(gbuffer.camera.has_value());
  GlContext context;
  TransparentPass pass(context, scene, gbuffer, *gbuffer.camera);
  PassSettings settings;
  settings.surroundings = glm::vec3(0.34f, 0.37f, 0.42f);  // the sample's own
  settings.scatter.refract = shading::PLD_REFRACT_OFF;     // the figure's plastic does not refract
  settings.scatter.k0 = 0.0f;

  Veil truthVeil(gbuffer.data.width(), gbuffer.data.height());
  OitPlanes planes[2] = {emptyPlanes(gbuffer.display, gbuffer.data), emptyPlanes(gbuffer.display, gbuffer.data)};
  pass.fragments(settings, [&](const FragmentLists& lists) {
    compositeSorted(lists, gbuffer.data, truthVeil);
    for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED})
      foldExact(lists, settings.weight, normalisation, planes[normalisation]);
  });
  const Picture truth = compose(truthVeil, gbuffer);

  std::printf("bottles at overlaps:  normalisation  self-modulation  hue error  colour error (RMS)\n");
  double hue[2][2], colour[2][2];
  for (const int normalisation : {shading::PLD_NORMALISE_PUBLISHED, shading::PLD_NORMALISE_SPECTRAL})
    for (const bool modulates : {false, true}) {
      ResolveSettings resolveSettings;
      resolveSettings.selfModulation = modulates;
      const Picture picture = compose(resolve(planes[normalisation], resolveSettings), gbuffer);
      double angles = 0, squares = 0, weights = 0;
      std::size_t pixels = 0;
      for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        if (planes[0].weight[i].a < kOverlap) continue;
        const Hue found = hueOf(picture.rgba[i]), right = hueOf(truth.rgba[i]);
        double angle = std::abs(found.angle - right.angle);
        angle = std::min(angle, 360 - angle);
        angles += angle * right.chroma;
        weights += right.chroma;
        for (int c = 0; c < 3; ++c) {
          const double error = static_cast<double>(picture.rgba[i][c] - truth.rgba[i][c]);
          squares += error * error / 3;
        }
        ++pixels;
      }
      ASSERT_GT(pixels, 300u);
      hue[normalisation][modulates] = angles / weights;
      colour[normalisation][modulates] = std::sqrt(squares / static_cast<double>(pixels));
      std::printf("  %6zu pixels         %-14s %-16s %6.2f deg  %.4f\n", pixels,
                  normalisation == shading::PLD_NORMALISE_PUBLISHED ? "published" : "spectral",
                  modulates ? "with" : "without", hue[normalisation][modulates], colour[normalisation][modulates]);
    }
  constexpr int published = shading::PLD_NORMALISE_PUBLISHED, spectral = shading::PLD_NORMALISE_SPECTRAL;
  // What figs. 12c and d show: it helps the published form.
  EXPECT_LT(hue[published][true], hue[published][false]);
  // Why it is off with the spectral one: that is nearer to begin with.
  EXPECT_LT(colour[spectral][false], colour[published][true]);
}

}  // namespace
}  // namespace pellucid::test
