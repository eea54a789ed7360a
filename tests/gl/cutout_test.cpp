// Cut-outs and blended pictures at every distance: colours are weighted by their alpha, and masks keep their mean
// coverage.
#include <gtest/gtest.h>

#include <functional>

#include "composite/antialias.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// All of a pass: fragments and solids, coverage and colour by pixel. One layer a pixel.
struct Seen {
  Image<float> coverage;
  Image<glm::vec3> colour;
  explicit Seen(const std::vector<FragmentLists>& tiles, const Window& data)
      : coverage(data.width(), data.height(), 0.0f), colour(data.width(), data.height(), glm::vec3(0.0f)) {
    for (const FragmentLists& lists : tiles) {
      std::size_t i = 0;
      for (int y = lists.window.y0; y < lists.window.y1; ++y)
        for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i) {
          const glm::vec4& solid = lists.solid[i];
          const auto layers = lists.offsets[i + 1] - lists.offsets[i];
          EXPECT_LE(layers, solid.a < kSky ? 0u : 1u) << x << ' ' << y;
          if (solid.a < kSky) {
            coverage.at(x, y) = 1.0f;
            colour.at(x, y) = glm::vec3(solid);
          } else if (layers == 1) {
            const Fragment& fragment = lists.fragments[lists.offsets[i]];
            coverage.at(x, y) = fragment.coverage;
            colour.at(x, y) = fragment.radiance / fragment.coverage;
          }
        }
    }
  }
};

Seen see(Stage& stage, const PassSettings& settings) {
  return Seen(stage.fragments(settings), stage.gbuffer.data);
}

constexpr AlphaMode kBlend = AlphaMode::blend, kMask = AlphaMode::mask;

// Between two texels alpha says how far, and so what the colour is.
TEST(WeightedColour, MagnifiedEdgesInClosedForm) {
  const glm::vec4 pairs[][2] = {{{1, 0.5f, 0.25f, 1}, {0, 0, 0, 0}},
                                {{1, 0, 0, 0.75f}, {0, 1, 0, 0.25f}},
                                {{0.2f, 0.4f, 0.8f, 0.9f}, {10, 20, 30, 0.1f}}};
  for (const auto& pair : pairs)
    for (const AlphaMode mode : {kBlend, kMask}) {
      Stage stage(64, 4);
      Material material = unlitBlend({1, 1, 1}, 1.0f);
      material.alphaMode = mode;
      material.alphaCutoff = 0.05f;
      material.coverage = 0.5f;  // nothing is solid
      material.baseColorTexture.texture = stage.texture(2, 1, {pair[0], pair[1]});
      stage.quad(0, 0, 64, 4, 2.0, stage.add(material));
      PassSettings settings;
      settings.filter = TextureFilter::bilinear;
      const Seen seen = see(stage, settings);
      int between = 0;
      for (int x = 0; x < 64; ++x) {
        const float there = seen.coverage.at(x, 2) / 0.5f;
        if (!(there > 0.0f)) continue;
        // A mask's coverage is not its alpha: take the place of the pixel there.
        const float u = glm::clamp((static_cast<float>(x) + 0.5f) / 32.0f - 0.5f, 0.0f, 1.0f);
        const float second = mode == kBlend ? (there - pair[0].a) / (pair[1].a - pair[0].a) : u;
        const glm::vec4 a = pair[0], b = pair[1];
        const glm::vec3 expected =
            (glm::vec3(a) * a.a * (1 - second) + glm::vec3(b) * b.a * second) / (a.a * (1 - second) + b.a * second);
        between += second > 0.01f && second < 0.99f ? 1 : 0;
        // An alpha near 0 is known to fewer digits; filters of masks' places are known to 1/256 texel.
        const float tolerance = mode == kBlend ? 1e-6f + 2e-7f / there : 0.05f;
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(seen.colour.at(x, 2)[c], expected[c], tolerance * std::max(expected[c], 1.0f)) << x;
      }
      EXPECT_GT(between, 20);
    }
}

