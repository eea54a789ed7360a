// Fog under lights: against an ordered march of the independent reference, CPU against GL, and among surfaces.
#include <cmath>

#include "composite/fold.h"
#include "composite/over.h"
#include "tests/fog/stage.h"

namespace pellucid::test {
namespace {

// A wall with a slit stands before a sun: light comes through where x + y lies in a band.
double slit(const glm::dvec3& p) {
  const double across = p.x * 0.8 + p.z * 0.6;
  return std::abs(across + 2.0) < 0.6 ? 1.0 : 0.0;
}

struct Shafts {
  FogStage stage{48, 32, 9.0f};
  MediumSettings settings;
  Box box{{-6.0, -4.0, -10.0}, {6.0, 6.0, 0.0}};
  glm::dvec3 toSun = glm::normalize(glm::dvec3(-0.6, 0.0, 0.8));  // along the slit's planes

  Shafts() {
    stage.sun(toSun, 5.0f);
    settings.density = 0.15;
    settings.g = 0.6;
  }
  Fog fog(glm::ivec3 size) const {
    Fog made = stage.fog(settings, glm::vec3(0.05f));
    made.visibility = volumeOf(
        stage.camera, box, size, [](int, glm::dvec3 p) { return glm::vec3(static_cast<float>(slit(p))); }, 1);
    return made;
  }
  reference::Marched truth(int x, int y, int steps) const {
    reference::Air air;
    air.extinction = [&](const reference::Vec&) { return settings.density; };
    air.g = settings.g;
    air.ambient = {0.05, 0.05, 0.05};
    reference::Lamp sun;
    sun.sun = true;
    sun.place = {toSun.x, toSun.y, toSun.z};
    sun.intensity = {5.0, 5.0, 5.0};
    sun.visible = [](const reference::Vec& p) { return slit({p[0], p[1], p[2]}); };
    const glm::dvec3 way = stage.way(x, y);
    return reference::orderedMarch(air, {sun}, {0, 1, 0}, {way.x, way.y, way.z}, 9.0 / -way.z, steps);
  }
};

struct Error {
  double mean = 0, most = 0;
};

Error shaftError(const Shafts& shafts, const Picture& picture) {
  Error error;
  for (int y = 0; y < 32; y += 3)
    for (int x = 0; x < 48; ++x) {
      const reference::Marched truth = shafts.truth(x, y, 4000);
      const glm::vec4 background = shafts.stage.gbuffer.beauty.at(x, y);
      const double wanted = truth.radiance[0] + truth.transmittance * static_cast<double>(background.r);
      const double off = std::abs(static_cast<double>(picture.rgba.at(x, y).r) - wanted);
      error.mean += off / (48.0 * 11.0);
      error.most = std::max(error.most, off);
    }
  return error;
}

// Must show: shafts against an ordered march.
TEST(Fog, ShaftsAgainstAnOrderedMarch) {
  Shafts shafts;
  std::printf(
      "shafts in even fog, sun through a slit of 1.2 m; light volume, steps: mean and largest error (picture about "
      ".5)\n");
  double ordered64 = 0, sums64 = 0;
  for (const int edge : {48, 192})
    for (const int steps : {16, 32, 64, 128, 512})
      for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS}) {
        shafts.settings.steps = steps;
        shafts.settings.order = order;
        const Error error = shaftError(shafts, shafts.stage.picture(shafts.stage.sums(shafts.fog({edge, 8, edge}))));
        std::printf("  %3d texels %3d steps %-7s %.5f %.5f\n", edge, steps,
                    order == shading::PLD_FOG_ORDERED ? "ordered" : "sums", error.mean, error.most);
        if (edge == 192 && steps == 64) (order == shading::PLD_FOG_ORDERED ? ordered64 : sums64) = error.mean;
      }
  EXPECT_LT(ordered64, 0.004);  // of pictures of about .5: what 64 steps leave of the slit's edges
  EXPECT_LT(ordered64, sums64);
}

