// Fog that emits: against closed forms, against the independent reference, and CPU against GL.
#include <cmath>

#include "composite/fold.h"
#include "composite/over.h"
#include "engine_bridge/scene/blackbody.h"
#include "engine_bridge/scene/fog_grids.h"
#include "tests/fog/stage.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

double off(double got, double wanted) {
  return std::abs(got - wanted) / std::max(std::abs(wanted), 1.0);
}

// A grid over a box of the world.
std::shared_ptr<DensityGrid> gridOver(const Box& box, glm::ivec3 size, const std::function<float(glm::dvec3)>& value) {
  auto grid = std::make_shared<DensityGrid>();
  grid->density = Volume<float>(size, 0.0f);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        grid->density.at({x, y, z}) =
            value(box.low + (box.high - box.low) * (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(size));
  for (int c = 0; c < 3; ++c) {
    grid->boxFromWorld[c][c] = 1.0 / (box.high - box.low)[c];
    grid->boxFromWorld[3][c] = -box.low[c] / (box.high - box.low)[c];
  }
  return grid;
}

std::shared_ptr<const DensityGrid> joined(const std::vector<RoledGrid>& grids, const GlowSettings& glow = {}) {
  std::vector<std::string> notes;
  return joinedGrids(grids, glow, notes);
}

// The picture of lists without any surface, composited by `over`.
Image<glm::vec4> overPicture(const FogStage& stage, const Fog& fog) {
  FragmentLists lists;
  lists.window = stage.gbuffer.data;
  lists.solid = Image<glm::vec4>(lists.window.width(), lists.window.height(), glm::vec4(0, 0, 0, kSky));
  lists.offsets.assign(lists.solid.size() + 1, 0);
  Veil veil(lists.window.width(), lists.window.height());
  compositeSorted(withFog(fog, stage.gbuffer, {0.5, 0.5}, lists), lists.window, veil);
  return compose(veil, stage.gbuffer).rgba;
}

// What a pixel without anything but such fog shows, for each way of drawing it.
std::vector<Image<glm::vec4>> pictures(const FogStage& stage, const Fog& fog, int weight) {
  return {stage.picture(stage.sums(fog, {weight, 0.1f, 1000.0f, 3.0f, 1.0f})).rgba, overPicture(stage, fog)};
}

constexpr int kWeights[] = {shading::PLD_WEIGHT_EQ5, shading::PLD_WEIGHT_EQ7Z, shading::PLD_WEIGHT_UNIFORM,
                            shading::PLD_WEIGHT_POWER};

// Must show: 1e-6. L = e / sigma (1 - exp(-sigma s)).
TEST(FogEmission, EvenFogThatScattersNothingIsTheClosedForm) {
  double worst = 0;
  for (const double density : {1e-5, 0.01, 0.3, 2.0, 40.0})
    for (const float wall : {0.5f, 5.0f, 40.0f})
      for (const int steps : {1, 7, 64})
        for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS})
          for (const int weight : kWeights) {
            FogStage stage(4, 3, wall);
            MediumSettings settings;
            settings.density = density;
            settings.albedo = glm::dvec3(0.0);
            settings.emission = {0.7, 0.2, 0.05};
            settings.steps = steps;
            settings.order = order;
            for (const Image<glm::vec4>& picture : pictures(stage, stage.fog(settings, glm::vec3(0.8f)), weight))
              for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 4; ++x) {
                  const double depth = density * static_cast<double>(wall) / -stage.way(x, y).z;
                  for (int c = 0; c < 3; ++c) {
                    const double background = static_cast<double>(stage.gbuffer.beauty[0][c]);
                    const double wanted =
                        settings.emission[c] / density * -std::expm1(-depth) + std::exp(-depth) * background;
                    worst = std::max(worst, off(static_cast<double>(picture.at(x, y)[c]), wanted));
                  }
                }
          }
  std::printf("[ figure ] even fog: worst %.2g of the larger of 1 and the picture\n", worst);
  EXPECT_LT(worst, 1e-6);
}