TEST(WeightedColour, MinifiedClearTexelsLendNone) {
  for (const glm::vec3 clear : {glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(50.0f)})
    for (const AlphaMode mode : {kBlend, kMask})
      for (const double size : {4.0, 16.0, 64.0, 200.0}) {
        Stage stage(16, 16);
        std::vector<glm::vec4> texels;
        for (int i = 0; i < 256 * 256; ++i)
          texels.push_back(i % 2 == 0 ? glm::vec4(0.25f, 0.5f, 1, 1) : glm::vec4(clear, 0));
        Material material = unlitBlend({1, 1, 1}, 1.0f);
        material.alphaMode = mode;
        material.baseColorTexture.texture = stage.texture(256, 256, texels);
        stage.scene.textures[0].wrapS = stage.scene.textures[0].wrapT = Wrap::repeat;
        material.baseColorTexture.uvTransform[0][0] = material.baseColorTexture.uvTransform[1][1] =
            static_cast<float>(16.0 * size / 256.0);
        stage.quad(0, 0, 16, 16, 2.0, stage.add(material));
        const Seen seen = see(stage, {});
        double covered = 0.0;
        for (std::size_t i = 0; i < seen.coverage.size(); ++i) {
          covered += static_cast<double>(seen.coverage[i]) / 256.0;
          if (!(seen.coverage[i] > 0.0f)) continue;
          EXPECT_NEAR(seen.colour[i].r, 0.25f, 1e-5f);
          EXPECT_NEAR(seen.colour[i].b, 1.0f, 1e-5f);
        }
        EXPECT_NEAR(covered, 0.5, 1e-3) << size << " texels a pixel";
      }
}

// Where alpha is not looked at, clear texels are as good as others.
TEST(WeightedColour, OpaqueAlphaAndCutsAtZeroAreFilteredAsTheyAre) {
  for (const bool mask : {false, true}) {
    Stage stage(64, 4);
    Material material = unlitBlend({1, 1, 1}, 1.0f);
    material.alphaMode = mask ? AlphaMode::mask : AlphaMode::opaque;
    material.alphaCutoff = 0.0f;
    material.coverage = 0.5f;
    material.baseColorTexture.texture = stage.texture(2, 1, {{1, 1, 1, 1}, {0, 0, 0, 0}});
    stage.quad(0, 0, 64, 4, 2.0, stage.add(material));
    PassSettings settings;
    settings.filter = TextureFilter::bilinear;
    const Seen seen = see(stage, settings);
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(seen.coverage.at(x, 2), 0.5f);
      EXPECT_NEAR(seen.colour.at(x, 2).r, glm::clamp(1.5f - (static_cast<float>(x) + 0.5f) / 32.0f, 0.0f, 1.0f), 0.01f);
    }
  }
}

struct Pattern {
  const char* name;
  std::function<float(int, int)> alpha;
  float cutoff;
};

float disc(int x, int y, double radius) {
  const double dx = x % 16 - 7.5, dy = y % 16 - 7.5;
  return dx * dx + dy * dy < radius * radius ? 1.0f : 0.0f;
}

std::vector<Pattern> patterns() {
  static const std::vector<float> noise = [] {
    Random random(3);
    std::vector<float> values;
    for (int i = 0; i < 256 * 256; ++i) values.push_back(random.uniformf() < 0.5f ? 1.0f : 0.0f);
    return values;
  }();
  const auto wave = [](int x, int y) {
    return static_cast<float>(0.5 + 0.25 * std::sin(x * 0.39269908) + 0.25 * std::sin(y * 0.39269908));
  };
  return {{"discs of 20%", [](int x, int y) { return disc(x, y, 4.0); }, 0.5f},
          {"discs of 60%", [](int x, int y) { return disc(x, y, 7.0); }, 0.5f},
          {"discs, a high cut", [](int x, int y) { return disc(x, y, 5.0); }, 0.9f},
          {"blades, 1 texel of 8", [](int x, int) { return x % 8 == 0 ? 1.0f : 0.0f; }, 0.5f},
          {"blades, 3 texels of 16", [](int x, int) { return x % 16 < 3 ? 1.0f : 0.0f; }, 0.5f},
          {"noise", [](int x, int y) { return noise[static_cast<std::size_t>(y * 256 + x)]; }, 0.5f},
          {"a soft wave, cut high", wave, 0.75f},
          {"a soft wave, cut low", wave, 0.3f}};
}

