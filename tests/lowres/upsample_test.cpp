// Layers drawn at low resolution: clean edges, no dark rims, and the same picture where nothing varies.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "composite/low_resolution.h"
#include "composite/resolve.h"
#include "shaders/low_resolution_text.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// A stage whose marked layers are drawn once at full and once at low resolution.
struct MixedStage : Stage {
  MixedStage(int width, int height) : Stage(width, height) {
    gbuffer.beauty = Image<glm::vec4>(width, height, glm::vec4(0.3f, 0.3f, 0.3f, 1));
  }
  int addLow(Material material) {
    material.lowResolution = true;
    return add(material);
  }
  OitPlanes mixed(int factor, glm::dvec2 sample = {0.5, 0.5}) {
    GlContext context;
    TransparentPass pass(context, scene, gbuffer, camera);
    PassSettings settings;
    settings.sample = sample;
    settings.layers = LayerChoice::fullResolution;
    OitPlanes planes = pass.accumulate(settings);
    view = lowViewOf(gbuffer, planes.solid, camera, factor);
    settings.layers = LayerChoice::lowResolution;
    pass.over(view.gbuffer, view.camera);
    low = pass.accumulate(settings);
    addLowResolution(low, view, settings.sample, planes);
    return planes;
  }
  Image<glm::vec4> pictureOf(const OitPlanes& planes) const {
    return compose(resolveOver(planes, {}, {}, gbuffer), gbuffer).rgba;
  }
  LowView view;
  OitPlanes low;
};

// Smoke as soft cards at several depths, with opaque posts, a thin wire and a floor among them.
MixedStage smokyStage(int width = 160, int height = 96) {
  MixedStage stage(width, height);
  Random random(31);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float z = y > height * 2 / 3 ? 3.0f * static_cast<float>(height) / static_cast<float>(y) : kSky;
      glm::vec4 colour(0.25f, 0.35f, 0.5f, 1);
      if (z < kSky) colour = glm::vec4(0.3f, 0.28f, 0.2f, 1);
      const bool post = (x > 30 && x < 47) || x == 77 || (x > 100 && x < 103);
      if (post) z = 2.5f, colour = glm::vec4(0.6f, 0.1f, 0.05f, 1);
      if (x > 120 && x < 140 && y > 30) z = 4.3f, colour = glm::vec4(0.1f, 0.5f, 0.15f, 1);
      stage.gbuffer.viewZ.at(x, y) = z;
      stage.gbuffer.beauty.at(x, y) = colour;
    }
  std::vector<glm::vec4> texels;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double r = std::hypot(x - 15.5, y - 15.5) / 16.0;
      texels.push_back(glm::vec4(1, 1, 1, static_cast<float>(std::max(0.0, 1.0 - r * r))));
    }
  Material smoke = unlitBlend(glm::vec3(0.8f, 0.78f, 0.75f), 0.5f);
  smoke.baseColorTexture.texture = stage.texture(32, 32, texels);
  const int soft = stage.addLow(smoke);
  for (int i = 0; i < 24; ++i) {
    const double x = random.between(-20, width), y = random.between(-10, height), edge = random.between(40, 70);
    stage.quad(x, y, x + edge, y + edge, random.between(2.7, 6.0), soft);
  }
  return stage;
}

struct Deviation {
  double worst = 0, mean = 0;
  int x = 0, y = 0;
};

// By how much each pixel lies outside the range that the picture of full resolution has within `reach` pixels of it, on
// the same surface: the same opaque colour before the smoke.
Deviation outsideRange(const Image<glm::vec4>& found, const Image<glm::vec4>& full, const GBuffer& gbuffer, int reach) {
  Deviation deviation;
  double sum = 0;
  for (int y = 0; y < full.height(); ++y)
    for (int x = 0; x < full.width(); ++x) {
      glm::vec4 low = full.at(x, y), high = low;
      for (int j = std::max(y - reach, 0); j <= std::min(y + reach, full.height() - 1); ++j)
        for (int i = std::max(x - reach, 0); i <= std::min(x + reach, full.width() - 1); ++i)
          if (gbuffer.beauty.at(i, j) == gbuffer.beauty.at(x, y)) {
            low = glm::min(low, full.at(i, j));
            high = glm::max(high, full.at(i, j));
          }
      for (int c = 0; c < 3; ++c) {
        const double outside =
            static_cast<double>(std::max({0.0f, low[c] - found.at(x, y)[c], found.at(x, y)[c] - high[c]}));
        sum += std::abs(static_cast<double>(found.at(x, y)[c] - full.at(x, y)[c]));
        if (outside > deviation.worst) deviation.worst = outside, deviation.x = x, deviation.y = y;
      }
    }
  deviation.mean = sum / (3.0 * static_cast<double>(full.size()));
  return deviation;
}

