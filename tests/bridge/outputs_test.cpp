// What PLD_FEATURE_DEPTHS, _MOTION and _IDENTITY tell of the layers, against closed forms of the same fragments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/bridge/replayed_shot.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kTold = PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;

struct Method {
  const char* what;
  pld_tier tier;
  pld_method method;
  double tolerance;  // of a mean, relative: in halves sums of nine terms have eleven bits
};
constexpr Method kMethods[] = {{"over", PLD_TIER_EXACT, PLD_METHOD_OVER, 1e-6},
                               {"exact sums", PLD_TIER_EXACT, PLD_METHOD_WEIGHTED, 1e-6},
                               {"exact front+tail", PLD_TIER_EXACT, PLD_METHOD_FRONT_TAIL, 2e-6},
                               {"float sums", PLD_TIER_FLOAT, PLD_METHOD_PHENOMENOLOGICAL, 2e-6},
                               {"half sums", PLD_TIER_HALF, PLD_METHOD_WEIGHTED, 9 * 0x1p-11},
                               {"front+tail", PLD_TIER_FLOAT, PLD_METHOD_FRONT_TAIL, 2e-6}};

// What is true of a pixel.
struct Truth {
  double shares = 0, meanDepth = HUGE_VAL, motion[2] = {0, 0}, opacity = 0;
  float nearest = INFINITY;
  double identity = 0;
  std::vector<const Fragment*> layers;  // from near to far
  float solidZ = INFINITY;

  // Where so much is hidden.
  float reached(double opacityWanted) const {
    glm::dvec3 passed(1);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      passed *= glm::dvec3(1) - double(layers[i]->coverage) * (glm::dvec3(1) - glm::dvec3(layers[i]->transmission));
      if (i + 1 < layers.size() && layers[i + 1]->z == layers[i]->z) continue;
      if (1.0 - (passed.r + passed.g + passed.b) / 3.0 >= opacityWanted) return layers[i]->z;
    }
    return solidZ;
  }
};

double shareOf(const Fragment& one) {
  double share = 0;
  for (int c = 0; c < 3; ++c)
    if (one.coverage != 0.0f && 1.0f - one.transmission[c] >= 1e-3f)
      share += double(one.coverage) * (1.0 - double(one.transmission[c])) / 3.0;
  return share;
}

void add(Truth& truth, double share, const Fragment& one) {
  truth.shares += share;
  truth.meanDepth = (std::isinf(truth.meanDepth) ? 0.0 : truth.meanDepth) + share * double(one.z);
  for (int c = 0; c < 2; ++c) truth.motion[c] += share * double(marksOf(one.identity).motion[c]);
}

Truth truthOf(const FragmentLists& lists, std::size_t pixel) {
  Truth truth;
  const auto isSolid = [](const Fragment& one) { return one.coverage >= 1.0f && one.transmission == glm::vec3(0); };
  const Fragment* solid = nullptr;
  for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
    if (isSolid(lists.fragments[i])) solid = &lists.fragments[i];
  if (solid) truth.solidZ = solid->z;
  for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
    const Fragment& one = lists.fragments[i];
    if (!isSolid(one) && one.z <= truth.solidZ) truth.layers.push_back(&one);
  }
  const auto isNearer = [](const Fragment* a, const Fragment* b) {
    return a->z != b->z ? a->z < b->z : marksOf(a->identity).identity < marksOf(b->identity).identity;
  };
  std::stable_sort(truth.layers.begin(), truth.layers.end(), isNearer);
  glm::dvec3 passed(1);
  for (const Fragment* one : truth.layers) {
    add(truth, shareOf(*one), *one);
    passed *= glm::dvec3(1) - double(one->coverage) * (glm::dvec3(1) - glm::dvec3(one->transmission));
  }
  if (solid) add(truth, 1.0, *solid);
  truth.opacity = solid ? 1.0 : 1.0 - (passed.r + passed.g + passed.b) / 3.0;
  const Fragment* first = truth.layers.empty() ? solid : truth.layers[0];
  if (first) {
    truth.nearest = first->z;
    truth.identity = marksOf(first->identity).identity;
  }
  if (truth.shares > 0) {
    truth.meanDepth /= truth.shares;
    for (double& motion : truth.motion) motion /= truth.shares;
  } else {
    truth.meanDepth = double(truth.nearest);
  }
  return truth;
}