// A grid's emission in grids of density, some of them with none: e s, or e / sigma (1 - exp(-sigma s)).
TEST(FogEmission, EvenGridsAreTheClosedForm) {
  double worst = 0;
  const Box box{{-20.0, -20.0, -7.0}, {20.0, 22.0, -3.0}};
  for (const double density : {0.0, 1e-7, 1e-4, 0.05, 0.8, 6.0})
    for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS})
      for (const int weight : kWeights) {
        FogStage stage(4, 3, 5.5f);
        MediumSettings settings;
        settings.density = 1.0;
        settings.albedo = glm::dvec3(0.0);
        settings.order = order;
        GlowSettings glow;
        glow.emission = {3.0, 1.0, 0.25};
        settings.grid = joined({{gridOver(box, {4, 4, 4}, [&](glm::dvec3) { return static_cast<float>(density); })},
                                {gridOver(box, {4, 4, 4}, [](glm::dvec3) { return 0.5f; }), GridRole::emission}},
                               glow);
        for (const Image<glm::vec4>& picture : pictures(stage, stage.fog(settings), weight))
          for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x) {
              const double metres = 2.5 / -stage.way(x, y).z, depth = density * metres;
              const double light = density > 0 ? -std::expm1(-depth) / density : metres;
              for (int c = 0; c < 3; ++c) {
                const double background = static_cast<double>(stage.gbuffer.beauty[0][c]);
                const double wanted = 0.5 * glow.emission[c] * light + std::exp(-depth) * background;
                worst = std::max(worst, off(static_cast<double>(picture.at(x, y)[c]), wanted));
              }
            }
      }
  std::printf("[ figure ] even grids: worst %.2g of the larger of 1 and the picture\n", worst);
  EXPECT_LT(worst, 2e-6);  // 64 steps of one length each round once more than a closed form
}

struct Flames {
  static constexpr int kEdge = 48;
  FogStage stage{24, 16, 9.0f};
  Box box{{-3.0, -2.0, -8.0}, {3.0, 4.0, -2.0}};
  MediumSettings settings;
  GlowSettings glow;

  // Between voxels, 0 outside of the box: for the reference.
  template <class Texel>
  double between(const reference::Vec& p, const Texel& texel) const {
    double at[3];
    int low[3];
    for (int c = 0; c < 3; ++c) {
      const double share = (p[static_cast<std::size_t>(c)] - box.low[c]) / (box.high - box.low)[c];
      if (share < 0.0 || share > 1.0) return 0.0;
      at[c] = share * kEdge - 0.5;
      low[c] = static_cast<int>(std::floor(at[c]));
    }
    const auto held = [](int i) { return std::clamp(i, 0, kEdge - 1); };
    double sum = 0.0;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
          sum += (1.0 - std::abs(at[0] - low[0] - x)) * (1.0 - std::abs(at[1] - low[1] - y)) *
                 (1.0 - std::abs(at[2] - low[2] - z)) * texel({held(low[0] + x), held(low[1] + y), held(low[2] + z)});
    return sum;
  }
  static double density(const glm::dvec3& p) { return 0.2 + 0.15 * std::sin(1.3 * p.x) * std::cos(0.9 * p.z); }
  static double flame(const glm::dvec3& p) {
    return std::exp(-0.4 * (p.x * p.x + (p.y - 1.0) * (p.y - 1.0)) - 0.3 * (p.z + 5.0) * (p.z + 5.0));
  }
  Flames() {
    stage.lamp({1.0, 2.5, -5.0}, 6.0f);
    settings.density = 1.5;
    settings.g = 0.4;
    settings.albedo = {0.9, 0.7, 0.5};
    settings.steps = 512;
    glow.emission = {4.0, 1.5, 0.3};
    const auto grid = [&](double (*value)(const glm::dvec3&)) {
      return gridOver(box, glm::ivec3(kEdge), [value](glm::dvec3 p) { return static_cast<float>(value(p)); });
    };
    settings.grid = joined({{grid(density)}, {grid(flame), GridRole::emission}}, glow);
  }
};