TEST(Fog, BeyondAHundredAndTwentyEightStepsThePictureStays) {
  FogStage stage(24, 16, 9.0f);
  stage.lamp({0.5, 2.0, -5.0}, 20.0f);
  stage.sun({-0.6, 0.5, 0.8}, 3.0f);
  MediumSettings settings;
  settings.density = 0.2;
  settings.height = 1.5;
  settings.g = 0.5;
  settings.steps = 2048;
  const Image<glm::vec4> fine = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.2f)))).rgba;
  for (const int steps : {16, 32, 64, 128, 256}) {
    settings.steps = steps;
    const Image<glm::vec4> coarse = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.2f)))).rgba;
    double worst = 0;
    for (std::size_t i = 0; i < fine.size(); ++i)
      worst = std::max(worst, std::abs(static_cast<double>(coarse[i].r / fine[i].r) - 1.0));
    std::printf("%4d steps: largest relative difference to 2048: %.5f\n", steps, worst);
    // Some rays pass the lamp within 5 cm; ambient light alone needs one step.
    if (steps >= 128) {
      EXPECT_LT(worst, 0.005);
    }
  }
}

// Three voices: the reference in double.
TEST(Fog, LampInLayeredFogAgainstTheReference) {
  FogStage stage(12, 8, 9.0f);
  stage.lamp({0.5, 2.0, -5.0}, 20.0f);
  MediumSettings settings;
  settings.density = 0.2;
  settings.height = 1.5;
  settings.base = 0.5;
  settings.g = -0.4;
  settings.albedo = {0.9, 0.8, 0.7};
  settings.steps = 512;
  const Picture picture = stage.picture(stage.sums(stage.fog(settings, glm::vec3(0.2f))));
  const auto extinction = [](double y) { return 0.2 * std::exp(-(y - 0.5) / 1.5); };
  double worst = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 12; ++x) {
      reference::Air air;
      air.extinction = [&](const reference::Vec& p) { return extinction(p[1]); };
      air.albedo = {0.9, 0.8, 0.7};
      air.g = -0.4;
      air.ambient = {0.2, 0.2, 0.2};
      reference::Lamp lamp;
      lamp.place = {0.5, 2.0, -5.0};
      lamp.intensity = {20, 20, 20};
      lamp.visible = [&](const reference::Vec& p) {  // the fog between the lamp and the ray, by quadrature
        double depth = 0;
        const double d = std::hypot(p[0] - 0.5, p[1] - 2.0, p[2] + 5.0);
        for (int i = 0; i < 64; ++i) depth += extinction(p[1] + (2.0 - p[1]) * (i + 0.5) / 64) * d / 64;
        return std::exp(-depth);
      };
      const glm::dvec3 way = stage.way(x, y);
      const reference::Marched truth =
          reference::orderedMarch(air, {lamp}, {0, 1, 0}, {way.x, way.y, way.z}, 9.0 / -way.z, 3000);
      for (std::size_t c = 0; c < 3; ++c) {
        const int k = static_cast<int>(c);
        const double wanted = truth.radiance[c] + truth.transmittance * static_cast<double>(stage.gbuffer.beauty[0][k]);
        worst = std::max(worst, std::abs(static_cast<double>(picture.rgba.at(x, y)[k]) - wanted) / wanted);
      }
    }
  std::printf("largest relative error %.2e\n", worst);
  EXPECT_LT(worst, 1e-3);
}