TEST(LowResolution, EdgesBetweenOpaqueThingsAndSmokeAreClean) {
  MixedStage stage = smokyStage();
  const Image<glm::vec4> full = stage.pictureOf(stage.accumulate());
  // A texel is half a block away from its pixels' ends, and seen from up to a tent's half width away.
  for (const int factor : {2, 4, 8}) {
    const int reach = static_cast<int>(std::ceil((shading::PLD_UPSAMPLE_TENT + 0.5f) * static_cast<float>(factor)));
    const Deviation deviation = outsideRange(stage.pictureOf(stage.mixed(factor)), full, stage.gbuffer, reach);
    std::printf(
        "low resolution %dx%d: at most %.4f outside the range of the neighbours, at (%d, %d); mean error %.4f\n",
        factor, factor, deviation.worst, deviation.x, deviation.y, deviation.mean);
    EXPECT_LE(deviation.worst, factor == 2 ? 0.01 : factor == 4 ? 0.025 : 0.1);
  }
}

// Light that the edges of a dark, dense volume take from a bright background beyond what they take at full resolution,
// in pixels per edge.
double lightLost(const Image<glm::vec4>& found, const Image<glm::vec4>& full) {
  double lost = 0;
  for (int x = 0; x < full.width(); ++x)
    lost += static_cast<double>(full.at(x, 32).r) - static_cast<double>(found.at(x, 32).r);
  return lost / 2;
}

// The order that must not be: raw sums are brought up, and normalised afterwards. MODEL section 7
OitPlanes fromRawSums(const MixedStage& stage, const OitPlanes& empty) {
  OitPlanes planes = empty;
  const auto factor = static_cast<float>(stage.view.factor);
  for (int y = 0; y < planes.data.height(); ++y)
    for (int x = 0; x < planes.data.width(); ++x) {
      const glm::vec2 place = (glm::vec2(x, y) + 0.5f) / factor - 0.5f;
      const int cx = static_cast<int>(std::floor(place.x + 0.5f)), cy = static_cast<int>(std::floor(place.y + 0.5f));
      float shares = 0;
      const auto texels = [&](auto&& each) {
        for (int j = std::max(cy - 3, 0); j <= std::min(cy + 3, stage.low.data.height() - 1); ++j)
          for (int i = std::max(cx - 3, 0); i <= std::min(cx + 3, stage.low.data.width() - 1); ++i)
            each(i, j,
                 shading::upsampleShare(glm::vec2(i, j) - place, stage.view.opaqueZ.at(x, y),
                                        stage.view.gbuffer.viewZ.at(i, j)));
      };
      texels([&](int, int, float share) { shares += share; });
      texels([&](int i, int j, float share) {
        const float s = share / shares;
        planes.radiance.at(x, y) += s * stage.low.radiance.at(i, j);
        planes.weight.at(x, y) += s * stage.low.weight.at(i, j);
        planes.opacity.at(x, y) += s * stage.low.opacity.at(i, j);
        planes.depth.at(x, y) += s * stage.low.depth.at(i, j);
        planes.light.at(x, y) += s * stage.low.light.at(i, j);
      });
    }
  return planes;
}

