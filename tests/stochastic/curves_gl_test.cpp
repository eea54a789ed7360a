// ST10 fig. 3 on the device: the spread of estimated visibility about the true curve.
#include <gtest/gtest.h>

#include <cmath>

#include "engine_bridge/gl/stochastic_pass.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;

// The background seen behind the first k blockers is the visibility there; the noise belongs to the pixel, so that one
// frame holds many draws.
TEST(StochasticGl, VisibilityCurvesTighten) {
  constexpr int kEdge = 32, kBlockers = 12;
  Random random(3);
  std::vector<float> alphas;
  for (int i = 0; i < kBlockers; ++i) alphas.push_back(.3f * random.uniformf());
  GlContext context;
  double before = 1;
  for (const int samples : {8, 32, 256, 1024}) {
    double widest = 0, shift = 0;
    for (int k = 1; k <= kBlockers; k += samples > 100 ? 11 : 1) {
      Stage stage(kEdge, kEdge);
      double truth = 1;
      for (int i = 0; i < k; ++i) {
        const float alpha = alphas[static_cast<std::size_t>(i)];
        stage.quad(0, 0, kEdge, kEdge, 1.0 + i, stage.add(unlitBlend(glm::vec3(0.0f), alpha)));
        truth *= 1 - static_cast<double>(alpha);
      }
      StochasticPassSettings settings;
      settings.samples = samples;
      settings.winnersOnly = true;
      StochasticPass pass(context, stage.scene, stage.gbuffer, stage.camera);
      const StochasticPlanes planes = pass.sample({}, settings);
      double squares = 0, sum = 0;
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
          const double apart = static_cast<double>(planes.empty.at(x, y).g) - truth;
          sum += apart / (kEdge * kEdge);
          squares += apart * apart / (kEdge * kEdge);
        }
      widest = std::max(widest, std::sqrt(squares));
      shift = std::max(shift, std::abs(sum) / std::sqrt(squares / (kEdge * kEdge)));
    }
    std::printf("S %4d: visibility deviates by at most %.4f along the curve; its mean by %.1f standard errors\n",
                samples, widest, shift);
    EXPECT_LT(widest, before);
    EXPECT_LT(widest, .5 / std::sqrt(samples));  // a coin per sample deviates by sqrt(v (1 - v) / S), at most this
    EXPECT_LT(shift, 4.0);                       // of 26 curves' points
    before = widest;
  }
}

}  // namespace
}  // namespace pellucid