// Three voices: the reference in double, with an interpolation of its own.
TEST(FogEmission, FlamesInSmokeAgainstTheReference) {
  Flames flames;
  const FogStage& stage = flames.stage;
  const Image<glm::vec4> sums = stage.picture(stage.sums(stage.fog(flames.settings, glm::vec3(0.1f)))).rgba;
  const Image<glm::vec4> over = overPicture(stage, stage.fog(flames.settings, glm::vec3(0.1f)));
  double worst = 0, brightest = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 24; ++x) {
      const glm::dvec3 way = stage.way(x, y);
      reference::Air air;
      const auto& grid = *flames.settings.grid;
      const auto density = [&](glm::ivec3 at) { return static_cast<double>(grid.density.at(at)); };
      const auto flame = [&](glm::ivec3 at) { return static_cast<double>(grid.emission.at(at).r); };
      air.extinction = [&](const reference::Vec& p) { return 1.5 * flames.between(p, density); };
      air.emission = [&](const reference::Vec& p) {
        const double e = flames.between(p, flame) / 4.0;
        return reference::Vec{4.0 * e, 1.5 * e, 0.3 * e};
      };
      air.albedo = {0.9, 0.7, 0.5};
      air.g = 0.4;
      air.ambient = {0.1, 0.1, 0.1};
      reference::Lamp lamp;
      lamp.place = {1.0, 2.5, -5.0};
      lamp.intensity = {6, 6, 6};
      const reference::Marched truth =
          reference::orderedMarch(air, {lamp}, {0, 1, 0}, {way.x, way.y, way.z}, 9.0 / -way.z, 12000);
      for (std::size_t c = 0; c < 3; ++c) {
        const int k = static_cast<int>(c);
        const double wanted = truth.radiance[c] + truth.transmittance * static_cast<double>(stage.gbuffer.beauty[0][k]);
        brightest = std::max(brightest, wanted);
        worst = std::max({worst, off(static_cast<double>(sums.at(x, y)[k]), wanted),
                          off(static_cast<double>(over.at(x, y)[k]), wanted)});
      }
    }
  std::printf("[ figure ] flames in smoke, up to %.2f bright: %.2g off the reference\n", brightest, worst);
  EXPECT_GT(brightest, 3.0);
  EXPECT_LT(worst, 2e-4);  // of 512 steps, some of them beside a lamp
}

// CPU against GL: the same text; a lamp's length() and normalize() are the driver's own.
TEST(FogEmission, GlMarchesWhatTheCpuMarches) {
  for (const bool dense : {true, false})
    for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS})
      for (const bool withPane : {false, true}) {
        Flames flames;
        FogStage& stage = flames.stage;
        if (withPane) stage.quad(4, 4, 20, 12, 5.0, stage.add(unlitBlend({0.2f, 0.4f, 0.9f}, 0.5f)));
        flames.settings.order = order;
        flames.settings.steps = 64;
        if (!dense) {
          auto clear = std::make_shared<DensityGrid>(*flames.settings.grid);
          clear->density = Volume<float>(clear->density.size, 0.0f);
          flames.settings.grid = clear;
        }
        const Fog fog = stage.fog(flames.settings, glm::vec3(0.05f));
        const auto [cpu, gl] = stage.both(fog);
        double worst = 0;
        std::size_t lit = 0;
        const auto compare = [&](const glm::vec4& a, const glm::vec4& b) {
          for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(static_cast<double>(a[c]) - static_cast<double>(b[c])) /
                                        std::max(std::abs(static_cast<double>(b[c])), 1e-3));
        };
        for (std::size_t i = 0; i < cpu.radiance.size(); ++i) {
          lit += cpu.light[i].r > 0.0f;
          compare(gl.radiance[i], cpu.radiance[i]);
          compare(gl.weight[i], cpu.weight[i]);
          compare(gl.opacity[i], cpu.opacity[i]);
          compare(gl.depth[i], cpu.depth[i]);
          compare(gl.light[i], cpu.light[i]);
          compare(glm::vec4(gl.frontZ[i]), glm::vec4(cpu.frontZ[i]));
        }
        std::printf("[ figure ] %s, %s%s: GL off the CPU by %.1e at most\n", dense ? "flames in smoke" : "flames",
                    order ? "sums" : "ordered", withPane ? " with a pane" : "", worst);
        EXPECT_GT(lit, 200u);
        EXPECT_LT(worst, 2e-5);
      }
}