TEST(LowResolution, VolumeEdgesAreNotDarkened) {
  MixedStage stage(128, 64);
  stage.gbuffer.viewZ = Image<float>(128, 64, 20.0f);
  stage.gbuffer.beauty = Image<glm::vec4>(128, 64, glm::vec4(1));
  const int dark = stage.addLow(unlitBlend(glm::vec3(0.0f), 0.7f));
  for (int i = 0; i < 6; ++i) stage.quad(36, 0, 92, 64, 3.0 + 0.5 * i, dark);
  const Image<glm::vec4> full = stage.pictureOf(stage.accumulate());
  const OitPlanes none = emptyPlanes(stage.gbuffer.display, stage.gbuffer.data);
  for (const int factor : {2, 4, 8}) {
    const double right = lightLost(stage.pictureOf(stage.mixed(factor)), full);
    const double wrong = lightLost(stage.pictureOf(fromRawSums(stage, none)), full);
    std::printf("volume edges at %dx%d: %.4f px of light lost per edge; normalised after: %.2f px\n", factor, factor,
                right, wrong);
    EXPECT_LE(std::abs(right), 0.01);
    EXPECT_GT(wrong, 0.1 * factor);
  }
}

// Where neither smoke nor depth varies, low resolution is no approximation at all but for how layers average.
TEST(LowResolution, EvenSmokeIsTheSameAtEveryResolution) {
  MixedStage stage(64, 48);
  stage.gbuffer.viewZ = Image<float>(64, 48, 9.0f);
  const int smoke = stage.addLow(unlitBlend(glm::vec3(0.7f, 0.6f, 0.5f), 0.4f));
  for (int i = 0; i < 3; ++i) stage.quad(0, 0, 64, 48, 3.0 + i, smoke);
  const Image<glm::vec4> full = stage.pictureOf(stage.accumulate());
  for (const int factor : {2, 4, 8})
    for (const glm::dvec2 sample : {glm::dvec2(0.5), glm::dvec2(0.1, 0.9)}) {
      const Image<glm::vec4> found = stage.pictureOf(stage.mixed(factor, sample));
      for (std::size_t i = 0; i < full.size(); ++i)
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(found[i][c], full[i][c], 2e-6f) << factor << ' ' << i;
    }
}

// Glass at full resolution over smoke at low: the smoke enters the sums as one layer with its mean weight.
TEST(LowResolution, GlassOverSmokeBlendsAsAtFullResolution) {
  MixedStage stage(64, 48);
  stage.gbuffer.viewZ = Image<float>(64, 48, 9.0f);
  const int smoke = stage.addLow(unlitBlend(glm::vec3(0.7f, 0.6f, 0.5f), 0.3f));
  for (int i = 0; i < 3; ++i) stage.quad(0, 0, 64, 48, 4.0 + 0.01 * i, smoke);
  stage.quad(10, 10, 50, 40, 2.0, stage.add(unlitBlend(glm::vec3(0.1f, 0.2f, 0.8f), 0.5f)));
  const Image<glm::vec4> full = stage.pictureOf(stage.accumulate());
  const Image<glm::vec4> found = stage.pictureOf(stage.mixed(4));
  for (std::size_t i = 0; i < full.size(); ++i)
    for (int c = 0; c < 4; ++c) ASSERT_NEAR(found[i][c], full[i][c], 1e-5f) << i;
}

// An odd window, off the display's corner, through an off-centre lens: the smoke lies where it does at full resolution.
TEST(LowResolution, SmokeStaysInItsPlaceInAnyWindow) {
  MixedStage stage(203, 117);
  stage.gbuffer.data = {-7, 5, 90, 106};
  stage.camera.centre = {0.1, -0.2};
  const int width = stage.gbuffer.data.width(), height = stage.gbuffer.data.height();
  stage.gbuffer.viewZ = Image<float>(width, height, 20.0f);
  stage.gbuffer.beauty = Image<glm::vec4>(width, height, glm::vec4(0, 0, 0, 1));
  std::vector<glm::vec4> texels;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      texels.push_back(
          glm::vec4(1, 1, 1, std::exp(-0.01f * static_cast<float>((x - 40) * (x - 40) + (y - 30) * (y - 30)))));
  Material light = unlitBlend(glm::vec3(1), 0.9f);
  light.baseColorTexture.texture = stage.texture(64, 64, texels);
  stage.quad(10, 30, 78, 98, 5.0, stage.addLow(light));
  const Image<glm::vec4> full = stage.pictureOf(stage.accumulate());
  const auto centre = [&](const Image<glm::vec4>& picture) {
    glm::dvec3 sum(0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) sum += static_cast<double>(picture.at(x, y).r) * glm::dvec3(x, y, 1);
    return glm::dvec2(sum) / sum.z;
  };
  for (const int factor : {2, 4, 8}) {
    const double moved = glm::length(centre(stage.pictureOf(stage.mixed(factor))) - centre(full));
    std::printf("low resolution %dx%d: the centre of a soft ball moves by %.3f px\n", factor, factor, moved);
    EXPECT_LE(moved, 0.05 * factor);  // what sampling a soft ball at so few points leaves
  }
}

