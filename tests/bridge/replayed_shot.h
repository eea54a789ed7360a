// Random layers over a picture, and their picture by the bridge: each fragment replayed through the seam.
#pragma once
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {

inline constexpr int kShotWidth = 120, kShotHeight = 90;
inline constexpr shading::WeightSettings kShotWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

struct Wanted {
  bool coloured = true, light = true, refracts = false, diffuses = false, disperses = false, solids = false;
  bool coincides = false;  // layers lie in planes that several share
};

struct Shot {
  GBuffer gbuffer;
  FragmentLists lists;

  explicit Shot(const Wanted& wanted) {
    Random random(7);
    gbuffer.display = gbuffer.data = lists.window = {0, 0, kShotWidth, kShotHeight};
    gbuffer.beauty = Image<glm::vec4>(kShotWidth, kShotHeight);
    gbuffer.viewZ = Image<float>(kShotWidth, kShotHeight);
    lists.solid = Image<glm::vec4>(kShotWidth, kShotHeight, glm::vec4(0, 0, 0, INFINITY));
    lists.offsets.push_back(0);
    for (int y = 0; y < kShotHeight; ++y)
      for (int x = 0; x < kShotWidth; ++x) {
        gbuffer.beauty.at(x, y) =
            glm::vec4(random.uniformf(), 3 * random.uniformf(), (x / 9 + y / 7) % 2, random.below(3) ? 1.0f : 0.5f);
        gbuffer.viewZ.at(x, y) = (x / 20) % 3 ? 20.0f : (y / 16) % 2 ? 12.0f : INFINITY;
        const std::uint32_t layers = random.below(4) ? random.below(9) : 0;
        for (std::uint32_t i = 0; i < layers; ++i) add(random, wanted);
        if (wanted.solids && random.below(3) == 0) {
          Fragment solid{};
          solid.radiance = glm::vec3(random.uniformf(), 1.0f, 0.25f);
          solid.coverage = 1.0f;
          solid.z = 2.0f + 4.0f * random.uniformf();
          lists.fragments.push_back(solid);
          if (!lists.dispersion.empty() || wanted.disperses) lists.dispersion.emplace_back(0.0f);
          lists.solid.at(x, y) = glm::vec4(solid.radiance, solid.z);
        }
        lists.offsets.push_back(lists.fragments.size());
      }
  }

 private:
  void add(Random& random, const Wanted& wanted) {
    Fragment fragment{};
    fragment.coverage = wanted.light && random.below(6) == 0 ? 0.0f : 0.9f * random.uniformf() + 0.05f;
    const float grey = random.uniformf();
    // Within a thousandth of 1 it adds light.
    const float most = wanted.light ? 1.0f : 0.998f;
    fragment.transmission =
        most * (wanted.coloured
                    ? glm::vec3(random.uniformf(), random.below(3) || !wanted.light ? random.uniformf() : 1.0f, grey)
                    : glm::vec3(0.9f * grey));
    fragment.radiance = glm::vec3(random.uniformf(), 50 * random.uniformf(), 0.01f);
    fragment.z = wanted.coincides ? 1.0f + static_cast<float>(random.below(4)) : 1.0f + 8.0f * random.uniformf();
    glm::vec4 dispersion(0.0f);
    if (wanted.refracts && random.below(2)) {
      fragment.offset = glm::vec2(40 * random.uniformf() - 20, 30 * random.uniformf() - 15);
      if (random.below(2)) dispersion = glm::vec4(-1, 0.5f, 2 * random.uniformf(), -0.25f);
    }
    if (wanted.diffuses && random.below(3) == 0) fragment.variance = 60.0f * random.uniformf();
    fragment.identity = static_cast<std::uint32_t>(lists.fragments.size());
    lists.fragments.push_back(fragment);
    if (wanted.disperses) lists.dispersion.push_back(dispersion);
  }
};

inline uint32_t featuresOf(const Wanted& wanted) {
  uint32_t features = 0;
  const auto add = [&](bool has, pld_feature feature) { features |= has ? static_cast<uint32_t>(feature) : 0u; };
  add(wanted.coloured, PLD_FEATURE_COLOURED);
  add(wanted.light, PLD_FEATURE_LIGHT);
  add(wanted.refracts, PLD_FEATURE_REFRACTION);
  add(wanted.diffuses, PLD_FEATURE_DIFFUSION);
  add(wanted.disperses, PLD_FEATURE_DISPERSION);
  add(wanted.solids, PLD_FEATURE_SOLIDS);
  return features;
}

// A pass of the host's with all stages of the shot drawn, for pld_resolve(); null where it could not be made.
//   more  features besides those that the shot needs
inline pld_pass* drawnBy(Host& host, const Shot& shot, const Wanted& wanted, pld_tier tier, pld_method method,
                         uint32_t more = 0) {
  host.upload(shot.gbuffer);
  pld_create_info info = host.info();
  info.features = featuresOf(wanted) | more;
  info.tier = tier;
  info.method = method;
  info.fragments_per_pixel = 10.0f;
  info.storage_binding = 7;
  pld_pass* pass = host.create(info);
  if (!pass) return nullptr;
  std::vector<pld_stage> stages;
  if (wanted.solids) stages.push_back(PLD_STAGE_SOLIDS);
  if ((method == PLD_METHOD_FRONT_TAIL || (more & PLD_FEATURE_IDENTITY)) && tier != PLD_TIER_EXACT)
    stages.push_back(PLD_STAGE_FRONT);
  stages.push_back(PLD_STAGE_LAYERS);
  replay(pass, shot.lists, host.frame(), stages);
  return pass;
}

inline std::vector<float> bridged(const Shot& shot, const Wanted& wanted, pld_tier tier, pld_method method) {
  Host host(kShotWidth, kShotHeight);
  pld_pass* pass = drawnBy(host, shot, wanted, tier, method);
  return pass ? host.finish(pass) : std::vector<float>();
}

struct Difference {
  std::size_t words = 0;
  double largest = 0;
};
inline Difference compare(const Image<glm::vec4>& expected, const std::vector<float>& found) {
  Difference difference;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float a = expected[i / 4][static_cast<int>(i % 4)], b = found[i];
    if (std::memcmp(&a, &b, sizeof(a)) != 0) ++difference.words;
    difference.largest =
        std::max(difference.largest, std::abs(double(a) - double(b)) / std::max(1.0, std::abs(double(a))));
  }
  return difference;
}

}  // namespace pellucid::test
