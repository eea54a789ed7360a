// Weights on whole shots: no scale shows in powers of depth, auto is as good as the best that a user could name, and a
// weight goes from file to file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kEdge = 20;
constexpr float kScales[] = {1e-3f, 1.0f, 1e3f};

nlohmann::json named(const char* name, nlohmann::json material) {
  material["name"] = name;
  return material;
}

// Cards between 4 and 7 units whose colour darkens with depth, and a few dense ones, before a wall at 9.
class Weights : public ::testing::Test {
 protected:
  Weights()
      : folder(freshFolder(std::string("weights-") + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
  }

  Request shotOf(float scale, std::uint32_t seed = 3) const {
    Random random(seed);
    const std::string name = folder + "/" + std::to_string(seed) + "-" + std::to_string(scale);
    OpaqueShot wall;
    wall.width = wall.height = kEdge;
    wall.depth = 9.0f * scale;
    writeOpaque(name + ".exr", wall);
    std::vector<Quad> quads;
    for (int i = 0; i < 60; ++i) {
      const float z = 4.0f + 3.0f * random.uniformf(), size = 1.0f + 2.0f * random.uniformf();
      const float x = -2.0f + 3.0f * random.uniformf(), y = -2.0f + 3.0f * random.uniformf();
      const float light = 1.0f - 0.3f * (z - 4.0f);
      const bool dense = i % 8 == 0;
      quads.push_back(Quad{
          {scale * x, scale * y, -scale * z},
          {scale * size, 0, 0},
          {0, scale * size, 0},
          named(dense ? "dense" : "smoke", unlit(light, dense ? 0.1f : light, 0.5f * light, dense ? 0.7f : 0.15f))});
    }
    writeGlb(name + ".glb", quads);
    Request request = requestOf(name + ".exr", name + ".glb");
    return request;
  }
  static Result drawn(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request);
  }
  std::string folder;
};

void ask(Request& request, const char* weight, float scale) {
  request.sums.weight = parseWeight(weight, PassSettings().weight);
  const DepthWeight* row = depthWeightOf(request.sums.weight->kind);
  if (row->reference == WeightReference::unit) request.sums.weightReference = static_cast<double>(scale);
  if (row->readsRange) request.sums.weightRange = {0.5 * static_cast<double>(scale), 50.0 * static_cast<double>(scale)};
}

double largestDifference(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 4; ++c)
      largest = std::max(largest, std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c])));
  return largest;
}

TEST_F(Weights, HaveNoScale) {
  struct Way {
    const char* name;
    void (*ask)(Request& request);
  };
  const Way ways[] = {
      {"drawn", [](Request&) {}},
      {"exact", [](Request& r) { r.tier = Tier::exact; }},
      {"lists",
       [](Request& r) {
         r.method = "front+tail";
         r.paint = paintOf(r.method);
       }},
      {"low resolution",
       [](Request& r) {
         r.shot.scene.overrides = {"smoke.lowResolution=true"};
         r.lowResolution.factor = 2;
       }},
  };
  double worst = 0.0;
  for (const Way& way : ways)
    for (const char* weight : {"uniform", "power:2", "power:4", "power:8", "power:16", "power:32", "fig6", "eq7z",
                               "eq8", "eq9z", "fig1", "eq5", "eq10z", "linear"}) {
      Image<glm::vec4> first;
      for (const float scale : kScales) {
        Request request = shotOf(scale);
        way.ask(request);
        ask(request, weight, scale);
        const Image<glm::vec4> picture = drawn(request).picture.rgba;
        if (first.empty()) first = picture;
        const double difference = largestDifference(picture, first);
        worst = std::max(worst, difference);
        // A rounding of depth to the power of 32; at low resolution of where texels lie between depths.
        EXPECT_LE(difference, 1e-5) << way.name << " " << weight << " x " << scale;
      }
    }
  std::printf("[ figure ] weights at 1e-3, 1 and 1e3 of the size: pictures differ by %.2g at most\n", worst);
}

