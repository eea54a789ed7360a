// Every method with every tier, feature and kind of picture: each combination either composites, finitely, or is
// refused by a row of the table before any file is opened.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/refusals.h"
#include "gbuffer/errors.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

const char* const kMethods[] = {"phenomenological", "weighted",        "blended",  "over",       "sum",
                                "average",          "listing3",        "listing4", "monochrome", "front+tail",
                                "wavelet:2",        "moments:4",       "mlab:4",   "unsorted",   "stochastic",
                                "stochastic:basic", "stochastic:alpha"};

struct Feature {
  const char* name;
  void (*ask)(Request& request);
};
const Feature kFeatures[] = {
    {"plain", [](Request&) {}},
    {"fog",
     [](Request& r) {
       r.fog.text = FogText();
       r.fog.text->medium.density = 0.05;
       r.fog.text->hasDensity = true;
     }},
    {"shadows by rays", [](Request& r) { r.shadows.source = ShadowSource::rays; }},
    {"shadows by maps",
     [](Request& r) {
       r.shadows.source = ShadowSource::maps;
       r.shadows.size = 256;
     }},
    {"low resolution",
     [](Request& r) {
       r.shot.scene.overrides = {"smoke.lowResolution=true"};
       r.lowResolution.factor = 4;
     }},
    {"systems",
     [](Request& r) {
       PaintSystems systems{SystemRule::node, std::nullopt};
       if (const auto* listed = std::get_if<PaintListed>(&r.paint)) systems.method = listed->method;
       if (paintsBy<PaintSums>(r) || paintsBy<PaintListed>(r)) r.paint = systems;
     }},
    {"resolve gl", [](Request& r) { r.resolveOnDevice = true; }},
    {"tolerance",
     [](Request& r) {
       const auto* listed = std::get_if<PaintListed>(&r.paint);
       if (paintsBy<PaintSums>(r) || (listed && listed->method.name == "weighted")) r.paint = PaintWithin{0.02};
     }},
    {"samples on the device",
     [](Request& r) {
       if (auto* samples = std::get_if<PaintSamples>(&r.paint)) samples->onDevice = true;
     }},
    {"adaptive samples on the device",
     [](Request& r) {
       if (auto* samples = std::get_if<PaintSamples>(&r.paint)) {
         samples->onDevice = true;
         samples->settings.adaptive = 0.05;
       }
     }},
    {"disc", [](Request& r) { r.lookup.kernel = shading::PLD_DIFFUSE_DISC; }},
    {"exact gather", [](Request& r) { r.lookup.exact = true; }},
    {"fitted weight", [](Request& r) { r.sums.fitWeight = true; }},
    {"a weight",
     [](Request& r) {
       r.sums.weight = shading::WeightSettings{shading::PLD_WEIGHT_EQ7, 0.1f, 1000.0f, 3.0f, 1.0f};
     }},
    {"a normalisation", [](Request& r) { r.sums.normalisation = shading::PLD_NORMALISE_PUBLISHED; }},
    {"self-modulation", [](Request& r) { r.sums.selfModulation = true; }},
    {"a shutter", openShutter},
    {"a lens", openLens},
    {"a shutter, a lens and shadows",
     [](Request& r) {
       openShutter(r);
       openLens(r);
       r.shadows.source = ShadowSource::rays;
     }},
    {"samples of pixels", [](Request& r) { r.supersampled = 3; }},
    {"a pixel filter",
     [](Request& r) {
       r.passes = 2;
       r.pixelFilter = parsePixelFilter("blackman-harris");
     }},
};

struct PictureKind {
  const char* name;
  std::string opaque;
  std::vector<std::string> inputs;
};

class Product : public ::testing::Test {
 protected:
  void SetUp() override { files = writeShotFiles(freshFolder("pipeline-product")); }
  ShotFiles files;
};

// Which row refuses it, or null.
const Refusal* refusedBy(const Request& request) {
  for (const Refusal& row : refusals())
    if (row.applies(request)) return &row;
  return nullptr;
}

std::size_t notFinite(const Image<glm::vec4>& picture) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.size(); ++i)
    if (!std::isfinite(picture[i].r + picture[i].g + picture[i].b + picture[i].a)) ++count;
  return count;
}