Shot shotOf(const Wanted& wanted) {
  Shot shot(wanted);
  for (std::size_t i = 0; i < shot.lists.fragments.size(); ++i)
    shot.lists.fragments[i].identity = static_cast<std::uint32_t>((i * 7919) % 2000003);  // up to 14 million, as told
  return shot;
}

// Relative to what is expected where that is more than 1; 0 where both are infinite.
double offBy(double expected, float found) {
  const double there = found;
  if (std::isinf(expected) || std::isinf(there)) return expected == there ? 0.0 : HUGE_VAL;
  return std::abs(expected - there) / std::max(1.0, std::abs(expected));
}

struct Worst {
  double depth = 0, motion = 0, share = 0;
  std::size_t identities = 0;
};

Worst worstOf(const Shot& shot, const Wanted& wanted, const Method& method) {
  Host host(kShotWidth, kShotHeight);
  pld_pass* pass = drawnBy(host, shot, wanted, method.tier, method.method, kTold);
  Worst worst;
  if (!pass) return {HUGE_VAL, HUGE_VAL, HUGE_VAL, 1};
  const std::vector<float> depth = seen(host, pass, PLD_VIEW_MEAN_DEPTH), motion = seen(host, pass, PLD_VIEW_MOTION),
                           identity = seen(host, pass, PLD_VIEW_IDENTITY);
  pld_destroy(&pass);
  for (std::size_t i = 0; 4 * i < depth.size(); ++i) {
    const Truth truth = truthOf(shot.lists, i);
    worst.depth = std::max(worst.depth, offBy(truth.meanDepth, depth[4 * i]));
    for (std::size_t c = 0; c < 2; ++c)
      worst.motion = std::max(worst.motion, std::abs(truth.motion[c] - double(motion[4 * i + c])));
    worst.share = std::max(worst.share, offBy(truth.opacity, motion[4 * i + 3]));
    worst.identities += truth.identity != double(identity[4 * i]);
  }
  return worst;
}

// Motion is up to 56 pixels: its sums keep 24 bits in every tier.
TEST(BridgeTold, DepthMotionAndIdentityAreThoseOfTheFragments) {
  GlContext context;
  for (const Method& method : kMethods)
    for (const bool solids : {false, true})
      for (const bool coloured : {false, true}) {
        const bool isFull = method.method == PLD_METHOD_FRONT_TAIL && method.tier != PLD_TIER_EXACT;
        const Wanted wanted{.coloured = coloured, .light = coloured && !isFull, .solids = solids};
        const Shot shot = shotOf(wanted);
        const Worst worst = worstOf(shot, wanted, method);
        std::printf("told, %s%s%s: mean depth by %.2g, motion by %.2g px, its alpha by %.2g, %zu identities differ\n",
                    method.what, solids ? ", solids" : "", coloured ? ", coloured" : "", worst.depth, worst.motion,
                    worst.share, worst.identities);
        EXPECT_LE(worst.depth, method.tolerance) << method.what;
        EXPECT_LE(worst.motion, 56 * 2e-6) << method.what;
        EXPECT_LE(worst.share, method.tolerance) << method.what;
        EXPECT_EQ(worst.identities, 0u) << method.what;
      }
}

// Of several nearest layers in one plane the smallest identity.
TEST(BridgeTold, LayersInOnePlaneShareAPlace) {
  GlContext context;
  const Wanted wanted{.coincides = true};
  const Shot shot = shotOf(wanted);
  for (const Method& method : kMethods) {
    if (method.method == PLD_METHOD_FRONT_TAIL && method.tier != PLD_TIER_EXACT) continue;  // they count as one
    const Worst worst = worstOf(shot, wanted, method);
    EXPECT_LE(worst.depth, method.tolerance) << method.what;
    EXPECT_LE(worst.motion, 56 * 2e-6) << method.what;
    EXPECT_EQ(worst.identities, 0u) << method.what;
  }
}