// Without levels to read, samples between texels are tested one by one, and right in the mean.
TEST(CutOuts, WithoutLevelsTheTestAloneDecides) {
  for (const bool flag : {false, true})
    for (const Pattern& pattern : patterns()) {
      std::vector<glm::vec4> texels;
      double painted = 0.0;
      for (int i = 0; i < 256 * 256; ++i) {
        texels.emplace_back(0.0f, 1.0f, 0.0f, pattern.alpha(i % 256, i / 256));
        painted += texels.back().a >= pattern.cutoff ? 1.0 / 65536.0 : 0.0;
      }
      Stage stage(64, 64);
      Material material = unlitBlend({1, 1, 1}, 1.0f);
      material.alphaMode = AlphaMode::mask;
      material.alphaCutoff = pattern.cutoff;
      material.baseColorTexture.texture = stage.texture(256, 256, texels);
      stage.scene.textures[0].wrapS = stage.scene.textures[0].wrapT = Wrap::repeat;
      if (!flag) stage.scene.textures[0].minify = Minify::linear;
      // No multiple of a period, so that samples meet every part of it.
      material.baseColorTexture.uvTransform[0][0] = material.baseColorTexture.uvTransform[1][1] =
          64.0f * 9.17f / 256.0f;
      stage.quad(0, 0, 64, 64, 2.0, stage.add(material));
      PassSettings settings;
      if (flag) settings.filter = TextureFilter::bilinear;
      const Seen seen = see(stage, settings);
      double covered = 0.0;
      for (std::size_t p = 0; p < seen.coverage.size(); ++p) {
        EXPECT_TRUE(seen.coverage[p] == 0.0f || seen.coverage[p] == 1.0f);
        covered += static_cast<double>(seen.coverage[p]) / static_cast<double>(seen.coverage.size());
      }
      // 4096 tests of a part p of them are off by sqrt(p (1 - p)) / 64: .008. Between texels, filtering narrows what
      // lies above a cut near 1.
      if (pattern.cutoff < 0.9f) {
        EXPECT_NEAR(covered, painted, 0.03) << pattern.name;
      }
    }
}

// How a pattern of 256 x 256 texels lies on a picture of 64 x 64 pixels.
struct Laid {
  double texels;     // of one pixel's edge
  double turn;       // radians
  glm::dvec2 first;  // texel at the picture's corner

  glm::dvec2 at(glm::dvec2 pixel) const {
    const double c = std::cos(turn) * texels, s = std::sin(turn) * texels;
    return first + glm::dvec2(c * pixel.x - s * pixel.y, s * pixel.x + c * pixel.y);
  }
};

// Part of the picture that the cut leaves of the filtered alpha.
//   kTests  along an edge: a prime, so that they fall into no step with the texels
template <int kTests = 509>
double areaLeft(const Pattern& pattern, const Laid& laid) {
  int left = 0;
  for (int j = 0; j < kTests; ++j)
    for (int i = 0; i < kTests; ++i) {
      const glm::dvec2 texel = laid.at((glm::dvec2(i, j) + 0.5) * (64.0 / kTests)) - 0.5;
      const glm::dvec2 low = glm::floor(texel), part = texel - low;
      const auto alpha = [&](int dx, int dy) {
        return static_cast<double>(
            pattern.alpha((static_cast<int>(low.x) + dx) & 255, (static_cast<int>(low.y) + dy) & 255));
      };
      left += (alpha(0, 0) * (1 - part.x) + alpha(1, 0) * part.x) * (1 - part.y) +
                  (alpha(0, 1) * (1 - part.x) + alpha(1, 1) * part.x) * part.y >=
              static_cast<double>(pattern.cutoff);
    }
  return static_cast<double>(left) / (static_cast<double>(kTests) * kTests);
}

