// The exact tier: no order changes a bit, and the planes have the bits of the offline tier of that name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/resolve.h"
#include "tests/bridge/host.h"
#include "tests/reference/sorted_over.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 32, kHeight = 24, kPixels = kWidth * kHeight;
constexpr float kFar = std::numeric_limits<float>::infinity();

struct Case {
  const char* what;
  bool coloured, light, refracts, diffuses, disperses, solids;
  pld_weight weight;
  int shuffles;
};
const Case kCases[] = {
    {"grey", false, false, false, false, false, false, PLD_WEIGHT_BY_EQ5, 2},
    {"grey, light", false, true, false, false, false, false, PLD_WEIGHT_BY_POWER, 2},
    {"grey, refraction, diffusion", false, true, true, true, false, false, PLD_WEIGHT_BY_EQ10Z, 2},
    {"grey, refraction", false, true, true, false, false, false, PLD_WEIGHT_BY_NONE, 2},
    {"grey, refraction, diffusion, no light", false, false, true, true, false, false, PLD_WEIGHT_BY_EQ5, 2},
    {"grey, refraction, no light", false, false, true, false, false, false, PLD_WEIGHT_BY_EQ9Z, 2},
    {"coloured, refraction, diffusion, no light", true, false, true, true, false, false, PLD_WEIGHT_BY_EQ5, 2},
    {"all but light", true, false, true, true, true, true, PLD_WEIGHT_BY_POWER, 20},
    {"coloured", true, false, false, false, false, false, PLD_WEIGHT_BY_POWER, 2},
    {"coloured, refraction", true, true, true, false, false, false, PLD_WEIGHT_BY_EQ8Z, 2},
    {"coloured, diffusion", true, true, false, true, false, false, PLD_WEIGHT_BY_EQ9, 2},
    {"coloured, light", true, true, false, false, false, false, PLD_WEIGHT_BY_POWER, 20},
    {"coloured, solids", true, false, false, false, false, true, PLD_WEIGHT_BY_EQ7, 20},
    {"all phenomena", true, true, true, true, true, true, PLD_WEIGHT_BY_POWER, 20}};

uint32_t featuresOf(const Case& one) {
  uint32_t features = 0;
  const auto add = [&](bool has, pld_feature feature) { features |= has ? static_cast<uint32_t>(feature) : 0u; };
  add(one.coloured, PLD_FEATURE_COLOURED);
  add(one.light, PLD_FEATURE_LIGHT);
  add(one.refracts, PLD_FEATURE_REFRACTION);
  add(one.diffuses, PLD_FEATURE_DIFFUSION);
  add(one.disperses, PLD_FEATURE_DISPERSION);
  add(one.solids, PLD_FEATURE_SOLIDS);
  return features;
}

shading::WeightSettings weightOf(const Case& one) {
  return {static_cast<int>(one.weight), 0.1f, 100.0f, 3.0f, 1.0f};
}

struct Shot {
  GBuffer gbuffer;
  FragmentLists lists;
};

// Weights over twelve decades, radiance over thirty, coverage and transmission at their ends, layers that coincide.
Fragment extreme(Random& random, const Case& one) {
  Fragment fragment{};
  const float coverages[] = {1e-6f, 0.3f, random.uniformf(), 0.999f, 1.0f, 1.0f - 0x1p-24f};
  const float clear = one.light ? 1.0f : 0.998f;
  const float transmissions[] = {1e-7f, 0.5f, random.uniformf() * clear, 0.998f, one.light ? 0.9995f : 0.99f, clear};
  const float radiances[] = {0.0f, 1e-30f, random.uniformf(), 100.0f * random.uniformf(), 65504.0f, 1e6f};
  fragment.coverage = one.light && random.below(8) == 0 ? 0.0f : coverages[random.below(6)];
  const auto any = [&](const float(&list)[6]) { return list[random.below(6)]; };
  fragment.transmission = glm::vec3(any(transmissions), any(transmissions), any(transmissions));
  if (!one.coloured) fragment.transmission = glm::vec3(fragment.transmission.r);
  fragment.radiance = glm::vec3(any(radiances), any(radiances), any(radiances));
  fragment.z = random.below(5) ? static_cast<float>(std::pow(10.0, random.between(-2, 2))) : 2.0f;
  if (one.refracts && random.below(2))
    fragment.offset = glm::vec2(40 * random.uniformf() - 20, 30 * random.uniformf() - 15);
  if (one.diffuses && random.below(3) == 0) fragment.variance = 60.0f * random.uniformf();
  return fragment;
}

