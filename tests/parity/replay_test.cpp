// The CPU's fold and GL's blending of the same fragments, in the same order, give the same bits.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "shaders/weights.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 96, kHeight = 64, kDepth = 16;
constexpr float kNothing = std::numeric_limits<float>::infinity();

// Not solid: those are never blended.
Fragment randomFragment(Random& random, bool denormals) {
  auto channel = [&random] {
    const std::uint32_t kind = random.below(8);
    return kind == 0 ? 0.0f : kind == 1 ? 1.0f : kind == 2 ? 1.0f - random.uniformf() * 1e-3f : random.uniformf();
  };
  auto magnitude = [&random](double low, double high) {
    return static_cast<float>(std::pow(10.0, random.between(low, high)));
  };
  Fragment fragment{};
  fragment.coverage = random.below(6) == 0 ? 0.0f : random.below(6) == 0 ? 1.0f : random.uniformf();
  if (random.below(8) == 0) fragment.coverage = magnitude(-8, -2);
  fragment.transmission = {channel(), channel(), channel()};
  fragment.radiance = {magnitude(-6, 6), magnitude(-6, 6), magnitude(-6, 6)};
  if (random.below(8) == 0) fragment.radiance = glm::vec3(0.0f);
  fragment.z = magnitude(-2, 4);
  if (denormals) {
    if (random.below(2)) fragment.radiance *= 1e-38f;
    if (random.below(2)) fragment.radiance.g *= 1e-38f;
    if (random.below(2)) fragment.coverage *= 1e-30f;
    if (random.below(4) == 0) fragment.coverage = 3e-42f;
    if (random.below(4) == 0) fragment.transmission.b = 1e-44f;
  }
  // Solid, or so once its denormals are flushed.
  if (fragment.coverage == 1.0f && glm::all(glm::lessThan(fragment.transmission, glm::vec3(1e-30f))))
    fragment.coverage = 0.5f;
  return fragment;
}

FragmentLists randomLists(std::uint64_t seed, bool denormals) {
  Random random(seed);
  FragmentLists lists;
  lists.window = {-3, 7, -3 + kWidth, 7 + kHeight};
  lists.offsets = {0};
  for (int pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    // Every pixel of the first 4096 has 16 fragments; the rest 0 to 16.
    const std::uint32_t count = pixel < 4096 ? kDepth : random.below(kDepth + 1);
    for (std::uint32_t i = 0; i < count; ++i) lists.fragments.push_back(randomFragment(random, denormals));
    lists.offsets.push_back(lists.fragments.size());
  }
  lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, kNothing));
  return lists;
}

// Written out here rather than taken from composite/, so that both folds are checked.
OitPlanes foldedHere(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation) {
  OitPlanes planes = emptyPlanes(lists.window, lists.window);
  for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i)
    for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) {
      const Fragment& fragment = lists.fragments[k];
      shading::Layer layer;
      layer.radiance = fragment.radiance;
      layer.coverage = fragment.coverage;
      layer.transmission = fragment.transmission;
      layer.z = fragment.z;
      const shading::OitTargets added = shading::packSums(shading::layerSums(layer, weight, normalisation));
      planes.radiance[i] += added.radiance;
      planes.weight[i] += added.weight;
      planes.opacity[i] += added.opacity;
      planes.depth[i] += added.depth;
      planes.light[i] += added.light;
      planes.frontZ[i] = std::min(planes.frontZ[i], fragment.z);
    }
  return planes;
}

struct Difference {
  std::size_t words = 0;
  std::string first;
};

template <class T>
void compare(const char* name, const Image<T>& cpu, const Image<T>& gl, Difference& difference) {
  constexpr std::size_t channels = sizeof(T) / sizeof(float);
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    float a[channels], b[channels];
    std::memcpy(a, &cpu[i], sizeof(T));
    std::memcpy(b, &gl[i], sizeof(T));
    for (std::size_t c = 0; c < channels; ++c) {
      if (std::memcmp(&a[c], &b[c], sizeof(float)) == 0) continue;
      char text[160];
      std::snprintf(text, sizeof(text), "%s[%zu].%zu: cpu %.9g, gl %.9g", name, i, c, static_cast<double>(a[c]),
                    static_cast<double>(b[c]));
      if (++difference.words == 1) difference.first = text;
    }
  }
}

Difference compare(const OitPlanes& cpu, const OitPlanes& gl) {
  Difference difference;
  compare("radiance", cpu.radiance, gl.radiance, difference);
  compare("weight", cpu.weight, gl.weight, difference);
  compare("opacity", cpu.opacity, gl.opacity, difference);
  compare("depth", cpu.depth, gl.depth, difference);
  compare("light", cpu.light, gl.light, difference);
  compare("frontZ", cpu.frontZ, gl.frontZ, difference);
  compare("solid", cpu.solid, gl.solid, difference);
  return difference;
}

void expectParity(bool denormals) {
  GlContext context;
  const FlushDenormals flush;
  std::size_t fragments = 0;
  for (int kind = 0; depthWeightOf(kind); ++kind)
    for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED}) {
      const FragmentLists lists = randomLists(static_cast<std::uint64_t>(kind * 2 + normalisation), denormals);
      const shading::WeightSettings weight{kind, 0.1f, 1000.0f, 2.5f, 1.0f};
      const OitPlanes cpu = foldedHere(lists, weight, normalisation);
      const OitPlanes gl = replayFragments(context, lists, weight, normalisation);
      const Difference difference = compare(cpu, gl);
      EXPECT_EQ(difference.words, 0u) << "weight " << kind << " normalisation " << normalisation << ": "
                                      << difference.first;
      OitPlanes folded = emptyPlanes(lists.window, lists.window);
      foldFragments(lists, weight, normalisation, folded);
      const Difference inComposite = compare(folded, gl);
      EXPECT_EQ(inComposite.words, 0u) << "foldFragments, weight " << kind << " normalisation " << normalisation << ": "
                                       << inComposite.first;
      fragments += lists.fragments.size();
    }
  std::printf("%zu fragments over %d pixels a run, %d weights x 2 normalisations, every plane: same bits\n",
              fragments / (2 * kDepthWeights.size()), kWidth * kHeight, static_cast<int>(kDepthWeights.size()));
}

TEST(Accumulate, ReplayedFragmentsMatchGlBitForBit) {
  expectParity(false);
}
TEST(Accumulate, DenormalsAreFlushedAlike) {
  expectParity(true);
}

TEST(Accumulate, ReplayIsInListOrder) {
  // 2^24 + 1 + 1 + ... in float depends on the order: the lists' must be kept.
  GlContext context;
  FragmentLists lists;
  lists.window = {0, 0, 2, 1};
  Fragment large{}, small{};
  large.radiance = glm::vec3(16777216.0f);
  small.radiance = glm::vec3(1.0f);
  large.z = small.z = 1.0f;
  large.transmission = small.transmission = glm::vec3(1.0f);
  lists.fragments = {large, small, small, small, small, large};
  lists.offsets = {0, 3, 6};
  lists.solid = Image<glm::vec4>(2, 1, glm::vec4(0, 0, 0, kNothing));
  const shading::WeightSettings weight{shading::PLD_WEIGHT_UNIFORM, 0.1f, 1000.0f, 3.0f, 1.0f};
  const OitPlanes planes = replayFragments(context, lists, weight, shading::PLD_NORMALISE_SPECTRAL);
  EXPECT_EQ(planes.light[0].r, 16777216.0f);
  EXPECT_EQ(planes.light[1].r, 16777218.0f);
}

}  // namespace
}  // namespace pellucid::test