TEST(BridgeTold, DepthOfOpacityIsThatOfTheSortedLayers) {
  GlContext context;
  for (const pld_method method : {PLD_METHOD_OVER, PLD_METHOD_PHENOMENOLOGICAL, PLD_METHOD_FRONT_TAIL})
    for (const float opacity : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f}) {
      const Wanted wanted{.solids = opacity != 0.25f, .coincides = opacity == 0.5f};
      const Shot shot = shotOf(wanted);
      Host host(kShotWidth, kShotHeight);
      host.opacity = opacity;
      pld_pass* pass = drawnBy(host, shot, wanted, PLD_TIER_EXACT, method, PLD_FEATURE_DEPTHS);
      ASSERT_NE(pass, nullptr);
      const std::vector<float> found = seen(host, pass, PLD_VIEW_OPACITY_DEPTH);
      pld_destroy(&pass);
      std::size_t differing = 0, there = 0, apart = 0;
      for (std::size_t i = 0; 4 * i < found.size(); ++i) {
        const Truth truth = truthOf(shot.lists, i);
        differing += truth.reached(double(opacity)) != found[4 * i];
        there += std::isfinite(found[4 * i]) ? 1 : 0;
        apart += found[4 * i] != truth.nearest;
      }
      std::printf("depth of opacity %g, method %d: %zu of %zu differ; %zu pixels have one, of %zu not the nearest's\n",
                  static_cast<double>(opacity), static_cast<int>(method), differing, found.size() / 4, there, apart);
      EXPECT_EQ(differing, 0u);
      EXPECT_GT(there, found.size() / 16);
      EXPECT_EQ(apart > 0, opacity > 0.0f);
    }
}

TEST(BridgeTold, NoOrderChangesABitOfTheExactTier) {
  GlContext context;
  constexpr pld_view views[] = {PLD_VIEW_MEAN_DEPTH, PLD_VIEW_OPACITY_DEPTH, PLD_VIEW_MOTION, PLD_VIEW_IDENTITY};
  for (const pld_method method : {PLD_METHOD_OVER, PLD_METHOD_WEIGHTED}) {
    const Wanted wanted{.solids = true, .coincides = true};
    Shot shot = shotOf(wanted);
    std::vector<std::vector<float>> forth, back;
    for (std::vector<std::vector<float>>* pictures : {&forth, &back}) {
      Host host(kShotWidth, kShotHeight);
      pld_pass* pass = drawnBy(host, shot, wanted, PLD_TIER_EXACT, method, kTold);
      ASSERT_NE(pass, nullptr);
      for (const pld_view view : views) pictures->push_back(seen(host, pass, view));
      pld_destroy(&pass);
      for (std::size_t i = 0; i + 1 < shot.lists.offsets.size(); ++i)
        std::reverse(shot.lists.fragments.begin() + static_cast<std::ptrdiff_t>(shot.lists.offsets[i]),
                     shot.lists.fragments.begin() + static_cast<std::ptrdiff_t>(shot.lists.offsets[i + 1]));
    }
    for (std::size_t i = 0; i < forth.size(); ++i)
      EXPECT_EQ(std::memcmp(forth[i].data(), back[i].data(), forth[i].size() * sizeof(float)), 0) << views[i];
  }
}

// The picture and its planes are what they are without.
TEST(BridgeTold, ThePictureKeepsItsBits) {
  GlContext context;
  const Wanted wanted{.refracts = true, .solids = true};
  const Shot shot = shotOf(wanted);
  for (const pld_tier tier : {PLD_TIER_FLOAT, PLD_TIER_HALF, PLD_TIER_EXACT}) {
    Host host(kShotWidth, kShotHeight);
    pld_pass* pass = drawnBy(host, shot, wanted, tier, PLD_METHOD_PHENOMENOLOGICAL, PLD_FEATURE_OUTPUTS);
    ASSERT_NE(pass, nullptr);
    const std::vector<float> without = host.finish(pass);
    pass = drawnBy(host, shot, wanted, tier, PLD_METHOD_PHENOMENOLOGICAL, kTold);
    ASSERT_NE(pass, nullptr);
    const std::vector<float> with = host.finish(pass);
    EXPECT_EQ(std::memcmp(with.data(), without.data(), with.size() * sizeof(float)), 0) << tier;
  }
}

