// Sums resolved eight pixels at a time against the shared text, pixel by pixel: the same bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "composite/denormals.h"
#include "composite/resolve.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

glm::vec3 randomColour(Random& random, float most) {
  return {most * random.uniformf(), most * random.uniformf(), most * random.uniformf()};
}

// Nothing, layers thin and thick, light that adds alone or among layers, solids behind all of them.
OitPlanes randomSums(Random& random, int width, int height) {
  OitPlanes planes = emptyPlanes({0, 0, width, height}, {0, 0, width, height});
  for (std::size_t i = 0; i < planes.radiance.size(); ++i) {
    if (random.uniform() < 0.2) planes.solid[i] = glm::vec4(randomColour(random, 3.0f), 5.0f);
    if (random.uniform() < 0.3) continue;
    const bool adds = random.uniform() < 0.4, hides = !adds || random.uniform() < 0.5;
    planes.weight[i].a = 1.0f + std::floor(5.0f * random.uniformf());
    planes.frontZ[i] = 1.0f + 8.0f * random.uniformf();
    if (hides) {
      const float reach = random.uniform() < 0.3 ? 100.0f : 1.0f;
      planes.depth[i] = glm::vec4(randomColour(random, reach), 0.0f);
      planes.opacity[i] = glm::vec4(randomColour(random, 1.0f), random.uniformf());
      planes.weight[i] = glm::vec4(randomColour(random, 1e-3f), planes.weight[i].a);
      planes.radiance[i] = glm::vec4(randomColour(random, 2e-3f), random.uniformf());
      if (random.uniform() < 0.2) planes.weight[i].g = planes.opacity[i].g = 0.0f;
    }
    if (adds) {
      planes.light[i] = glm::vec4(randomColour(random, 9.0f), 0.0f);
      planes.depth[i].a = random.uniformf();
    }
  }
  return planes;
}

template <class Texel>
bool sameTexel(const Texel& a, const Texel& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(WideResolve, HasTheBitsOfTheText) {
  Random random(48);
  const FlushDenormals flush;
  for (const int width : {3, 8, 61, 200}) {
    const OitPlanes planes = randomSums(random, width, 90);
    const Veil veil = resolve(planes, {});
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < width; ++x) {
        const shading::OitSums sums = shading::unpackSums(planes.at(x, y));
        const glm::vec4 solid = planes.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        ASSERT_EQ(veil.touched.at(x, y) != 0, sums.count > 0.0f || hasSolid);
        if (veil.touched.at(x, y) == 0) continue;
        shading::Resolved right = shading::resolveSums(sums, false);
        if (hasSolid) {
          right.transparent = shading::overBackground(right, glm::vec3(solid));
          right.transmission = glm::vec3(0.0f);
        }
        ASSERT_TRUE(sameTexel(veil.light.at(x, y), right.transparent)) << width << ": " << x << ", " << y;
        ASSERT_TRUE(sameTexel(veil.transmission.at(x, y), right.transmission)) << width << ": " << x << ", " << y;
        ASSERT_EQ(veil.frontZ.at(x, y), std::min(planes.frontZ.at(x, y), solid.a));
      }
  }
}

}  // namespace
}  // namespace pellucid::test
