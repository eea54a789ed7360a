// The table of depth weights: what --weight takes, planes hold, `auto` fits and the C library offers, for every row. A
// row that is appended is held to all of it here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "composite/fold.h"
#include "composite/resolve.h"
#include "composite/study/fit_weight.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 48, kHeight = 32;
constexpr shading::WeightSettings kGiven{shading::PLD_WEIGHT_EQ5, 0.5f, 40.0f, 3.0f, 0.75f};

// The text of --weight for a row.
std::string textOf(const DepthWeight& row) {
  return row.parameter ? std::string(row.name) + ":1.75" : row.name;
}

struct Stacks {
  GBuffer gbuffer;
  FragmentLists lists;

  Stacks() {
    Random random(11);
    gbuffer.display = gbuffer.data = lists.window = {0, 0, kWidth, kHeight};
    gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0.25f, 0.5f, 0.75f, 1.0f));
    gbuffer.viewZ = Image<float>(kWidth, kHeight, 60.0f);
    lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, INFINITY));
    lists.offsets.push_back(0);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      for (std::uint32_t k = random.below(5); k > 0; --k) {
        Fragment layer{};
        layer.coverage = 0.1f + 0.8f * random.uniformf();
        layer.transmission = 0.9f * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
        layer.radiance = glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
        layer.z = 1.0f + 30.0f * random.uniformf();
        layer.identity = static_cast<std::uint32_t>(lists.fragments.size());
        lists.fragments.push_back(layer);
      }
      lists.offsets.push_back(lists.fragments.size());
    }
  }
  OitPlanes planes(const shading::WeightSettings& weight) const {
    OitPlanes planes = emptyPlanes(gbuffer.display, gbuffer.data);
    planes.info.weight = weight;
    foldFragments(lists, weight, shading::PLD_NORMALISE_SPECTRAL, planes);
    return planes;
  }
};

TEST(WeightTable, EveryRowIsParsedAndNoOtherTextIs) {
  for (const DepthWeight& row : kDepthWeights) {
    const shading::WeightSettings weight = parseWeight(textOf(row), kGiven);
    EXPECT_EQ(weight.kind, row.kind) << row.name;
    EXPECT_EQ(weight.exponent, row.parameter ? 1.75f : kGiven.exponent) << row.name;
    EXPECT_EQ(weight.rangeNear, kGiven.rangeNear) << row.name;
    EXPECT_EQ(weightName(weight), textOf(row));
    EXPECT_NE(weightsHelp().find(row.help), std::string::npos) << row.name;
    const std::string wrong = row.parameter ? row.name : std::string(row.name) + ":1";
    EXPECT_THROW(parseWeight(wrong, kGiven), UsageError) << wrong;
    if (!row.parameter) continue;
    for (const char* number : {":", ":x", ":inf", ":1 ", ":-1"})
      EXPECT_THROW(parseWeight(row.name + std::string(number), kGiven), UsageError) << row.name << number;
  }
  for (const char* none : {"", "eq", "eq55", "EQ5", ":1"}) EXPECT_THROW(parseWeight(none, kGiven), UsageError) << none;
}

TEST(WeightTable, EveryRowWeighs) {
  for (const DepthWeight& row : kDepthWeights) {
    const shading::WeightSettings weight = parseWeight(textOf(row), kGiven);
    bool falls = false;
    for (float z = 1.0f; z < 64.0f; z *= 2.0f) {
      const float nearer = shading::depthWeight(weight, z), farther = shading::depthWeight(weight, 2.0f * z);
      EXPECT_GT(farther, 0.0f) << row.name;
      EXPECT_GE(nearer, farther) << row.name << " at " << z;
      falls = falls || nearer > farther;
    }
    EXPECT_EQ(falls, row.kind != shading::PLD_WEIGHT_UNIFORM) << row.name << ": no function in weight.glsl?";
    // The range that a row says it does not read changes nothing.
    shading::WeightSettings other = weight;
    other.rangeNear *= 0.5f;
    other.rangeFar *= 2.0f;
    EXPECT_EQ(shading::depthWeight(weight, 7.0f) != shading::depthWeight(other, 7.0f), row.readsRange) << row.name;
  }
}

// Sums over two reference depths add to those over one; what no float holds is refused.
TEST(WeightTable, PlanesOverOtherReferencesMerge) {
  const Stacks stacks;
  for (const char* text : {"power:3", "power:16", "fig6", "eq7z"}) {
    shading::WeightSettings a = parseWeight(text, kGiven), b = a;
    b.reference = 2.5f;
    OitPlanes merged = stacks.planes(a), same = merged;
    mergePlanes(same, stacks.planes(a));
    if (a.kind == shading::PLD_WEIGHT_EQ7Z) {
      EXPECT_THROW(mergePlanes(merged, stacks.planes(b)), MeaningError);
      continue;
    }
    mergePlanes(merged, stacks.planes(b));
    const auto shown = [&](const OitPlanes& planes) {
      return compose(resolveOver(planes, {}, {}, stacks.gbuffer), stacks.gbuffer).rgba;
    };
    const Image<glm::vec4> found = shown(merged), expected = shown(same);
    double worst = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i)
      for (int c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(static_cast<double>(found[i][c]) - static_cast<double>(expected[i][c])));
    // A rounding of depth over the reference, to the power of 16, and those of up to 86 octaves: 4e-6 each.
    EXPECT_LE(worst, 2e-5) << text;
    EXPECT_EQ(merged.info.weight.reference, a.reference);
    b.reference = 1e9f;
    OitPlanes far = stacks.planes(a);
    if (std::string(text) == "power:16") {
      EXPECT_THROW(mergePlanes(far, stacks.planes(b)), MeaningError) << text;
    }
  }
}