Shot shotOf(const Case& one) {
  Random random(11);
  Shot shot;
  shot.gbuffer.display = shot.gbuffer.data = shot.lists.window = {0, 0, kWidth, kHeight};
  shot.gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
  shot.gbuffer.viewZ = Image<float>(kWidth, kHeight, 1e3f);
  shot.lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, kFar));
  shot.lists.offsets.push_back(0);
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    shot.gbuffer.beauty[pixel] = glm::vec4(random.uniformf(), 3 * random.uniformf(), 0.5f, 1.0f);
    const std::uint32_t layers = random.below(5) == 0 ? 0 : random.below(40) == 0 ? 200 : random.below(12);
    for (std::uint32_t i = 0; i < layers; ++i) {
      const bool again = i > 0 && random.below(6) == 0;
      shot.lists.fragments.push_back(again ? shot.lists.fragments.back() : extreme(random, one));
      if (one.disperses) {
        const bool bends = shot.lists.fragments.back().offset != glm::vec2(0.0f);
        shot.lists.dispersion.push_back(bends ? glm::vec4(-1, 0.5f, 2 * random.uniformf(), -0.25f) : glm::vec4(0.0f));
      }
    }
    // Three that hide everything, two of them at one depth.
    for (int i = 0; one.solids && i < 3 && pixel % 3 == 0; ++i) {
      Fragment solid{};
      solid.radiance = glm::vec3(random.uniformf(), random.uniformf(), 0.25f);
      solid.coverage = 1.0f;
      solid.z = i == 1 ? 7.0f : 3.0f;
      glm::vec4& nearest = shot.lists.solid[pixel];
      if (solid.z == nearest.w)
        nearest = glm::vec4(glm::max(glm::vec3(nearest), solid.radiance), solid.z);
      else if (solid.z < nearest.w)
        nearest = glm::vec4(solid.radiance, solid.z);
      shot.lists.fragments.push_back(solid);
      if (one.disperses) shot.lists.dispersion.emplace_back(0.0f);
    }
    shot.lists.offsets.push_back(shot.lists.fragments.size());
  }
  return shot;
}

void shuffle(FragmentLists& lists, Random& random) {
  for (std::size_t pixel = 0; pixel + 1 < lists.offsets.size(); ++pixel) {
    const std::uint64_t first = lists.offsets[pixel];
    for (std::uint64_t i = lists.offsets[pixel + 1] - first; i > 1; --i) {
      const std::uint64_t other = first + random.below(static_cast<std::uint32_t>(i));
      std::swap(lists.fragments[first + i - 1], lists.fragments[other]);
      if (lists.disperses()) std::swap(lists.dispersion[first + i - 1], lists.dispersion[other]);
    }
  }
}

// Plane by plane; empty where draw buffer i is not used.
using Planes = std::vector<std::vector<float>>;

Planes planesOf(pld_pass* pass) {
  Planes planes;
  for (int i = 0; i < 8; ++i) {
    uint64_t name = 0;
    EXPECT_EQ(pld_query(pass, static_cast<pld_value>(PLD_VALUE_FIRST_PLANE + i), &name), PLD_OK);
    planes.push_back(name ? readTexture(static_cast<GLuint>(name), kWidth, kHeight, GL_RGBA) : std::vector<float>());
  }
  return planes;
}

// As the permutation lays sums out, in the words of the shared text. Components that a plane lacks read as 0, 0, 0, 1.
Planes planesOf(const OitPlanes& sums, const Case& one) {
  Planes planes(8);
  const bool lean = !one.light, scatters = one.refracts || one.diffuses;
  const auto put = [&](std::size_t plane, glm::vec4 value) {
    for (int c = 0; c < 4; ++c) planes[plane].push_back(value[c]);
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const shading::OitTargets targets = sums.at(x, y);
      const shading::OitSums unpacked = shading::unpackSums(targets);
      const float diffuseZ = scatters && sums.scatters() ? sums.diffuseZ.at(x, y) : kFar;
      if (lean) {
        const glm::vec4 radiance(unpacked.numerator, one.coloured ? unpacked.count : unpacked.denominator.r);
        const float refractionZ = scatters ? targets.light.a : 0.0f, nearest = one.diffuses ? diffuseZ : 0.0f;
        put(0, radiance);
        if (one.coloured) {
          put(1, glm::vec4(unpacked.denominator, refractionZ));
          put(2, glm::vec4(unpacked.depth, nearest));
        } else {
          put(1, glm::vec4(unpacked.depth.r, unpacked.count, refractionZ, scatters ? nearest : 1.0f));
        }
        if (scatters) put(6, sums.refraction.at(x, y));
        if (one.disperses) put(7, sums.dispersion.at(x, y));
        continue;
      }
      put(4, targets.light);
      if (one.coloured) {
        put(0, targets.radiance);
        put(1, targets.weight);
        put(2, one.diffuses ? glm::vec4(glm::vec3(targets.opacity), diffuseZ) : targets.opacity);
        put(3, targets.depth);
      } else {
        const shading::GreyTargets packed = shading::packGrey(unpacked);
        put(0, packed.radiance);
        put(1,
            one.diffuses ? glm::vec4(packed.opacity.x, packed.opacity.y, packed.opacity.w, diffuseZ) : packed.opacity);
        put(2, glm::vec4(packed.depth, 0, 1));
      }
      if (scatters) put(6, sums.refraction.at(x, y));
      if (one.disperses) put(7, sums.dispersion.at(x, y));
    }
  return planes;
}

