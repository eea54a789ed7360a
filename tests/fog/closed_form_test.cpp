// Fog against closed forms.
#include <cmath>

#include "tests/fog/stage.h"

namespace pellucid::test {
namespace {

double relative(double a, double b) {
  return std::abs(a - b) / std::max(std::abs(b), 1e-30);
}

TEST(Fog, PhaseFunctionIntegratesToOneAndItsMeanCosineIsG) {
  for (const double g : {-0.95, -0.5, 0.0, 0.3, 0.7, 0.95}) {
    constexpr int kSteps = 200000;
    double whole = 0, mean = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = -1.0 + (i + 0.5) * 2.0 / kSteps;
      const double p =
          static_cast<double>(shading::henyeyGreenstein(static_cast<float>(cosine), static_cast<float>(g)));
      whole += p * 2.0 * M_PI * 2.0 / kSteps;
      mean += p * cosine * 2.0 * M_PI * 2.0 / kSteps;
      if (i % 1000 == 0) {
        EXPECT_NEAR(p, reference::phase(cosine, g), 1e-4 * reference::phase(cosine, g));
      }
    }
    std::printf("g %5.2f: integral %.7f, mean cosine %.7f\n", g, whole, mean);
    const double slack = std::abs(g) > 0.9 ? 3e-5 : 2e-6;  // a cosine near 1 is a float, and so is g
    EXPECT_NEAR(whole, 1.0, slack) << g;
    EXPECT_NEAR(mean, g, slack) << g;  // > 0 goes on, as MODEL section 11 wants it said
  }
}

// Must show: .5%, whatever the number of steps. One step is enough: light is even.
TEST(Fog, UniformFogUnderAmbientLightIsTheClosedForm) {
  double worst = 0;
  const glm::vec3 ambient(0.8f, 0.5f, 0.25f);
  for (const double density : {1e-4, 0.01, 0.3, 2.0})
    for (const float wall : {0.5f, 5.0f, 40.0f})
      for (const int steps : {1, 2, 7, 64, 256})
        for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS})
          for (const int weight : {shading::PLD_WEIGHT_EQ5, shading::PLD_WEIGHT_EQ7, shading::PLD_WEIGHT_EQ10Z,
                                   shading::PLD_WEIGHT_POWER}) {
            FogStage stage(4, 3, wall);
            MediumSettings settings;
            settings.density = density;
            settings.albedo = {1.0, 0.9, 0.6};
            settings.steps = steps;
            settings.order = order;
            const Picture picture =
                stage.picture(stage.sums(stage.fog(settings, ambient), {weight, 0.1f, 1000.0f, 3.0f, 1.0f}));
            for (int y = 0; y < 3; ++y)
              for (int x = 0; x < 4; ++x) {
                const double metres = static_cast<double>(wall) / -stage.way(x, y).z,
                             beta = std::exp(-density * metres);
                for (int c = 0; c < 3; ++c) {
                  const double wanted = settings.albedo[c] * static_cast<double>(ambient[c]) * (1 - beta) +
                                        beta * static_cast<double>(stage.gbuffer.beauty[0][c]);
                  worst = std::max(worst, relative(static_cast<double>(picture.rgba.at(x, y)[c]), wanted));
                }
              }
          }
  std::printf("largest relative error %.2e\n", worst);
  EXPECT_LT(worst, 1e-5);  // the sums' own rounding; the promise is .005
}

// Must show: 1e-4.
TEST(Fog, TransmittanceIsTheExponentialOfTheDepth) {
  double worst = 0;
  for (const double density : {1e-6, 0.003, 0.1, 1.0, 9.0})
    for (const double height : {0.0, 0.05, 2.0, 500.0})
      for (const double base : {-3.0, 0.0, 1.2})
        for (const double tilt : {-1.2, -0.3, 0.0, 0.004, 0.9})
          for (const int steps : {1, 16, 200}) {
            FogStage stage(2, 2, 10.0f);
            MediumSettings settings;
            settings.density = density;
            settings.height = height;
            settings.base = base;
            settings.steps = steps;
            const glm::dvec3 way(0.0, std::sin(tilt), -std::cos(tilt));
            const double length = 12.0;
            const FogRay ray = fogThrough(stage.fog(settings), glm::vec3(0.0f), glm::vec3(way),
                                          static_cast<float>(-way.z), static_cast<float>(length * -way.z));
            // Integral of density exp(-(1 + s dy - base)/H).
            double depth = density * length;
            if (height > 0) {
              const double k = way.y / height, here = density * std::exp(-(1.0 - base) / height);
              depth = std::abs(k * length) < 1e-9 ? here * length : here * -std::expm1(-k * length) / k;
            }
            worst = std::max(worst, std::abs(static_cast<double>(ray.transmission) - std::exp(-depth)));
            if (depth > 1e-8 && depth < 50) {
              EXPECT_LT(relative(static_cast<double>(ray.depth), depth), 3e-4)
                  << density << ' ' << height << ' ' << base << ' ' << tilt;
            }
          }
  std::printf("largest error of transmittance %.2e\n", worst);
  EXPECT_LT(worst, 1e-4);
}