TEST_F(Weights, AutoIsAsGoodAsTheBestListedAtEveryScale) {
  struct Way {
    const char* name;
    void (*ask)(Request& request, float scale);
  };
  const Way ways[] = {
      {"plain", [](Request&, float) {}},
      {"four passes", [](Request& r, float) { r.passes = 4; }},
      {"fog",
       [](Request& r, float scale) {
         r.fog.text = FogText();
         r.fog.text->medium.density = 0.1 / static_cast<double>(scale);
         r.fog.text->medium.farthest = 1000.0 * static_cast<double>(scale);
         r.fog.text->hasDensity = true;
       }},
      {"fog in lists",
       [](Request& r, float scale) {
         r.method = "front+tail";
         r.paint = paintOf(r.method);
         r.fog.text = FogText();
         r.fog.text->medium.density = 0.3 / static_cast<double>(scale);
         r.fog.text->medium.farthest = 1000.0 * static_cast<double>(scale);
         r.fog.text->hasDensity = true;
       }},
      {"low resolution",
       [](Request& r, float) {
         r.shot.scene.overrides = {"smoke.lowResolution=true"};
         r.lowResolution.factor = 2;
       }},
      {"published", [](Request& r, float) { r.tier = Tier::published; }},
      {"exact", [](Request& r, float) { r.tier = Tier::exact; }},
  };
  for (const Way& way : ways) {
    double least = 1e9, most = 0.0;
    for (const float scale : kScales) {
      Request request = shotOf(scale);
      request.measure = true;
      way.ask(request, scale);
      double best = 1e9;
      std::string name;
      for (const char* weight : {"uniform", "eq5", "eq7", "eq7z", "eq10", "eq10z", "power:2", "power:4", "power:8",
                                 "power:16", "power:32", "fig1", "fig6", "fig10:0.01", "linear"}) {
        Request listed = request;
        listed.sums.weight = parseWeight(weight, PassSettings().weight);
        const double error = drawn(listed).error->mean;
        if (error < best) best = error, name = weight;
      }
      request.sums.fitWeight = true;
      const Result fitted = drawn(request);
      least = std::min(least, fitted.error->mean);
      most = std::max(most, fitted.error->mean);
      std::printf("[ figure ] %s x %g: auto %.5f by %s, best listed %.5f by %s\n", way.name, static_cast<double>(scale),
                  fitted.error->mean, weightText(fitted.plan.pass.weight).c_str(), best, name.c_str());
      EXPECT_LE(fitted.error->mean, 1.02 * best + 1e-7) << way.name << " x " << scale;
    }
    // Halves do not hold what a weight in metres makes of every scale.
    if (std::string(way.name) != "published") {
      EXPECT_LE(most, 1.05 * least) << way.name;
    }
  }
}

// Nothing stated is auto, in one step and in two; where one layer lies alone every weight draws the same, and the first
// of the table stays.
TEST_F(Weights, AutoIsTheDefaultOfSums) {
  Request request = shotOf(1.0f);
  const Result usual = drawn(request);
  request.sums.fitWeight = true;
  const Result fitted = drawn(request);
  EXPECT_EQ(weightText(usual.plan.pass.weight), weightText(fitted.plan.pass.weight));
  EXPECT_EQ(largestDifference(usual.picture.rgba, fitted.picture.rgba), 0.0);
  EXPECT_NE(weightText(usual.plan.pass.weight), weightText(PassSettings().weight));
  const std::string one = folder + "/one.glb";
  writeGlb(one, {Quad{{-1.0f, -1.0f, -1.5f}, {2.0f, 0, 0}, {0, 2.0f, 0}, unlit(0.9f, 0.2f, 0.1f, 0.4f)}});
  Request alone = shotOf(1.0f);
  alone.shot.inputs = {one};
  EXPECT_EQ(drawn(alone).plan.pass.weight.kind, shading::PLD_WEIGHT_EQ5);
}