// One sheet over the whole picture.
void drawSheet(pld_pass* pass, pld_stage stage, const pld_frame& frame, float z) {
  drawOverAll(pass, stage, frame,
              "void main() { PldSurface s = pldSurface(vec3(0.1), 0.5, vec3(0.0), vec3(0.0, 0.0, " +
                  std::to_string(-z) +
                  "));\n s.motion = vec2(8.0, -2.0);\n s.identity = 20000000u;\n pldWriteFragment(s); }\n");
}

// Low resolution is in the mean depth, and tells nothing else; validation finds no fault. Identities are clamped.
TEST(BridgeTold, LayersOfLowResolutionHaveDepthAlone) {
  GlContext context;
  Host host(32, 16);
  pld_create_info info = host.info();
  info.features = kTold | PLD_FEATURE_LOW_RESOLUTION;
  info.flags = PLD_FLAG_VALIDATE;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  for (const pld_stage stage : {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) drawSheet(pass, stage, frame, 4.0f);
  drawSheet(pass, PLD_STAGE_LOW, frame, 2.0f);
  const std::vector<float> depth = seen(host, pass, PLD_VIEW_MEAN_DEPTH), motion = seen(host, pass, PLD_VIEW_MOTION),
                           identity = seen(host, pass, PLD_VIEW_IDENTITY);
  for (std::size_t i = 0; i < depth.size(); i += 4) {
    EXPECT_NEAR(depth[i], 3.0f, 1e-6f);
    EXPECT_EQ(motion[i], 8.0f);
    EXPECT_EQ(motion[i + 1], -2.0f);
    EXPECT_NEAR(motion[i + 3], 0.75f, 1e-6f);
    EXPECT_EQ(identity[i], 16777215.0f);
  }
  pld_target target = host.target();
  target.view = PLD_VIEW_OPACITY_DEPTH;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_UNSUPPORTED);
  EXPECT_NE(std::string(pld_message(pass)).find("in which order opacity grows"), std::string::npos);
  pld_destroy(&pass);
}

// Targets of one and two channels serve what has no more.
TEST(BridgeTold, TargetsMayHaveTheChannelsThatAreTold) {
  GlContext context;
  Host host(32, 16);
  pld_create_info info = host.info();
  info.features = kTold;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  for (const pld_stage stage : {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) drawSheet(pass, stage, frame, 4.0f);
  GLuint one = makeTexture(GL_R32F, 32, 16), two = makeTexture(GL_RG16F, 32, 16), whole = makeTexture(GL_R32UI, 32, 16);
  pld_target target = host.target();
  target.view = PLD_VIEW_MEAN_DEPTH;
  target.name = one;
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(readTexture(one, 32, 16, GL_RED)[77], 4.0f);
  target.view = PLD_VIEW_MOTION;
  target.name = two;
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(readTexture(two, 32, 16, GL_RG)[77], -2.0f);
  target.name = whole;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_FORMAT);
  target.view = PLD_VIEW_PICTURE;
  target.name = one;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_FORMAT) << "a picture has three";
  glDeleteTextures(1, &one);
  glDeleteTextures(1, &two);
  glDeleteTextures(1, &whole);
  pld_destroy(&pass);
}

