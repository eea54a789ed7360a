// Stochastic transparency on GL: ST10's examples, agreement with the CPU pixel by pixel, the same bits in any order.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "tests/stochastic/examples.h"
#include "tests/stochastic/sampled_stage.h"

namespace pellucid {
namespace {

using namespace test;

// The noise belongs to the pixel too: one frame of 200 x 200 pixels is 40,000 draws.
TEST(StochasticGl, ExamplesMatchEnumerationWithinThreeStandardErrors) {
  constexpr int kEdge = 200;
  std::printf("S = %d, %d pixels\n%-20s %-20s %-20s %s\n", kSamples, kEdge * kEdge, "example", "enumerated", "on GL",
              "paper");
  for (const Row& row : kRows) {
    const auto layers = exampleLayers(row.example);
    const reference::Rgb behind = behindExample(row.example);
    const StochasticSettings settings = settingsOf(row.estimator, row.stratified);
    Stage stage(kEdge, kEdge);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const glm::vec3 colour(layers[i].colour[0], layers[i].colour[1], layers[i].colour[2]);
      stage.quad(0, 0, kEdge, kEdge, 1.0 + static_cast<double>(i),
                 stage.add(unlitBlend(colour, static_cast<float>(layers[i].alpha))));
    }
    const StochasticPlanes planes = sampleStage(stage, passOf(settings));
    const Moments exact = reference::enumerate(layers, behind, kSamples, row.stratified, row.estimator);
    glm::dvec3 mean(0), second(0), fourth(0);
    constexpr double kPixels = kEdge * kEdge;
    std::vector<glm::dvec3> values;
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        values.push_back(pictureOf(sumsAt(planes, x, y), {behind[0], behind[1], behind[2]}, settings));
        mean += values.back() / kPixels;
      }
    for (const glm::dvec3& value : values) {
      const glm::dvec3 squared = (value - mean) * (value - mean);
      second += squared / kPixels;
      fourth += squared * squared / kPixels;
    }
    std::printf("%-20s (%.3f, %.3f, %.3f) (%.3f, %.3f, %.3f) %s %s\n", row.label, exact.deviation[0],
                exact.deviation[1], exact.deviation[2], std::sqrt(second.r), std::sqrt(second.g), std::sqrt(second.b),
                row.paper, row.reason);
    for (std::size_t c = 0; c < 3; ++c) {
      const double variance = exact.deviation[c] * exact.deviation[c];
      const auto i = static_cast<int>(c);
      // 2e-5: optical depths of a layer are rounded to 1/65536.
      EXPECT_NEAR(mean[i], exact.mean[c], 3 * exact.deviation[c] / std::sqrt(kPixels) + 2e-5) << row.label << c;
      const double error = std::sqrt(std::max(0.0, fourth[i] - variance * variance) / kPixels);
      EXPECT_NEAR(second[i], variance, 3 * error + 2e-5) << row.label << c;
    }
  }
}

TEST(StochasticGl, AgreesWithTheCpuOnEveryPixel) {
  Stage stage = mixture();
  const std::vector<FragmentLists> tiles = stage.fragments();
  for (const Variant variant : {Variant::basic, Variant::alpha, Variant::depth})
    for (const int samples : {4, 24}) {
      for (const bool stratified : {true, false}) {
        StochasticSettings settings;
        settings.variant = variant;
        settings.samples = samples;
        settings.stratified = stratified;
        settings.seed = 3;
        const StochasticPlanes planes = sampleStage(stage, passOf(settings));
        const MaskTable masks(samples);
        double worst = 0;
        int compared = 0;
        for (const FragmentLists& lists : tiles)
          for (int y = 0; y < lists.window.height(); ++y)
            for (int x = 0; x < lists.window.width(); ++x) {
              std::vector<MethodLayer> layers;
              const int u = lists.window.x0 + x, v = lists.window.y0 + y;
              layersOf(lists, static_cast<std::size_t>(y * lists.window.width() + x), lists.solid.at(x, y).a, layers);
              EXPECT_EQ(lists.solid.at(x, y), planes.solid.at(u, v));
              const StochasticSums cpu = samplePixel(layers, {u, v}, settings, masks, {});
              const StochasticSums gl = sumsAt(planes, u, v);
              EXPECT_EQ(glm::vec3(cpu.empty), glm::vec3(gl.empty)) << u << "," << v;
              for (const auto& [a, b] :
                   {std::pair(cpu.light, gl.light), {cpu.unit, gl.unit}, {cpu.added, gl.added}, {cpu.beta, gl.beta}})
                for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]) / std::max(1.0, a[c]));
              ++compared;
            }
        EXPECT_EQ(compared, 48 * 40);
        std::printf("variant %d, S = %2d, %s: sums apart by at most %.2g\n", static_cast<int>(variant), samples,
                    stratified ? "stratified" : "naive", worst);
        EXPECT_LT(worst, 3e-5);  // steps of the sums and of the optical depth
      }
    }
}

TEST(StochasticGl, SameBitsWhateverTheOrderAndChunksAndOthersBySeed) {
  Stage stage = mixture();
  for (const Variant variant : {Variant::basic, Variant::depth}) {
    StochasticSettings settings;
    settings.variant = variant;
    settings.samples = 16;
    const StochasticPlanes one = sampleStage(stage, passOf(settings));
    PassSettings shuffled;
    shuffled.order = {SubmissionOrder::shuffle, 5};
    shuffled.chunkBytes = 2048;
    const StochasticPlanes two = sampleStage(stage, passOf(settings), shuffled);
    for (const auto plane : {&StochasticPlanes::light, &StochasticPlanes::unit, &StochasticPlanes::added,
                             &StochasticPlanes::empty, &StochasticPlanes::beta})
      EXPECT_EQ(0, std::memcmp((one.*plane).data(), (two.*plane).data(), (one.*plane).size() * sizeof(glm::vec3)));
    settings.seed = 1;
    const StochasticPlanes three = sampleStage(stage, passOf(settings));
    EXPECT_NE(0, std::memcmp(one.empty.data(), three.empty.data(), one.empty.size() * sizeof(glm::vec3)));
  }
}

TEST(StochasticGl, PassesShareOneSetOfMasksUpTo1024Samples) {
  Stage stage = mixture();
  StochasticPassSettings whole;
  whole.samples = 1024;
  const StochasticPlanes all = sampleStage(stage, whole);
  GlContext context;
  StochasticPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  Image<glm::vec3> empty(48, 40, glm::vec3(0.0f));
  for (int i = 0; i < 4; ++i) {
    StochasticPassSettings part = whole;
    part.first = i;
    part.step = 4;
    const StochasticPlanes planes = pass.sample({}, part);
    for (std::size_t k = 0; k < empty.size(); ++k) empty[k] += planes.empty[k] / 4.0f;
  }
  for (std::size_t k = 0; k < empty.size(); ++k)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(empty[k][c], all.empty[k][c], 1e-6) << k;
}

}  // namespace
}  // namespace pellucid