TEST_F(Weights, GoFromFileToFile) {
  Request request = shotOf(1.0f);
  request.sums.fitWeight = true;
  Compositor fits(request);
  const Result fitted = fits.run(request);
  fits.write(folder + "/first.exr", fitted);
  std::vector<PassPlanes> passes;
  fits.accumulate(request, [&](PassPlanes&& made) { passes.push_back(std::move(made)); });
  writePasses(folder + "/planes.exr", passes);
  for (const char* file : {"/first.exr", "/planes.exr"}) {
    request.sums = {};
    request.sums.weightFrom = folder + file;
    const Result again = drawn(request);
    EXPECT_EQ(weightText(again.plan.pass.weight), weightText(fitted.plan.pass.weight)) << file;
    EXPECT_EQ(largestDifference(again.picture.rgba, fitted.picture.rgba), 0.0) << file;
    // Of the next frame too, which has another content.
    Request next = shotOf(1.0f, 4);
    next.sums.weightFrom = folder + file;
    EXPECT_EQ(weightText(drawn(next).plan.pass.weight), weightText(fitted.plan.pass.weight)) << file;
  }
  Request sorted = shotOf(1.0f);
  sorted.method = "over";
  sorted.paint = paintOf("over");
  Compositor sorts(sorted);
  sorts.write(folder + "/sorted.exr", sorts.run(sorted));
  request.sums.weightFrom = folder + "/sorted.exr";
  EXPECT_THROW(drawn(request), MeaningError);
  request.sums.weightFrom = request.shot.opaque;
  EXPECT_THROW(drawn(request), MeaningError);
  request.sums.weightFrom = folder + "/none.exr";
  EXPECT_THROW(drawn(request), InputError);
  request.sums.weightRange = {1.0, 2.0};
  EXPECT_THROW(drawn(request), UsageError);
}

// The planes of two files begin at other depths, so that their powers are over other references.
TEST_F(Weights, PlanesOverOtherReferencesAddUp) {
  const std::string near = folder + "/near.glb", far = folder + "/far.glb", both = folder + "/both.glb";
  const Quad first{{-1.0f, -1.0f, -1.5f}, {2.0f, 0, 0}, {0, 2.0f, 0}, unlit(0.9f, 0.2f, 0.1f, 0.4f)};
  const Quad second{{-3.0f, -3.0f, -4.0f}, {6.0f, 0, 0}, {0, 6.0f, 0}, unlit(0.1f, 0.8f, 0.3f, 0.5f)};
  const Quad third{{-4.0f, -4.0f, -5.0f}, {8.0f, 0, 0}, {0, 8.0f, 0}, unlit(0.2f, 0.1f, 0.9f, 0.6f)};
  writeGlb(near, {first});
  writeGlb(far, {second, third});
  writeGlb(both, {first, second, third});
  Request request = shotOf(1.0f);
  request.sums.weight = parseWeight("power:8", PassSettings().weight);
  const auto accumulate = [&](const std::string& scene, const std::string& to) {
    request.shot.inputs = {scene};
    Compositor compositor(request);
    std::vector<PassPlanes> passes;
    compositor.accumulate(request, [&](PassPlanes&& made) { passes.push_back(std::move(made)); });
    writePasses(to, passes);
    return passes[0].planes.info.weight.reference;
  };
  EXPECT_NE(accumulate(near, folder + "/a.exr"), accumulate(far, folder + "/b.exr"));
  accumulate(both, folder + "/c.exr");
  const auto resolved = [&](const std::vector<std::string>& planes) {
    PlanesRequest resolves;
    resolves.opaque = request.shot.opaque;
    resolves.planes = planes;
    Journal journal;
    return resolvePlanes(resolves, journal).picture.rgba;
  };
  const Image<glm::vec4> whole = resolved({folder + "/c.exr"});
  // A rounding of depth over the reference, to the power of 8.
  EXPECT_LE(largestDifference(resolved({folder + "/a.exr", folder + "/b.exr"}), whole), 2e-6);
  EXPECT_LE(largestDifference(resolved({folder + "/b.exr", folder + "/a.exr"}), whole), 2e-6);
}

}  // namespace
}  // namespace pellucid