TEST(Fog, AnEvenGridIsTheSameAsABox) {
  auto grid = std::make_shared<DensityGrid>();
  grid->density = Volume<float>(glm::ivec3(8), 0.5f);
  grid->most = 0.5f;
  Box box{{-2.0, -1.0, -7.0}, {2.0, 3.0, -3.0}};
  for (int c = 0; c < 3; ++c) {
    grid->boxFromWorld[c][c] = 1.0 / (box.high - box.low)[c];
    grid->boxFromWorld[3][c] = -box.low[c] / (box.high - box.low)[c];
  }
  FogStage stage(24, 16, 6.0f);
  MediumSettings settings;
  settings.density = 1.0;
  settings.grid = grid;
  const Image<glm::vec4> a = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.7f)))).rgba;
  settings.grid.reset();
  settings.density = 0.5;
  settings.box = box;
  const Image<glm::vec4> b = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.7f)))).rgba;
  int fogged = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (b[i] != stage.gbuffer.beauty[i]) ++fogged;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[i][c], b[i][c], 2e-6f);
  }
  EXPECT_GT(fogged, 100);
}

// What no fog lies before keeps its bits.
TEST(Fog, PixelsWithoutFogAreNotTouched) {
  FogStage stage(32, 32, 6.0f);
  MediumSettings settings;
  settings.density = 3.0;
  settings.box = Box{{-0.5, 0.5, -4.0}, {0.5, 1.5, -3.0}};
  const Picture picture = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.7f))));
  int touched = 0;
  for (std::size_t i = 0; i < picture.touched.size(); ++i) {
    touched += picture.touched[i];
    if (!picture.touched[i]) {
      EXPECT_EQ(picture.rgba[i], stage.gbuffer.beauty[i]);
    }
  }
  EXPECT_GT(touched, 50);
  EXPECT_LT(touched, 900);
}

// A surface ends its ray's fog wherever it is; a stated `far` ends it before, and 1000 m do where there is nothing.
TEST(Fog, ReachesSurfacesHoweverFar) {
  constexpr double kDensity = 2e-4;
  for (const float wall : {400.0f, 1400.0f, 20000.0f, std::numeric_limits<float>::infinity()})
    for (const bool stated : {false, true}) {
      FogStage stage(3, 3, wall);
      MediumSettings settings;
      settings.density = kDensity;
      settings.albedo = glm::dvec3(0.0);
      if (stated) settings.farthest = 600.0;
      const Picture picture = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.0f))));
      const double metres = std::isfinite(wall) ? static_cast<double>(wall) : 1000.0;
      const double passed = std::exp(-kDensity * (stated ? std::min(metres, 600.0) : metres));
      const double before = static_cast<double>(stage.gbuffer.beauty.at(1, 1).g);
      EXPECT_NEAR(static_cast<double>(picture.rgba.at(1, 1).g) / before, passed, 2e-5 * passed + 1e-6)
          << wall << stated;
    }
}

// What stands in the lamps' way is looked up as far as the surfaces are, and not to the end of a backdrop.
TEST(Fog, LightIsSampledAsFarAsSurfaces) {
  const auto reach = [](const FogStage& stage, std::optional<double> farthest) {
    MediumSettings settings;
    settings.density = 1e-4;
    settings.farthest = farthest;
    return -fogBounds(settings, stage.camera, stage.gbuffer).low.z;
  };
  for (const float wall : {9e-3f, 9.0f, 1400.0f, 20000.0f}) {
    const FogStage stage(3, 3, wall);
    EXPECT_NEAR(reach(stage, std::nullopt), static_cast<double>(wall), 1e-6 * static_cast<double>(wall));
    EXPECT_NEAR(reach(stage, 600.0), std::min(static_cast<double>(wall), 600.0), 1e-3);
  }
  FogStage backdrop(3, 3, 10.0f);
  for (int x = 0; x < 3; ++x) backdrop.gbuffer.viewZ.at(x, 0) = 1e6f;
  EXPECT_NEAR(reach(backdrop, std::nullopt), 1000.0, 1e-6);
  const FogStage nothing(3, 3, std::numeric_limits<float>::infinity());
  EXPECT_NEAR(reach(nothing, std::nullopt), 1000.0, 1e-6);
}

TEST(Fog, ExtremesStayFinite) {
  for (const double density : {0.0, 1e-12, 1e3, 1e9})
    for (const double height : {0.0, 1e-3, 1e6})
      for (const float wall : {1e-4f, 10.0f, std::numeric_limits<float>::infinity()})
        for (const double base : {-1e4, 0.0, 1e4}) {
          FogStage stage(3, 3, wall);
          stage.sun({0.1, 0.01, 1.0}, 1e6f);
          stage.lamp({0.0, 1.0, -0.5}, 1e6f);
          MediumSettings settings;
          settings.density = density;
          settings.height = height;
          settings.base = base;
          settings.g = 0.98;
          settings.farthest = 1e6;
          settings.steps = 9;
          const Picture picture = stage.picture(stage.sums(stage.fog(settings, glm::vec3(1e6f))));
          for (std::size_t i = 0; i < picture.rgba.size(); ++i)
            for (int c = 0; c < 3; ++c)
              ASSERT_TRUE(std::isfinite(picture.rgba[i][c])) << density << ' ' << height << ' ' << wall << ' ' << base;
        }
}

}  // namespace
}  // namespace pellucid::test
