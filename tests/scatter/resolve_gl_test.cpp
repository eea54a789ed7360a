// The device's resolve against the CPU's, from the same planes.
#include <gtest/gtest.h>

#include <cstring>

#include "composite/pipeline/resolve_step.h"
#include "tests/scatter/backdrop.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

struct Difference {
  std::size_t words = 0, all = 0;
  double largest = 0;  // relative
};

template <class T>
void compare(const Image<T>& a, const Image<T>& b, Difference& difference) {
  ASSERT_EQ(a.size(), b.size());
  constexpr std::size_t channels = sizeof(T) / sizeof(float);
  for (std::size_t i = 0; i < a.size(); ++i) {
    float x[channels], y[channels];
    std::memcpy(x, &a[i], sizeof(T));
    std::memcpy(y, &b[i], sizeof(T));
    for (std::size_t c = 0; c < channels; ++c, ++difference.all) {
      if (std::memcmp(&x[c], &y[c], sizeof(float)) == 0) continue;
      ++difference.words;
      const double error = std::abs(static_cast<double>(x[c]) - static_cast<double>(y[c])) /
                           std::max(1e-6, std::abs(static_cast<double>(x[c])));
      difference.largest = std::max(difference.largest, std::isfinite(error) ? error : 1e30);
    }
  }
}

// Layers of every kind, solids among them; some pixels refract, disperse, diffuse, or do not.
struct Shot {
  GBuffer gbuffer;
  OitPlanes planes;

  Shot(int width, int height, float largestSpread, bool scatters) {
    Random random(51);
    gbuffer.display = gbuffer.data = {0, 0, width, height};
    gbuffer.beauty = Image<glm::vec4>(width, height);
    gbuffer.viewZ = Image<float>(width, height);
    planes = emptyPlanes(gbuffer.display, gbuffer.data);
    if (scatters) addPlane(planes, PlaneSum::dispersion);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        gbuffer.beauty.at(x, y) = glm::vec4(random.uniformf(), 40 * random.uniformf(), (x / 9 + y / 9) % 2, 1);
        gbuffer.viewZ.at(x, y) = (x / 20) % 3 ? 20.0f : (y / 16) % 2 ? 2.0f : INFINITY;
        if (random.below(200) == 0) gbuffer.beauty.at(x, y).g = INFINITY;
        if (random.below(5) == 0) continue;
        for (std::uint32_t k = 0; k < 1 + random.below(4); ++k) add(random, x, y);
        if (random.below(12) == 0) planes.solid.at(x, y) = glm::vec4(random.uniformf(), 2, 0, 9.0f);
        if (scatters) scatter(random, x, y, largestSpread);
      }
  }

 private:
  void add(Random& random, int x, int y) {
    shading::Layer layer;
    layer.coverage = random.below(6) ? random.uniformf() : 0.0f;
    layer.transmission = glm::vec3(random.uniformf(), random.below(3) ? random.uniformf() : 1.0f, random.uniformf());
    layer.radiance = glm::vec3(random.uniformf(), 100 * random.uniformf(), 0.01f);
    layer.z = 1.0f + 8.0f * random.uniformf();
    const shading::OitTargets t =
        shading::packSums(shading::layerSums(layer, planes.info.weight, planes.info.normalisation));
    planes.radiance.at(x, y) += t.radiance, planes.weight.at(x, y) += t.weight, planes.opacity.at(x, y) += t.opacity;
    planes.depth.at(x, y) += t.depth, planes.light.at(x, y) += t.light;
    planes.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), layer.z);
  }
  void scatter(Random& random, int x, int y, float largestSpread) {
    const int kind = (x / 24 + y / 24) % 4;
    glm::vec4& sums = planes.refraction.at(x, y);
    if (kind >= 2) {
      const float weight = 0.1f + random.uniformf();
      sums = glm::vec4(weight * (60 * random.uniformf() - 30), weight * 9 * random.uniformf(), weight, 0);
      planes.light.at(x, y).a = weight * 5.0f;
      if (kind == 3) planes.dispersion.at(x, y) = weight * glm::vec4(-1, 0.5f, 2 * random.uniformf(), 0);
    }
    if (kind == 1 || kind == 2) {
      const float spread = largestSpread * (x % 48 < 16 ? 0.3f : 1.0f);
      sums.w = spread * spread;
      planes.diffuseZ.at(x, y) = 5.0f;
    }
  }
};

void expectSameBits(const Shot& shot, const ResolveSettings& settings, const LookupSettings& lookup, const char* what) {
  GlContext context;
  ResolvePass device(context);
  const Veil cpu = resolveOver(shot.planes, settings, lookup, shot.gbuffer);
  const Veil gl = resolveSums(&device, shot.planes, settings, lookup, shot.gbuffer);
  Difference difference;
  compare(cpu.light, gl.light, difference);
  compare(cpu.transmission, gl.transmission, difference);
  compare(cpu.frontZ, gl.frontZ, difference);
  if (cpu.scatters()) {
    compare(cpu.direct, gl.direct, difference);
    compare(cpu.applied, gl.applied, difference);
  }
  EXPECT_EQ(std::memcmp(cpu.touched.data(), gl.touched.data(), cpu.touched.size()), 0);
  std::printf("GL resolve against CPU, %s: %zu of %zu words differ, by %.2g relative at most\n", what, difference.words,
              difference.all, difference.largest);
  EXPECT_EQ(difference.words, 0u) << what;
  // The shot holds what it is meant to.
  std::size_t elsewhere = 0;
  for (std::size_t i = 0; i < cpu.applied.size(); ++i) elsewhere += cpu.applied[i] != glm::vec4(0.0f);
  EXPECT_EQ(elsewhere > cpu.applied.size() / 4, shot.planes.scatters()) << elsewhere;
}

TEST(ResolveGl, GivesTheBitsOfTheCpu) {
  expectSameBits(Shot(97, 61, 0, false), {}, {}, "no scattering");
  ResolveSettings modulated;
  modulated.selfModulation = true;
  expectSameBits(Shot(97, 61, 0, false), modulated, {}, "self-modulation");
  expectSameBits(Shot(144, 96, 3.0f, true), {}, {}, "D up to 3");
  expectSameBits(Shot(144, 96, 7.0f, true), {}, {}, "fast, D up to 7");
  expectSameBits(Shot(144, 96, 40.0f, true), {}, {}, "fast, D up to 40");
  LookupSettings exact, disc;
  exact.exact = true;
  disc.kernel = shading::PLD_DIFFUSE_DISC;
  expectSameBits(Shot(96, 64, 5.0f, true), {}, exact, "exact, D up to 5");
  expectSameBits(Shot(96, 64, 9.0f, true), {}, disc, "disc");
}

// One pass object serves pictures of any size, one after the other.
TEST(ResolveGl, ServesOneSizeAfterAnother) {
  GlContext context;
  ResolvePass device(context);
  for (const int width : {33, 130, 57}) {
    const Shot shot(width, 40, 12.0f, true);
    const Veil cpu = resolveOver(shot.planes, {}, {}, shot.gbuffer);
    const Veil gl = resolveSums(&device, shot.planes, {}, {}, shot.gbuffer);
    EXPECT_EQ(std::memcmp(cpu.applied.data(), gl.applied.data(), cpu.applied.size() * sizeof(glm::vec4)), 0) << width;
  }
}

}  // namespace
}  // namespace pellucid::test