TEST(BridgeTold, WhatCannotBeToldIsRefusedWithASentence) {
  GlContext context;
  Host host(16, 16);
  const auto refused = [&](pld_tier tier, pld_method method, uint32_t features, const char* expected) {
    pld_create_info info = host.info();
    info.tier = tier;
    info.method = method;
    info.features = features;
    pld_pass* pass = nullptr;
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_UNSUPPORTED) << expected;
    EXPECT_NE(host.log.last().find(expected), std::string::npos) << host.log.last();
    pld_destroy(&pass);
  };
  constexpr uint32_t full =
      PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_OUTPUTS | PLD_FEATURE_REFRACTION | PLD_FEATURE_DISPERSION;
  refused(PLD_TIER_PUBLISHED, PLD_METHOD_WEIGHTED, PLD_FEATURE_DEPTHS, "PLD_FEATURE_DEPTHS with PLD_TIER_PUBLISHED");
  refused(PLD_TIER_PUBLISHED, PLD_METHOD_WEIGHTED, PLD_FEATURE_MOTION, "PLD_FEATURE_MOTION with PLD_TIER_PUBLISHED");
  refused(PLD_TIER_PUBLISHED, PLD_METHOD_WEIGHTED, PLD_FEATURE_IDENTITY, "PLD_FEATURE_IDENTITY with");
  refused(PLD_TIER_FLOAT, PLD_METHOD_FRONT_TAIL, PLD_FEATURE_DEPTHS | PLD_FEATURE_LOW_RESOLUTION, "no depth of");
  refused(PLD_TIER_FLOAT, PLD_METHOD_PHENOMENOLOGICAL, full | PLD_FEATURE_MOTION, "take all eight targets");
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  const std::pair<pld_view, const char*> views[] = {{PLD_VIEW_MEAN_DEPTH, "PLD_FEATURE_DEPTHS"},
                                                    {PLD_VIEW_OPACITY_DEPTH, "PLD_FEATURE_DEPTHS"},
                                                    {PLD_VIEW_MOTION, "PLD_FEATURE_MOTION"},
                                                    {PLD_VIEW_IDENTITY, "PLD_FEATURE_IDENTITY"}};
  for (const auto& [view, feature] : views) {
    pld_target target = host.target();
    target.view = view;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_UNSUPPORTED);
    EXPECT_NE(std::string(pld_message(pass)).find(feature), std::string::npos) << pld_message(pass);
  }
  // A pass without it takes any number, one with it a part.
  frame.depth_opacity = 7.0f;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  EXPECT_EQ(pld_end(pass), PLD_OK);
  frame.depth_opacity = NAN;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ARGUMENT);
  pld_destroy(&pass);
  pld_create_info info = host.info();
  info.tier = PLD_TIER_EXACT;
  info.features = PLD_FEATURE_DEPTHS;
  info.fragments_per_pixel = 1.0f;
  pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  for (const float wrong : {-0.5f, 1.5f, NAN}) {
    frame.depth_opacity = wrong;
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ARGUMENT);
    EXPECT_NE(std::string(pld_message(pass)).find("from 0 to 1"), std::string::npos) << pld_message(pass);
  }
  // A frame of 0.13 ends before it.
  frame.struct_size = offsetof(pld_frame, depth_opacity);
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  EXPECT_EQ(pld_end(pass), PLD_OK);
  pld_destroy(&pass);
}

// Texts of passes that tell nothing are those that they were before there was anything to tell.
TEST(BridgeTold, WhatIsNotAskedForLeavesNoTraceInTheText) {
  GlContext context;
  Host host(16, 16);
  for (const pld_tier tier : {PLD_TIER_FLOAT, PLD_TIER_EXACT})
    for (const uint32_t told : {0u, uint32_t{PLD_FEATURE_MOTION}}) {
      pld_create_info info = host.info();
      info.tier = tier;
      info.features = told;
      info.fragments_per_pixel = 1.0f;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      const char* seam = nullptr;
      ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK);
      const std::string text = seam;
      for (const char* word : {"MARKS", "Marks", "vec2 motion"})
        EXPECT_EQ(text.find(word) != std::string::npos, told != 0) << word;
      uint64_t bits = 0;
      ASSERT_EQ(pld_query(pass, PLD_VALUE_BITS_PER_PIXEL, &bits), PLD_OK);
      EXPECT_EQ(bits, 192u + (told && tier == PLD_TIER_FLOAT ? 128u : 0u));
      pld_destroy(&pass);
    }
}

}  // namespace
}  // namespace pellucid::test