// CPU against GL: the same text. length() and normalize() of lamps are the driver's own; the rest are ours.
TEST(Fog, GlMarchesWhatTheCpuMarches) {
  for (const bool gridded : {false, true})
    for (const int order : {shading::PLD_FOG_ORDERED, shading::PLD_FOG_SUMS})
      for (const bool withPane : {false, true}) {
        Shafts shafts;
        FogStage& stage = shafts.stage;
        stage.lamp({1.0, 1.5, -6.0}, 8.0f);
        if (withPane) stage.quad(4, 4, 30, 30, 5.0, stage.add(unlitBlend({0.2f, 0.4f, 0.9f}, 0.5f)));
        shafts.settings.order = order;
        shafts.settings.height = 2.0;
        if (gridded) {
          auto grid = std::make_shared<DensityGrid>();
          grid->density = Volume<float>({5, 6, 7}, 0.0f);
          for (std::size_t i = 0; i < grid->density.texels.size(); ++i)
            grid->density.texels[i] = static_cast<float>(i % 11) * 0.1f;
          grid->boxFromWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(0.2, 0.25, 0.1));
          grid->boxFromWorld[3] = glm::dvec4(0.5, 0.3, 0.9, 1.0);
          shafts.settings.grid = grid;
        }
        Fog fog = stage.fog(shafts.settings, glm::vec3(0.05f));
        fog.visibility = volumeOf(
            stage.camera, shafts.box, {20, 6, 20},
            [](int light, glm::dvec3 p) { return glm::vec3(light ? 1.0f : static_cast<float>(slit(p))); }, 2);
        const auto [cpu, gl] = stage.both(fog);
        double worst = 0;
        std::size_t words = 0, differ = 0, fogged = 0;
        const auto compare = [&](float a, float b) {
          ++words;
          if (a == b) return;
          ++differ;
          worst = std::max(worst, std::abs(static_cast<double>(a) - static_cast<double>(b)) /
                                      std::max(std::abs(static_cast<double>(b)), 1e-3));
        };
        for (std::size_t i = 0; i < cpu.radiance.size(); ++i) {
          fogged += cpu.weight[i].a > 0.0f;
          for (int c = 0; c < 4; ++c) {
            compare(gl.radiance[i][c], cpu.radiance[i][c]);
            compare(gl.weight[i][c], cpu.weight[i][c]);
            compare(gl.opacity[i][c], cpu.opacity[i][c]);
            compare(gl.depth[i][c], cpu.depth[i][c]);
          }
          compare(gl.frontZ[i], cpu.frontZ[i]);
        }
        std::printf("%s %s%s: %zu of %zu words differ, by %.1e at most\n", gridded ? "grid" : "layered",
                    order ? "sums" : "ordered", withPane ? " with a pane" : "", differ, words, worst);
        EXPECT_GT(fogged, 300u);
        EXPECT_LT(worst, 2e-5);  // 64 steps of normalize() and dot(), which the driver may round its own way
      }
}

// `over`: runs of fog between surfaces are what an ordered march through fog and panes gives.
TEST(Fog, RunsBetweenSurfacesCompositeExactly) {
  Shafts shafts;
  FogStage& stage = shafts.stage;
  shafts.settings.steps = 512;
  const Fog fog = shafts.fog({192, 8, 192});
  const int width = 48, height = 32;
  const float panes[] = {5.0f, 2.5f, 7.0f};  // in no order
  FragmentLists lists;
  lists.window = stage.gbuffer.data;
  lists.offsets = {0};
  lists.solid = Image<glm::vec4>(width, height, glm::vec4(0, 0, 0, kSky));
  for (int i = 0; i < width * height; ++i) {
    for (const float z : panes) {
      Fragment fragment{};
      fragment.radiance = glm::vec3(0.1f * z);
      fragment.coverage = 0.5f;
      fragment.z = z;
      lists.fragments.push_back(fragment);
    }
    lists.offsets.push_back(lists.fragments.size());
  }
  const FragmentLists both = withFog(fog, stage.gbuffer, {0.5, 0.5}, lists);
  Veil veil(width, height);
  compositeSorted(both, stage.gbuffer.data, veil);
  const Picture picture = compose(veil, stage.gbuffer);
  double worst = 0, worstSums = 0;
  // The same by the sums, for what it is worth.
  OitPlanes planes = emptyPlanes(stage.gbuffer.display, stage.gbuffer.data);
  foldFragments(lists, planes.info.weight, planes.info.normalisation, planes);
  addFog(fog, stage.gbuffer, {0.5, 0.5}, planes);
  const Picture weighed = stage.picture(planes);
  for (int y = 0; y < height; y += 5)
    for (int x = 0; x < width; x += 3) {
      const glm::dvec3 way = stage.way(x, y);
      // By difference of whole marches: fog between z0 and z1 is (march(z1) - march(z0)) / T(z0).
      double light = 0, passed = 1, before = 0, fogBefore = 0, fogPassed = 1;
      for (const double z : {2.5, 5.0, 7.0, 9.0}) {
        const double metres = z / -way.z;
        reference::Air air;
        air.extinction = [&](const reference::Vec&) { return shafts.settings.density; };
        air.g = shafts.settings.g;
        air.ambient = {0.05, 0.05, 0.05};
        reference::Lamp sun;
        sun.sun = true;
        sun.place = {shafts.toSun.x, shafts.toSun.y, shafts.toSun.z};
        sun.intensity = {5.0, 5.0, 5.0};
        sun.visible = [](const reference::Vec& p) { return slit({p[0], p[1], p[2]}); };
        const reference::Marched here =
            reference::orderedMarch(air, {sun}, {0, 1, 0}, {way.x, way.y, way.z}, metres, 8000);
        light += passed * (here.radiance[0] - fogBefore) / fogPassed;
        passed *= here.transmittance / fogPassed;
        fogBefore = here.radiance[0];
        fogPassed = here.transmittance;
        if (z < 9.0) {
          light += passed * 0.1 * z;
          passed *= 0.5;
        }
        before = z;
      }
      const double wanted = light + passed * static_cast<double>(stage.gbuffer.beauty[0].r);
      worst = std::max(worst, std::abs(static_cast<double>(picture.rgba.at(x, y).r) - wanted));
      worstSums = std::max(worstSums, std::abs(static_cast<double>(weighed.rgba.at(x, y).r) - wanted));
      EXPECT_GT(before, 0.0);
    }
  std::printf("fog among three panes: `over` %.5f, sums %.5f from the ordered march\n", worst, worstSums);
  EXPECT_LT(worst, 0.01);  // the light volume's texels at the slit's edges, as without panes
  EXPECT_GT(worstSums, worst);
  for (std::size_t i = 0; i + 1 < both.offsets.size(); ++i) EXPECT_LE(both.offsets[i + 1] - both.offsets[i], 7u);
}