// Of pictures side by side, each laid in its own way; the mean of so many passes.
std::vector<double> meanCoverages(const Pattern& pattern, const std::vector<Laid>& ways, int passes) {
  const auto count = static_cast<int>(ways.size());
  Stage stage(64 * count, 64);
  std::vector<glm::vec4> texels;
  for (int i = 0; i < 256 * 256; ++i) texels.emplace_back(0.0f, 1.0f, 0.0f, pattern.alpha(i % 256, i / 256));
  const int texture = stage.texture(256, 256, texels);
  stage.scene.textures[0].wrapS = stage.scene.textures[0].wrapT = Wrap::repeat;
  for (int i = 0; i < count; ++i) {
    const Laid& laid = ways[static_cast<std::size_t>(i)];
    Material material = unlitBlend({1, 1, 1}, 1.0f);
    material.alphaMode = AlphaMode::mask;
    material.alphaCutoff = pattern.cutoff;
    material.baseColorTexture.texture = texture;
    const glm::dvec2 corner = laid.at({0, 0}), right = laid.at({64, 0}) - corner, down = laid.at({0, 64}) - corner;
    material.baseColorTexture.uvTransform =
        glm::mat3(glm::dmat3(glm::dvec3(right / 256.0, 0), glm::dvec3(down / 256.0, 0), glm::dvec3(corner / 256.0, 1)));
    stage.quad(64 * i, 0, 64 * i + 64, 64, 2.0, stage.add(material));
  }
  GlContext context;
  TransparentPass drawn(context, stage.scene, stage.gbuffer, stage.camera);
  std::vector<double> means(ways.size(), 0.0);
  for (int pass = 0; pass < passes; ++pass) {
    PassSettings settings;
    settings.sample = samplePosition(pass, passes);
    settings.footprint = 1.0f / std::sqrt(static_cast<float>(passes));
    std::vector<FragmentLists> tiles;
    drawn.fragments(settings, [&](const FragmentLists& lists) { tiles.push_back(lists); });
    const Seen seen(tiles, stage.gbuffer.data);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64 * count; ++x)
        means[static_cast<std::size_t>(x / 64)] += static_cast<double>(seen.coverage.at(x, y)) / (64.0 * 64.0 * passes);
  }
  return means;
}

// Turned, so that no period of a pattern is one of the pixels.
TEST(CutOuts, KeepTheirMeanCoverageAtAnyDistance) {
  double worst = 0.0;
  for (const Pattern& pattern : patterns()) {
    std::vector<Laid> ways;
    for (const double size : {0.25, 0.5, 1.0, 1.4, 2.0, 2.9, 4.0, 5.6, 8.0, 16.0, 64.0, 256.0})
      ways.push_back({size, 0.47, {3.3, 5.9}});
    const std::vector<double> one = meanCoverages(pattern, ways, 1), many = meanCoverages(pattern, ways, 8);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double wanted = areaLeft(pattern, ways[i]);
      const double off = std::max(std::abs(one[i] - wanted), std::abs(many[i] - wanted));
      // No alpha lies above 1: half of the rim of a cut near it is missing, where rims are about a texel wide.
      const bool high = pattern.cutoff == 0.9f;
      if (!high) worst = std::max(worst, off);
      EXPECT_LE(off, high ? 0.03 : 0.01) << pattern.name << ", " << ways[i].texels << " texels a pixel";
    }
  }
  printf("[ figure ] mean coverage from 1/4 to 256 texels a pixel within %.4f\n", worst);
}

