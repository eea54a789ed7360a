// MODEL section 12, the rows of the lookup: spreads up to the picture's diagonal, every index of refraction, offsets
// beyond the picture, and 100,000 layers of them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scatter/backdrop.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

TEST(LookupExtremes, SpreadFromNothingToTheDiagonalAndBeyond) {
  const float diagonal = std::hypot(24.0f, 16.0f);
  for (const bool exact : {true, false})
    for (const float spread : {0.0f, 1e-6f, 0.3f, 1.0f, 0.5f * diagonal, diagonal, shading::PLD_LARGEST_SPREAD, 3e8f}) {
      ScatterScene scene(24, 16, glm::vec4(0.3f, 1e6f, 1e-30f, 1.0f));
      scene.diffuseAll(spread);
      scene.diffuse(5, 5, 0.0f);
      const Image<glm::vec4> seen = scene.look(exact);
      for (std::size_t i = 0; i < seen.size(); ++i) {
        ASSERT_NEAR(seen[i].r, 0.3f, 3e-7f) << spread;
        ASSERT_NEAR(seen[i].g, 1e6f, 1.0f) << spread;
        ASSERT_TRUE(std::isfinite(seen[i].b) && seen[i].b >= 0.0f) << spread;
      }
    }
}

TEST(LookupExtremes, EveryIndexAngleAndDistanceOfRefraction) {
  Random random(73);
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    shading::RefractionSettings settings;
    settings.mode = static_cast<int>(random.below(4));
    settings.distance = static_cast<float>(std::pow(10.0, random.between(-6, 9)));
    settings.focalX = settings.focalY = 1000.0f;
    settings.orthographic = static_cast<int>(random.below(2));
    const auto z = static_cast<float>(std::pow(10.0, random.between(-6, 9)));
    const float eta = i % 2 ? 1.0f / 2.4f : 2.4f;
    const double angle = random.below(4) ? random.between(0, 1.5707963) : 1.5707963;  // grazing among them
    const glm::vec3 toEye(0, 0, 1);
    const glm::vec3 normal(static_cast<float>(std::sin(angle)), 0.0f, static_cast<float>(std::cos(angle)));
    const float behind = random.below(3) ? z * (1.0f + random.uniformf()) : random.below(2) ? z : INFINITY;
    const glm::vec2 offset = shading::refractionOffset(settings, glm::vec3(0, 0, -z), toEye, normal, eta, behind, 0.1f);
    ASSERT_TRUE(std::isfinite(offset.x) && std::isfinite(offset.y)) << i;
    largest = std::max(largest, static_cast<double>(std::abs(offset.x)));
    // Looked up from a picture of 16 pixels: the edge is read, or the pixel itself.
    ScatterScene scene(16, 1, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    scene.refract(3, 0, shading::recordedOffset(offset));
    ASSERT_NEAR(scene.look(true).at(3, 0).r, 0.5f, 1e-6f);
  }
  std::printf("4,000 refractions at eta 2.4 and 1/2.4, 1e-6 to 1e9 m: finite, largest offset %.0f px\n", largest);
}

TEST(LookupExtremes, AHundredThousandLayersOfTheLargestOffsetAndSpread) {
  shading::Layer layer;
  layer.radiance = glm::vec3(0);
  layer.coverage = 1.0f;
  layer.transmission = glm::vec3(0.5f);
  layer.z = 1e9f;
  shading::Scatter scatter;
  scatter.offset = glm::vec2(shading::PLD_LARGEST_OFFSET, -shading::PLD_LARGEST_OFFSET);
  scatter.variance = shading::PLD_LARGEST_SPREAD * shading::PLD_LARGEST_SPREAD;
  const shading::ScatterTargets one = shading::packScatter(layer, scatter);
  glm::vec4 sum(0.0f);
  float z = 0.0f;
  for (int i = 0; i < 100000; ++i) sum += one.refraction, z += one.refractionZ;
  const shading::Path path = shading::pathOf(sum, z, 1e9f);
  EXPECT_NEAR(path.offset.x / shading::PLD_LARGEST_OFFSET, 1.0f, 0.01f);
  EXPECT_TRUE(std::isfinite(path.variance) && std::isfinite(path.refractionZ));
}

}  // namespace
}  // namespace pellucid::test