// Whatever order the fragments come in, the same runs.
TEST(Fog, RunsDependOnNoOrder) {
  Shafts shafts;
  const Fog fog = shafts.fog({24, 4, 24});
  const auto listsOf = [&](std::vector<float> depths) {
    FragmentLists lists;
    lists.window = shafts.stage.gbuffer.data;
    lists.offsets = {0};
    lists.solid = Image<glm::vec4>(48, 32, glm::vec4(0, 0, 0, kSky));
    for (int i = 0; i < 48 * 32; ++i) {
      for (const float z : depths) {
        Fragment fragment{};
        fragment.radiance = glm::vec3(0.1f);
        fragment.coverage = 0.5f;
        fragment.z = z;
        lists.fragments.push_back(fragment);
      }
      lists.offsets.push_back(lists.fragments.size());
    }
    Veil veil(48, 32);
    compositeSorted(withFog(fog, shafts.stage.gbuffer, {0.5, 0.5}, lists), lists.window, veil);
    return veil;
  };
  const Veil a = listsOf({1.0f, 4.0f, 4.0f, 8.5f}), b = listsOf({8.5f, 4.0f, 1.0f, 4.0f});
  for (std::size_t i = 0; i < a.light.size(); ++i) EXPECT_EQ(a.light[i], b.light[i]);
}

// Within one ray the order is free for the sums of PT17: backwards gives the same to rounding. The ordered form is
// exact instead, which is why it is the default.
TEST(Fog, TheSumsOfARayAreFreeOfOrder) {
  shading::FogSums forward = shading::noFog(), backward = shading::noFog();
  const shading::WeightSettings weight{shading::PLD_WEIGHT_EQ7Z, 0.1f, 100.0f, 3.0f, 1.0f};
  constexpr int kSteps = 64;
  const auto add = [&](shading::FogSums sums, int i) {
    const float z = 0.5f + 0.3f * static_cast<float>(i), light = i > 20 && i < 30 ? 2.0f : 0.1f;
    return shading::addStep(sums, 0.03f, z, glm::vec3(light), weight, 0.85f, shading::PLD_FOG_SUMS);
  };
  for (int i = 0; i < kSteps; ++i) forward = add(forward, i);
  for (int i = kSteps; i-- > 0;) backward = add(backward, i);
  const shading::OitSums a = shading::fogOitSums(forward, shading::PLD_FOG_SUMS),
                         b = shading::fogOitSums(backward, shading::PLD_FOG_SUMS);
  EXPECT_NEAR(a.numerator.r / b.numerator.r, 1.0f, 1e-6f);
  EXPECT_NEAR(a.denominator.r / b.denominator.r, 1.0f, 1e-6f);
  EXPECT_NEAR(a.depth.r / b.depth.r, 1.0f, 1e-6f);
}

}  // namespace
}  // namespace pellucid::test