TEST_F(Product, EveryCombinationCompositesOrIsInTheTable) {
  const std::vector<PictureKind> pictures{{"flat", files.flat, {files.scene}},
                                          {"deep", files.deepPicture, {files.scene}},
                                          {"with deep layers", files.flat, {files.scene, files.deepLayers}}};
  std::size_t tried = 0, honoured = 0, refused = 0;
  for (const PictureKind& picture : pictures)
    for (const Feature& feature : kFeatures) {
      // One shot for all methods of a feature: what is loaded does not depend on them.
      std::unique_ptr<Compositor> compositor;
      for (const char* method : kMethods)
        for (const Tier tier : {Tier::float32, Tier::exact, Tier::published}) {
          Request request = requestOf(picture.opaque, picture.inputs[0]);
          request.shot.inputs = picture.inputs;
          request.method = method;
          request.paint = paintOf(method);
          request.tier = tier;
          feature.ask(request);
          ++tried;
          SCOPED_TRACE(std::string(picture.name) + ", " + feature.name + ", " + method + ", tier " +
                       std::to_string(static_cast<int>(tier)));
          if (refusedBy(request)) {
            ++refused;
            EXPECT_THROW(validate(request), UsageError);
            continue;
          }
          try {
            if (!compositor) compositor = std::make_unique<Compositor>(request);
            const Result result = compositor->run(request);
            EXPECT_EQ(notFinite(result.picture.rgba), 0u);
            ++honoured;
          } catch (const Error& error) {
            ADD_FAILURE() << error.what();
          }
        }
    }
  std::printf("%zu combinations: %zu honoured, %zu refused by the table\n", tried, honoured, refused);
}

TEST_F(Product, RefusalsOpenNoFile) {
  for (const char* method : kMethods)
    for (const Tier tier : {Tier::float32, Tier::exact, Tier::published})
      for (const Feature& feature : kFeatures) {
        Request request = requestOf("nowhere/missing.exr", "nowhere/missing.glb");
        request.method = method;
        request.paint = paintOf(method);
        request.tier = tier;
        feature.ask(request);
        SCOPED_TRACE(std::string(feature.name) + ", " + method);
        const int expected = refusedBy(request) ? 2 : 3;
        try {
          Compositor compositor(request);
          ADD_FAILURE() << "a missing file was loaded";
        } catch (const Error& error) {
          EXPECT_EQ(error.exitCode(), expected) << error.what();
        }
      }
}

TEST_F(Product, TheReadmeListsEveryRefusal) {
  const std::string readme = slurp(std::string(PELLUCID_SOURCE_DIR) + "/composite/README.md");
  for (const Refusal& row : refusals()) {
    std::string with = row.with;
    const auto braces = with.find("{}");
    if (braces != std::string::npos) with.replace(braces, 2, "NAME");
    std::string line = "| `";
    for (const std::string& part :
         {std::string(row.flag), std::string("` | "), std::string(row.found), std::string(" | "), with,
          std::string(" | "), std::string(row.expected), std::string(" | "), std::string(row.why), std::string(" |")})
      line += part;
    EXPECT_NE(readme.find(line), std::string::npos) << line;
  }
}

// What is read changes something, or is refused: nothing that was given is passed over.
TEST_F(Product, WhatIsGivenIsReadOrRefused) {
  Request base = requestOf(files.flat, files.scene);
  base.shot.time.frame = 12;
  Compositor compositor(base);
  for (const char* method : kMethods)
    for (const Feature& feature : kFeatures) {
      const std::string name = feature.name;
      const bool blurs = name == "a shutter" || name == "a lens";
      if (!blurs && name != "a weight" && name != "a normalisation" && name != "self-modulation") continue;
      Request request = base;
      request.method = method;
      request.paint = paintOf(method);
      Request without = request;
      feature.ask(request);
      without.passes = request.passes;
      SCOPED_TRACE(name + ", " + method);
      if (refusedBy(request)) continue;
      const Result given = compositor.run(request), plain = compositor.run(without);
      std::size_t changed = 0;
      for (std::size_t i = 0; i < given.picture.rgba.size(); ++i)
        if (given.picture.rgba[i] != plain.picture.rgba[i]) ++changed;
      EXPECT_GT(changed, 0u);
    }
}

}  // namespace
}  // namespace pellucid