// An occluder before emitting fog dims it; behind it, it does not. The sums never show more than all of it, nor less
// than its background leaves.
TEST(FogEmission, PanesBeforeAndBehindIt) {
  FogStage stage(2, 2, 9.0f);
  const Box box{{-20.0, -20.0, -6.0}, {20.0, 22.0, -4.0}};
  GlowSettings glow;
  glow.emission = glm::dvec3(2.0);
  for (const double density : {0.0, 0.2, 2.0})
    for (const float z : {2.0f, 8.0f}) {
      MediumSettings settings;
      settings.density = 1.0;
      settings.albedo = glm::dvec3(0.0);
      settings.grid = joined({{gridOver(box, {4, 4, 4}, [&](glm::dvec3) { return static_cast<float>(density); })},
                              {gridOver(box, {4, 4, 4}, [](glm::dvec3) { return 1.0f; }), GridRole::emission}},
                             glow);
      const Fog fog = stage.fog(settings);
      FragmentLists lists;
      lists.window = stage.gbuffer.data;
      lists.solid = Image<glm::vec4>(2, 2, glm::vec4(0, 0, 0, kSky));
      lists.offsets = {0};
      for (int i = 0; i < 4; ++i) {
        Fragment pane{};
        pane.coverage = 0.75f;  // black
        pane.z = z;
        lists.fragments.push_back(pane);
        lists.offsets.push_back(lists.fragments.size());
      }
      const double metres = 2.0 / -stage.way(0, 0).z;
      const double light = 2.0 * (density > 0 ? -std::expm1(-density * metres) / density : metres);
      const double beta = std::exp(-density * metres), wall = static_cast<double>(stage.gbuffer.beauty[0].r);
      const double wanted = (z < 4.0f ? 0.25 * light : light) + 0.25 * beta * wall;
      Veil veil(2, 2);
      compositeSorted(withFog(fog, stage.gbuffer, {0.5, 0.5}, lists), lists.window, veil);
      EXPECT_NEAR(static_cast<double>(compose(veil, stage.gbuffer).rgba.at(0, 0).r), wanted, 2e-6);
      for (const int weight : kWeights) {
        OitPlanes planes = emptyPlanes(stage.gbuffer.display, stage.gbuffer.data);
        planes.info.weight = {weight, 0.1f, 1000.0f, 3.0f, 1.0f};
        foldFragments(lists, planes.info.weight, planes.info.normalisation, planes);
        addFog(fog, stage.gbuffer, {0.5, 0.5}, planes);
        const double got = static_cast<double>(stage.picture(planes).rgba.at(0, 0).r) - 0.25 * beta * wall;
        EXPECT_GE(got, 0.25 * beta * light * 0.9999) << density << ' ' << z << ' ' << weight;
        EXPECT_LE(got, light * (density > 0.0 ? 2.0 : 1.0) * 1.0001) << density << ' ' << z << ' ' << weight;
      }
    }
}

// Grids that share their voxels join to the bit; a coarse one in a fine one keeps what it holds along a ray.
TEST(FogGrids, DensitiesAddUp) {
  Random random(3);
  const auto noise = [&](glm::dvec3) { return random.uniformf(); };
  const Box left{{-2, 0, -4}, {0, 2, -2}}, right{{-1, 1, -3}, {3, 3, -1}};
  const auto a = gridOver(left, {8, 8, 8}, noise), b = gridOver(right, {16, 8, 8}, noise);
  const auto sum = joined({{a}, {b}});
  EXPECT_EQ(sum->density.size, glm::ivec3(20, 12, 12));
  double worst = 0;
  for (int z = 0; z < 12; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 20; ++x) {
        float wanted = 0.0f;
        if (x < 8 && y < 8 && z < 8) wanted += a->density.at({x, y, z});
        if (x >= 4 && y >= 4 && z >= 4) wanted += b->density.at({x - 4, y - 4, z - 4});
        worst = std::max(worst, std::abs(static_cast<double>(sum->density.at({x, y, z}) - wanted)));
      }
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(joined({{a}}), a);
  const auto coarse = gridOver({{-3, -1, -5}, {1, 3, -1}}, {2, 2, 2}, [](glm::dvec3) { return 0.5f; });
  const auto both = joined({{coarse}, {a}});
  EXPECT_EQ(both->density.size, glm::ivec3(16, 16, 16));  // a voxel of the finer is a quarter of a metre
  EXPECT_NEAR(both->density.at({0, 0, 0}), 0.5f, 1e-6);
  EXPECT_NEAR(both->density.at({5, 5, 5}), 0.5f + a->density.at({1, 1, 1}), 1e-6);
}

TEST(FogGrids, TooManyVoxelsAreRefused) {
  const auto one = [](glm::dvec3) { return 1.0f; };
  const auto fine = gridOver({{0, 0, 0}, {0.01, 0.01, 0.01}}, {2, 2, 2}, one);
  const auto far = gridOver({{1000, 0, 0}, {2000, 1000, 1000}}, {2, 2, 2}, one);
  EXPECT_THROW(joined({{fine}, {far}}), std::exception);
}