TEST(WeightTable, EveryRowIsStoredInPlanes) {
  const Stacks stacks;
  const std::string path = (std::filesystem::temp_directory_path() / "pellucid-weight-rows.exr").string();
  for (const DepthWeight& row : kDepthWeights) {
    const bool refers = row.reference != WeightReference::none;
    const shading::WeightSettings weight =
        parseWeight(textOf(row), {0, 1.0f / 3.0f, 1e5f / 7.0f, 0.1f, refers ? 7.0f / 3.0f : 1.0f});
    writePlanes(path, stacks.planes(weight));
    const shading::WeightSettings back = readPlanes(path).info.weight;
    EXPECT_EQ(std::memcmp(&back, &weight, sizeof(weight)), 0) << row.name << ": " << weightText(back);
  }
  std::filesystem::remove(path);
  EXPECT_FALSE(readWeightText("eq6 1 2 3"));
  EXPECT_FALSE(readWeightText("eq5 1 2"));
  EXPECT_FALSE(readWeightText("eq5 1 2 3 4"));
  EXPECT_FALSE(readWeightText("power 1 2 3 0"));
  EXPECT_FALSE(readWeightText("power 1 2 3 4 5"));
  EXPECT_EQ(readWeightText("power 1 2 3")->reference, 1.0f);  // as files of before had it
}

TEST(WeightTable, AutoTriesEveryRow) {
  const Stacks stacks;
  std::vector<std::string> rough;
  const WeightFit fit = fitWeight(
      kGiven, depthsOf(stacks.lists),
      [&](const shading::WeightSettings& weight) {
        rough.push_back(weightText(weight));
        return 1.0 + static_cast<double>(weight.exponent);
      },
      [](const shading::WeightSettings& weight) { return weight.kind == shading::PLD_WEIGHT_EQ9Z ? 0.25 : 0.5; });
  EXPECT_EQ(fit.weight.kind, shading::PLD_WEIGHT_EQ9Z);
  EXPECT_EQ(fit.meanError, 0.25);
  const auto named = [](const std::string& text, const DepthWeight& row) {
    return text.substr(0, text.find(' ')) == row.name;
  };
  for (const DepthWeight& row : kDepthWeights) {
    const auto tries =
        std::count_if(fit.tried.begin(), fit.tried.end(), [&](const auto& tried) { return named(tried.first, row); });
    const auto others = std::count_if(rough.begin(), rough.end(), [&](const auto& text) { return named(text, row); });
    EXPECT_EQ(tries > 0, row.fitted) << row.name;
    EXPECT_EQ(others > 1, row.fitted && (row.parameter || row.readsRange || row.reference == WeightReference::unit))
        << row.name;
  }
}

TEST(WeightTable, TheLibraryForEnginesOffersEveryRow) {
  GlContext context;
  const Stacks stacks;
  for (const DepthWeight& row : kDepthWeights) {
    pld_weight named = PLD_WEIGHT_BY_NONE;
    ASSERT_EQ(pld_weight_named(row.name, &named), PLD_OK) << row.name;
    Host host(kWidth, kHeight);
    host.upload(stacks.gbuffer);
    pld_create_info info = host.info();
    info.features = PLD_FEATURE_COLOURED;
    info.weight = named;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr) << row.name;
    pld_frame frame = host.frame();
    const shading::WeightSettings weight = parseWeight(textOf(row), kGiven);
    frame.weight_near = weight.rangeNear;
    frame.weight_far = weight.rangeFar;
    frame.weight_exponent = weight.exponent;
    frame.weight_reference = weight.reference;
    replay(pass, stacks.lists, frame, {PLD_STAGE_LAYERS});
    const std::vector<float> found = host.finish(pass);
    const Image<glm::vec4> expected =
        compose(resolveOver(stacks.planes(weight), {}, {}, stacks.gbuffer), stacks.gbuffer).rgba;
    ASSERT_EQ(found.size(), expected.size() * 4);
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(float)), 0) << row.name;
  }
  // A host of 0.5 has no reference: metres.
  shading::WeightSettings metres = parseWeight("power:1.75", kGiven);
  metres.reference = 1.0f;
  Host host(kWidth, kHeight);
  host.upload(stacks.gbuffer);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_COLOURED;
  info.weight = PLD_WEIGHT_BY_POWER;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  frame.weight_exponent = 1.75f;
  frame.weight_reference = 99.0f;
  frame.struct_size = offsetof(pld_frame, weight_reference);
  replay(pass, stacks.lists, frame, {PLD_STAGE_LAYERS});
  const std::vector<float> found = host.finish(pass);
  const Image<glm::vec4> expected =
      compose(resolveOver(stacks.planes(metres), {}, {}, stacks.gbuffer), stacks.gbuffer).rgba;
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(float)), 0);
  pld_weight none = PLD_WEIGHT_BY_NONE;
  EXPECT_EQ(pld_weight_named("eq6", &none), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_weight_named(nullptr, &none), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_weight_named("eq5", nullptr), PLD_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace pellucid::test