// Marked glass refracts and diffuses as unmarked glass does: in pixels, not in texels.
TEST(LowResolution, ScatteringIsInPixels) {
  MixedStage stage(64, 64);
  stage.gbuffer.viewZ = Image<float>(64, 64, 12.0f);
  Material glass;
  glass.transmission = 1.0f;
  glass.metallic = 0.0f;
  glass.roughness = 0.4f;
  glass.ior = 1.5f;
  glass.dispersion = 1.0f;
  glass.volume = glass.doubleSided = true;
  glass.thickness = 0.1f;
  stage.slanted(0, 0, 64, 64, 4.0, 5.0, stage.addLow(glass));
  const OitPlanes full = stage.accumulate(), found = stage.mixed(4);
  ASSERT_TRUE(found.scatters() && found.disperses());
  for (const int x : {20, 33, 41}) {
    const glm::vec4 a = full.refraction.at(x, 30), b = found.refraction.at(x, 30);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(b[c], a[c], 0.02f * std::abs(a[c]) + 3e-3f) << c;
    const glm::vec4 d = full.dispersion.at(x, 30), e = found.dispersion.at(x, 30);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(e[c], d[c], 0.02f * std::abs(d[c]) + 1e-3f) << c;
    EXPECT_NEAR(found.light.at(x, 30).a, full.light.at(x, 30).a, 0.01f);
    EXPECT_NEAR(found.diffuseZ.at(x, 30), full.diffuseZ.at(x, 30), 0.3f);
  }
}

// MODEL section 12: extremes stay finite.
TEST(LowResolution, ExtremesStayFinite) {
  Random random(8);
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 23, 17};
  gbuffer.viewZ = Image<float>(23, 17);
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i)
    gbuffer.viewZ[i] = random.below(3) ? static_cast<float>(std::pow(10.0, random.between(-6, 9))) : kSky;
  for (const int factor : {2, 4, 8}) {
    OitPlanes planes = emptyPlanes(gbuffer.display, gbuffer.data);
    const LowView view = lowViewOf(gbuffer, planes.solid, Camera{}, factor);
    OitPlanes low = emptyPlanes(view.gbuffer.display, view.gbuffer.data);
    for (std::size_t i = 0; i < low.weight.size(); ++i) {
      if (random.below(4) == 0) continue;
      shading::Layer layer;
      layer.coverage = random.below(3) ? random.uniformf() : static_cast<float>(random.below(2));
      layer.transmission = glm::vec3(random.below(3) ? random.uniformf() : static_cast<float>(random.below(2)));
      layer.radiance = glm::vec3(static_cast<float>(std::pow(10.0, random.between(-30, 6))));
      layer.z = static_cast<float>(std::pow(10.0, random.between(-6, 9)));
      const shading::OitTargets t =
          shading::packSums(shading::layerSums(layer, low.info.weight, shading::PLD_NORMALISE_SPECTRAL));
      low.radiance[i] = t.radiance, low.weight[i] = t.weight, low.opacity[i] = t.opacity;
      low.depth[i] = t.depth, low.light[i] = t.light, low.frontZ[i] = layer.z;
      if (random.below(4) == 0) low.solid[i] = glm::vec4(1e6f, 0, 1, layer.z * 2);
    }
    addLowResolution(low, view, {0.5, 0.5}, planes);
    const Veil veil = resolve(planes, {});
    for (std::size_t i = 0; i < veil.light.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(veil.light[i][c]) && veil.light[i][c] >= 0) << i;
        EXPECT_TRUE(veil.transmission[i][c] >= 0 && veil.transmission[i][c] <= 1) << i;
      }
  }
}

}  // namespace
}  // namespace pellucid::test