// Points of the Planckian locus, as colorimetry's tables have them, and what the candela was: platinum that freezes, at
// 2041.4 K, has 600000 cd / m^2.
TEST(Blackbody, IsThePlanckianLocus) {
  const glm::dmat3 xyzFromRec709(0.4124564, 0.2126729, 0.0193339, 0.3575761, 0.7151522, 0.1191920, 0.1804375, 0.0721750,
                                 0.9503041);
  const std::pair<double, glm::dvec2> points[] = {{1500, {0.5857, 0.3931}}, {2000, {0.5267, 0.4133}},
                                                  {2856, {0.4476, 0.4074}}, {5000, {0.3451, 0.3516}},
                                                  {6500, {0.3135, 0.3236}}, {10000, {0.2806, 0.2883}}};
  for (const auto& [kelvin, chromaticity] : points) {
    const glm::dvec3 xyz = xyzFromRec709 * blackbodyRadiance(kelvin);
    const double sum = xyz.x + xyz.y + xyz.z;
    std::printf("[ figure ] %.0f K: x %.4f, y %.4f, of the tables %.4f, %.4f\n", kelvin, xyz.x / sum, xyz.y / sum,
                chromaticity.x, chromaticity.y);
    EXPECT_NEAR(xyz.x / sum, chromaticity.x, 0.006);  // what the observer's fit by lobes keeps
    EXPECT_NEAR(xyz.y / sum, chromaticity.y, 0.006);
  }
  const double platinum = 683.0 * (xyzFromRec709 * blackbodyRadiance(2041.4)).y;
  std::printf("[ figure ] freezing platinum: %.0f cd/m^2\n", platinum);
  EXPECT_NEAR(platinum / 6e5, 1.0, 0.02);
  EXPECT_EQ(blackbodyRadiance(0.0), glm::dvec3(0.0));
  for (double kelvin = 1.0; kelvin <= kHottest; kelvin *= 1.5) {
    const glm::dvec3 light = blackbodyRadiance(kelvin);
    EXPECT_TRUE(std::isfinite(light.r + light.g + light.b)) << kelvin;
    EXPECT_GE((xyzFromRec709 * light).y, 0.0) << kelvin;
  }
}

// Temperature glows as K times the black body of each voxel.
TEST(Blackbody, TemperatureGridsEmitIt) {
  FogStage stage(2, 2, 5.5f);
  const Box box{{-20.0, -20.0, -7.0}, {20.0, 22.0, -3.0}};
  GlowSettings glow;
  glow.absorption = 0.01;
  glow.kelvin = 1000.0;
  MediumSettings settings;
  settings.density = 1.0;
  settings.grid = joined({{gridOver(box, {4, 4, 4}, [](glm::dvec3) { return 1.9f; }), GridRole::temperature}}, glow);
  const glm::dvec3 wanted = glm::max(blackbodyRadiance(static_cast<double>(1.9f) * 1000.0), 0.0) * 0.01;
  const Image<glm::vec4> got = stage.picture(stage.sums(stage.fog(settings))).rgba;
  for (int c = 0; c < 3; ++c) {
    const double light = wanted[c] * 2.5 / -stage.way(0, 0).z + static_cast<double>(stage.gbuffer.beauty[0][c]);
    EXPECT_NEAR(static_cast<double>(got.at(0, 0)[c]) / light, 1.0, 2e-6);
  }
}

TEST(FogEmission, ExtremesStayFinite) {
  for (const double density : {1e-12, 1.0, 1e9})
    for (const double emission : {1e-30, 1.0, 1e9})
      for (const float wall : {1e-4f, 10.0f, kSky})
        for (const int weight : kWeights) {
          FogStage stage(3, 3, wall);
          MediumSettings settings;
          settings.density = density;
          settings.emission = glm::dvec3(emission);
          settings.steps = 9;
          for (const Image<glm::vec4>& picture : pictures(stage, stage.fog(settings), weight))
            for (std::size_t i = 0; i < picture.size(); ++i)
              ASSERT_TRUE(std::isfinite(picture[i].r)) << density << ' ' << emission << ' ' << wall << ' ' << weight;
        }
}

}  // namespace
}  // namespace pellucid::test
