// The table of planes: what a pixel takes, where each plane lies, what it is called in files and in shaders.
#include "shaders/plane_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "exr_files.h"
#include "gbuffer/plane_values.h"
#include "gbuffer/planes_io.h"
#include "shaders/plane_defines.h"
#include "shaders/shader_source.h"

namespace pellucid::test {
namespace {

// Every model whose parts go together.
std::vector<LayerModel> models() {
  std::vector<LayerModel> all;
  for (const PlaneTier tier : {PlaneTier::float32, PlaneTier::half, PlaneTier::published, PlaneTier::exact})
    for (int bits = 0; bits < 1 << 9; ++bits) {
      const auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
      LayerModel model;
      model.tier = tier;
      model.coloured = bit(0);
      model.addsLight = bit(1);
      model.refracts = bit(2);
      model.diffuses = bit(3);
      model.disperses = bit(4);
      model.front = bit(5);
      model.nearestDepths = bit(6);
      model.solids = bit(7);
      model.lowResolution = bit(8);
      if (!conflictOf(model)) all.push_back(model);
    }
  return all;
}

LayerModel offline(bool coloured, bool light, bool scatters, bool disperses, PlaneTier tier = PlaneTier::float32) {
  LayerModel model;
  model.tier = tier;
  model.coloured = coloured;
  model.addsLight = light;
  model.refracts = model.diffuses = scatters;
  model.disperses = disperses;
  return model;
}

LayerModel engine(PlaneTier tier, bool coloured, bool light, bool refracts, bool diffuses, bool disperses, bool front) {
  LayerModel model{tier, 0, 0, coloured, light, refracts, diffuses, disperses};
  model.front = front;
  model.nearestDepths = false;
  return model;
}

// README.md, Precision: 352 without coloured transmission, 544 with; 128 for light, 160 for refraction and diffusion.
TEST(PlaneLayout, BitsOfTheTiersAreThoseOfTheReadme) {
  EXPECT_EQ(usedBits(offline(false, false, false, false)), 352);
  EXPECT_EQ(usedBits(offline(true, false, false, false)), 544);
  EXPECT_EQ(usedBits(offline(true, true, false, false)), 544 + 128);
  EXPECT_EQ(usedBits(offline(true, true, true, false)), 544 + 128 + 160);
  EXPECT_EQ(usedBits(offline(false, true, true, false)), 352 + 128 + 160);
  EXPECT_EQ(usedBits(offline(true, true, true, true)), 544 + 128 + 160 + 128);
  EXPECT_EQ(usedBits(offline(true, false, false, false, PlaneTier::published)), 88);
  EXPECT_EQ(usedBits(offline(true, false, true, false, PlaneTier::published)), 112);
  // A pass that refracts writes the depth of what does beside the light, which no layer need add.
  EXPECT_EQ(usedBits(offline(true, false, true, false)), usedBits(offline(true, true, true, false)));
}

// engine_bridge/INTEGRATION.md, "What it costs".
TEST(PlaneLayout, BitsOfEnginesAreThoseOfTheirGuide) {
  const struct {
    LayerModel model;
    std::size_t planes;
    int bits;
  } rows[] = {{engine(PlaneTier::float32, true, false, true, true, false, false), 4, 512},
              {engine(PlaneTier::float32, true, true, true, true, false, false), 6, 768},
              {engine(PlaneTier::half, true, true, true, true, false, false), 6, 384},
              {engine(PlaneTier::float32, false, true, true, true, false, false), 5, 576},
              {engine(PlaneTier::published, true, false, true, true, false, false), 3, 112},
              {engine(PlaneTier::float32, true, true, false, false, false, false), 5, 640},
              {engine(PlaneTier::float32, false, false, false, false, false, false), 2, 192},
              {engine(PlaneTier::float32, false, true, false, false, false, false), 4, 448},
              {engine(PlaneTier::float32, true, false, false, false, false, false), 3, 384},
              {engine(PlaneTier::half, false, false, false, false, false, false), 2, 96},
              {engine(PlaneTier::published, false, false, false, false, false, false), 2, 96},
              {engine(PlaneTier::float32, false, false, false, false, false, true), 4, 352},
              {engine(PlaneTier::exact, true, true, true, true, false, false), 6, 768}};
  for (const auto& row : rows) {
    const std::vector<PlaneSpec> planes = planesOf(row.model);
    EXPECT_EQ(planes.size(), row.planes) << row.bits;
    EXPECT_EQ(bitsOf(planes), row.bits);
  }
}

TEST(PlaneLayout, NoTwoPlanesShareATargetOrAUnit) {
  const std::vector<LayerModel> all = models();
  ASSERT_GT(all.size(), 500u);
  for (const LayerModel& model : all) {
    std::set<int> targets, units{kBackgroundUnit, kOpaqueZUnit, kSolidUnit};
    std::set<PlaneSum> sums;
    const std::vector<PlaneSpec> planes = planesOf(model);
    for (const PlaneSpec& plane : planes) {
      EXPECT_TRUE(targets.insert(plane.target).second) << plane.name;
      EXPECT_TRUE(units.insert(plane.unit).second) << plane.name;
      EXPECT_TRUE(sums.insert(plane.sum).second) << plane.name;
      EXPECT_LT(plane.target, kMostTargets);
      EXPECT_LT(plane.unit, kSpreadUnit) << "where the spread pyramid lies";
      EXPECT_EQ(std::isinf(plane.clear[0]), plane.blend == PlaneBlend::minimum);
      EXPECT_EQ(std::isinf(plane.clear[3]), plane.blend == PlaneBlend::alphaMinimum);
    }
    for (const PlaneSpec& plane : planesOf(model, PlaneStage::over)) EXPECT_TRUE(units.insert(plane.unit).second);
    EXPECT_EQ(planes.front().sum, PlaneSum::radiance);
    if (!model.scatters() || model.published()) continue;
    // Depths that have no plane lie where nothing else does: in no other's component.
    const PlacedNumber bent = refractionZPlace(model);
    EXPECT_TRUE(sums.count(bent.sum));
    if (!model.diffuses) continue;
    const PlacedNumber spread = diffuseZPlace(model);
    EXPECT_TRUE(sums.count(spread.sum));
    EXPECT_FALSE(spread.sum == bent.sum && spread.component == bent.component);
  }
}

TEST(PlaneLayout, PartsThatDoNotGoTogetherAreNamed) {
  LayerModel model;
  EXPECT_FALSE(conflictOf(model));
  model.disperses = true;
  EXPECT_TRUE(conflictOf(model).without) << "of refraction";
  EXPECT_EQ(conflictOf(model).other, LayerPart::refraction);
  model.refracts = true;
  EXPECT_FALSE(conflictOf(model));
  model.front = true;
  EXPECT_EQ(conflictOf(model).part, LayerPart::scattering);
  model.front = false;
  model.tier = PlaneTier::published;
  EXPECT_EQ(conflictOf(model).part, LayerPart::dispersion);
  EXPECT_NE(std::string(conflictOf(model).reason), "");
  model.disperses = false;
  model.lowResolution = true;
  EXPECT_EQ(conflictOf(model).part, LayerPart::lowResolution);
}

// Every channel of every group: of its own name and number, and back from a file with every bit.
TEST(PlaneLayout, EveryChannelComesBackFromAFile) {
  TemporaryFolder folder;
  for (const bool published : {false, true}) {
    const Window window{2, 1, 9, 6};
    OitPlanes planes = published ? emptyPublishedPlanes(window, window) : emptyPlanes(window, window);
    LayerModel layers;
    layers.refracts = layers.diffuses = layers.disperses = true;
    addPlanes(planes, layers);
    EXPECT_EQ(planes.disperses(), !published);
    RimPlanes rims;
    if (!published) rims = RimPlanes(window.width(), window.height());
    const std::size_t pixels = planes.radiance.size();
    std::set<std::string> names;
    std::set<std::pair<PlaneSum, int>> places;
    float number = 0.5f;
    const auto eachChannel = [&](auto&& each) {
      for (const ChannelGroup group : kChannelGroups)
        for (const PlaneChannel& channel : channelsOf(group, published)) each(channel);
    };
    const auto valuesIn = [](auto& sums, auto& ofRims, const PlaneChannel& channel) {
      const auto values = valuesOf(sums, channel.sum, channel.component);
      return values ? values : valuesOf(ofRims, channel.sum, channel.component);
    };
    eachChannel([&](const PlaneChannel& channel) {
      EXPECT_TRUE(names.insert(channel.name).second) << channel.name;
      EXPECT_TRUE(places.insert({channel.sum, channel.component}).second) << channel.name;
      const PlaneValues values = valuesIn(planes, rims, channel);
      ASSERT_TRUE(values) << channel.name;
      for (std::size_t i = 0; i < pixels; ++i) values[i] = number += 0.25f;
    });
    writePlanes(folder.path("all.exr"), planes, rims);
    RimPlanes rimsBack;
    OitPlanes back = readPlanes(folder.path("all.exr"), &rimsBack);
    const Contents file = readFile(folder.path("all.exr"));
    EXPECT_EQ(file.planes.size(), names.size());
    std::size_t differing = 0;
    eachChannel([&](const PlaneChannel& channel) {
      EXPECT_TRUE(file.planes.count(std::string("0/") + channel.name)) << channel.name;
      const PlaneValues written = valuesIn(planes, rims, channel), read = valuesIn(back, rimsBack, channel);
      for (std::size_t i = 0; i < pixels; ++i) differing += written[i] != read[i];
    });
    EXPECT_EQ(differing, 0u) << (published ? "published" : "float");
    std::printf("%s: %zu channels\n", published ? "published" : "float", names.size());
  }
}

// What a stage declares by the table and by its own text, number by number.
TEST(PlaneLayout, NoStageReadsTwoTexturesFromOneUnit) {
  static const std::regex bound(R"(layout\(binding = (\d+)\) uniform sampler2D (\w+);)");
  static const std::regex out(R"(layout\(location = (\d+)\) out (\w+) (\w+);)");
  std::size_t stages = 0;
  const auto check = [&](const char* file, const std::vector<std::string>& defines, const std::regex& pattern) {
    const std::string text = shaderSource(file, defines);
    std::map<std::string, std::set<std::string>> places;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
      places[(*match)[1]].insert(match->str());
    EXPECT_FALSE(places.empty()) << file;
    for (const auto& [place, names] : places) EXPECT_EQ(names.size(), 1u) << file << ": " << place;
    ++stages;
  };
  for (const LayerModel& model : models()) {
    if (model.over()) continue;  // takes the units of the spread pyramid, which it has no use for
    check("gl/resolve.frag", readDefines(model), bound);
    if (model.lowResolution) check("gl/upsample.frag", upsampleDefines(model, atLowResolution(model)), bound);
    if (!model.published()) check("gl/sums_output.glsl", writeDefines(model), out);
  }
  std::printf("%zu stages\n", stages);
}

}  // namespace
}  // namespace pellucid::test