struct Difference {
  std::size_t words = 0, of = 0;
  double largest = 0;  // relative
};

void compare(const std::vector<float>& a, const std::vector<float>& b, Difference& difference) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++difference.of;
    if (std::memcmp(&a[i], &b[i], sizeof(float)) == 0) continue;
    ++difference.words;
    const double x = a[i], y = b[i];
    difference.largest = std::max(difference.largest, std::abs(x - y) / std::max(std::abs(x), 1e-30));
  }
}

Difference compare(const Planes& a, const Planes& b) {
  Difference difference;
  for (std::size_t i = 0; i < 8; ++i) compare(a[i], b[i], difference);
  return difference;
}

pld_create_info exactInfo(const Host& host, const Case& one) {
  pld_create_info info = host.info();
  info.features = featuresOf(one);
  info.tier = PLD_TIER_EXACT;
  info.weight = one.weight;
  info.fragments_per_pixel = 30.0f;
  info.storage_binding = 7;
  return info;
}

std::vector<pld_stage> stagesOf(const Case& one) {
  return one.solids ? std::vector<pld_stage>{PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}
                    : std::vector<pld_stage>{PLD_STAGE_LAYERS};
}

TEST(BridgeExact, NoOrderChangesABitAndTheBitsAreTheOfflineOnes) {
  GlContext context;
  for (const Case& one : kCases) {
    Shot shot = shotOf(one);
    OitPlanes sums = emptyPlanes(shot.gbuffer.display, shot.gbuffer.data);
    sums.info.weight = weightOf(one);
    foldExact(shot.lists, weightOf(one), shading::PLD_NORMALISE_SPECTRAL, sums);
    const Image<glm::vec4> expected = compose(resolveOver(sums, {}, {}, shot.gbuffer), shot.gbuffer).rgba;
    Host host(kWidth, kHeight);
    host.upload(shot.gbuffer);
    pld_pass* pass = host.create(exactInfo(host, one));
    ASSERT_NE(pass, nullptr);
    Random random(3);
    Planes first;
    std::vector<float> picture;
    Difference between, pictures;
    for (int turn = 0; turn <= one.shuffles; ++turn) {
      if (turn > 0) shuffle(shot.lists, random);
      replay(pass, shot.lists, host.frame(), stagesOf(one));
      const pld_target target = host.target();
      ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
      const Planes planes = planesOf(pass);
      if (turn == 0) first = planes, picture = host.picture();
      const Difference now = compare(first, planes);
      between.words += now.words;
      between.of += now.of;
      compare(picture, host.picture(), pictures);
    }
    uint64_t fragments = 0;
    EXPECT_EQ(pld_query(pass, PLD_VALUE_FRAGMENTS, &fragments), PLD_OK);
    const Difference offline = compare(planesOf(sums, one), first);
    Difference shown;
    compare(std::vector<float>(&expected[0].x, &expected[0].x + 4 * expected.size()), picture, shown);
    std::printf(
        "exact, %s: %llu fragments, %d shuffles: %zu of %zu words of planes and %zu of pictures differ; against the "
        "offline tier %zu of "
        "%zu words of planes (by %.2g) and %zu of %zu of the picture (by %.2g)\n",
        one.what, static_cast<unsigned long long>(fragments), one.shuffles, between.words, between.of, pictures.words,
        offline.words, offline.of, offline.largest, shown.words, shown.of, shown.largest);
    EXPECT_EQ(between.words, 0u) << one.what;
    EXPECT_EQ(pictures.words, 0u) << one.what;
    EXPECT_EQ(offline.words, 0u) << one.what;
    EXPECT_EQ(shown.words, 0u) << one.what;
    EXPECT_GT(fragments, 4000u);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  }
}

}  // namespace
}  // namespace pellucid::test