// The period is one of the pixels: every pixel meets the same places of it.
TEST(CutOuts, PatternsThatRepeatWithThePixelsKeepTheirMeanCoverage) {
  double worst = 0.0;
  for (const Pattern& pattern : patterns()) {
    std::vector<Laid> ways;
    for (const double size : {8.0, 16.0, 32.0, 128.0})
      for (const glm::dvec2 first : {glm::dvec2(0.0), glm::dvec2(2.6, 5.3), glm::dvec2(7.9, 0.4)})
        ways.push_back({size, 0.0, first});
    const std::vector<double> one = meanCoverages(pattern, ways, 1), many = meanCoverages(pattern, ways, 8);
    const double wanted = areaLeft<1901>(pattern, {4.0, 0.0, {0.0, 0.0}});  // the whole texture, as in every picture
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double off = std::max(std::abs(one[i] - wanted), std::abs(many[i] - wanted));
      // There discs of 20% are still cut: each of eight passes meets two places of the pattern in all pixels.
      const bool cut = ways[i].texels == 8.0;
      if (!cut) worst = std::max(worst, off);
      EXPECT_LE(off, cut ? 0.03 : 0.01) << pattern.name << ", " << ways[i].texels << " texels a pixel, from "
                                        << ways[i].first.x;
    }
  }
  printf("[ figure ] mean coverage of patterns that repeat with the pixels within %.4f\n", worst);
}

// Beside a pattern finer than the pixels, what is solid stays so, and no pixel in between is missing.
TEST(CutOuts, NoSeamBetweenWhatIsSolidAndWhatIsPartlyCovered) {
  const Pattern pattern{"stripes beside a sheet", [](int x, int) { return x >= 128 || x % 2 == 0 ? 1.0f : 0.0f; },
                        0.5f};
  for (const double size : {4.0, 5.0, 8.0, 11.0})
    for (const int passes : {1, 8}) {
      Stage stage(64, 4);
      std::vector<glm::vec4> texels;
      for (int i = 0; i < 256 * 4; ++i) texels.emplace_back(0.25f, 1.0f, 0.0f, pattern.alpha(i % 256, 0));
      Material material = unlitBlend({1, 1, 1}, 1.0f);
      material.alphaMode = AlphaMode::mask;
      material.baseColorTexture.texture = stage.texture(256, 4, texels);
      stage.scene.textures[0].wrapT = Wrap::repeat;
      material.baseColorTexture.uvTransform[1][1] = static_cast<float>(size);  // as many texels down as across
      const double edge = 256.0 / size;
      stage.quad(0, 0, edge, 4, 2.0, stage.add(material));
      std::vector<double> covered(64, 0.0);
      for (int pass = 0; pass < passes; ++pass) {
        PassSettings settings;
        settings.sample = samplePosition(pass, passes);
        settings.footprint = 1.0f / std::sqrt(static_cast<float>(passes));
        const Seen seen = see(stage, settings);
        for (int x = 0; x < 64; ++x)
          covered[static_cast<std::size_t>(x)] += static_cast<double>(seen.coverage.at(x, 2)) / passes;
      }
      const double border = 128.0 / size;
      for (int x = 0; x < static_cast<int>(edge); ++x) {
        const double here = covered[static_cast<std::size_t>(x)];
        // A pixel's sample takes up to two texels of its own width to either side.
        if (x > border + 2.0) {
          EXPECT_EQ(here, 1.0) << size << " texels a pixel, " << passes << " passes, column " << x;
        } else if (x < border - 3.0 && x > 2) {
          EXPECT_NEAR(here, 0.5, 0.1) << size << " texels a pixel, " << passes << " passes, column " << x;
        } else if (x > 2) {
          EXPECT_GE(here, 0.4) << size << " texels a pixel, " << passes << " passes, column " << x;
        }
      }
    }
}

}  // namespace
}  // namespace pellucid::test
