// accumulate, then resolve, is composite --method phenomenological, bit for bit: the picture stops at a file and goes
// on.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "gbuffer/errors.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class TwoSteps : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-two-steps");
    files = writeShotFiles(folder);
  }
  Image<glm::vec4> inTwoSteps(const Request& request, std::vector<std::string> planes = {}) const {
    if (planes.empty()) {
      planes = {folder + "/planes.exr"};
      accumulate(request, planes[0]);
    }
    PlanesRequest resolve;
    resolve.opaque = request.shot.opaque;
    resolve.planes = planes;
    Journal journal;
    return resolvePlanes(resolve, journal).picture.rgba;
  }
  static void accumulate(const Request& request, const std::string& path) {
    Compositor compositor(request);
    std::vector<PassPlanes> passes;
    compositor.accumulate(request, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
    writePasses(path, passes);
  }
  static Image<glm::vec4> atOnce(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture.rgba;
  }
  ShotFiles files;
  std::string folder;
};

std::size_t differing(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) ++count;
  return count;
}

struct Route {
  const char* name;
  void (*ask)(Request& request);
};
const Route kRoutes[] = {
    {"plain", [](Request&) {}},
    {"four passes", [](Request& r) { r.passes = 4; }},
    {"exact", [](Request& r) { r.tier = Tier::exact; }},
    {"published", [](Request& r) { r.tier = Tier::published; }},
    {"shadows by rays", [](Request& r) { r.shadows.source = ShadowSource::rays; }},
    {"shadows by maps",
     [](Request& r) {
       r.shadows.source = ShadowSource::maps;
       r.shadows.size = 256;
     }},
    {"fog",
     [](Request& r) {
       r.fog.text = FogText();
       r.fog.text->medium.density = 0.05;
       r.fog.text->hasDensity = true;
     }},
    {"low resolution",
     [](Request& r) {
       r.shot.scene.overrides = {"smoke.lowResolution=true"};
       r.lowResolution.factor = 4;
     }},
    {"a shutter", openShutter},
    {"a lens", openLens},
    {"fitted weight", [](Request& r) { r.sums.fitWeight = true; }},
    {"deep layers", [](Request&) {}},  // the files are the test's
};

// Two ways at once: all of them with each other.
std::vector<std::pair<std::string, Request>> pairsOfWays(const ShotFiles& files, const std::string& opaque) {
  std::vector<std::pair<std::string, Request>> pairs;
  for (const Route& first : kRoutes)
    for (const Route& second : kRoutes) {
      const auto shadows = [](const Route& way) { return std::string(way.name).find("shadows") != std::string::npos; };
      if (&first != &second && shadows(first) && shadows(second)) continue;  // by rays or by maps
      Request request = requestOf(opaque, files.scene);
      for (const Route* way : {&first, &second}) {
        if (std::string(way->name) == "deep layers")
          request.shot.inputs = {files.scene, files.deepLayers};
        else
          way->ask(request);
      }
      pairs.emplace_back(std::string(first.name) + ", " + second.name, request);
    }
  return pairs;
}

TEST_F(TwoSteps, GiveTheBitsOfComposite) {
  for (const auto& [names, request] : pairsOfWays(files, files.flat))
    EXPECT_EQ(differing(inTwoSteps(request), atOnce(request)), 0u) << names;
}

// Planes of a deep picture are those of its places: each sample, and what shows beyond, has sums of its own.
TEST_F(TwoSteps, OverADeepPictureGiveTheBitsOfComposite) {
  for (const auto& [names, request] : pairsOfWays(files, files.deepPicture))
    EXPECT_EQ(differing(inTwoSteps(request), atOnce(request)), 0u) << names;
}

TEST_F(TwoSteps, PlanesOfPlacesBelongToTheirPicture) {
  const Request request = requestOf(files.deepPicture, files.scene);
  const std::string planes = folder + "/places.exr";
  accumulate(request, planes);
  for (const std::string& other : {files.flat, files.deepWall}) {
    Request elsewhere = request;
    elsewhere.shot.opaque = other;
    EXPECT_THROW(inTwoSteps(elsewhere, {planes}), MeaningError) << other;
  }
  EXPECT_EQ(differing(inTwoSteps(request, {planes}), atOnce(request)), 0u);
  Request apart = request, before = request, applied = request;
  apart.foliage.rule = FoliageRule::apart;
  before.heldOutBy = {planes};
  applied.shadows.source = ShadowSource::rays;
  applied.shadows.apply = true;
  for (const Request& each : {apart, before, applied}) EXPECT_THROW(accumulate(each, folder + "/x.exr"), MeaningError);
}

// composite adds sum and average in doubles, planes hold floats.
TEST_F(TwoSteps, OtherMethodsThatAreSumsAreThoseOfComposite) {
  for (const std::string& opaque : {files.flat, files.deepPicture})
    for (const Route& way : kRoutes) {
      if (std::string(way.name) == "published") continue;  // its targets hold the phenomenological sums alone
      for (const char* method : {"sum", "average", "weighted", "blended"}) {
        if (std::string(way.name) == "fitted weight" && std::string(method) != "weighted") continue;
        Request request = requestOf(opaque, files.scene);
        request.method = method;
        request.paint = paintOf(method);
        way.ask(request);
        if (std::string(way.name) == "deep layers") request.shot.inputs = {files.scene, files.deepLayers};
        const Image<glm::vec4> two = inTwoSteps(request), one = atOnce(request);
        double largest = 0.0;
        for (std::size_t i = 0; i < two.size(); ++i)
          for (int c = 0; c < 4; ++c)
            largest = std::max(largest, std::abs(static_cast<double>(two[i][c]) - static_cast<double>(one[i][c])));
        EXPECT_LE(largest, 2e-6) << opaque << ", " << way.name << ", " << method;
      }
    }
}

TEST_F(TwoSteps, PlanesThatHoldEachOtherOutAddUp) {
  const std::string near = folder + "/near.glb", far = folder + "/far.glb", both = folder + "/both.glb";
  const Quad solid{{-1.0f, -1.0f, -4.0f}, {1.2f, 0, 0}, {0, 2, 0}, unlit(0.9f, 0.1f, 0.1f, 1.0f)};
  const Quad pane{{-2.0f, -2.0f, -5.0f}, {4.0f, 0, 0}, {0, 4, 0}, unlit(0.1f, 0.6f, 0.2f, 0.4f)};
  const Quad front{{-0.5f, -0.5f, -3.0f}, {2.0f, 0, 0}, {0, 1, 0}, unlit(0.2f, 0.2f, 0.9f, 0.3f)};
  writeGlb(near, {solid, front});
  writeGlb(far, {pane});
  writeGlb(both, {solid, front, pane});
  for (const int passes : {1, 4}) {
    Request request = requestOf(files.flat, near);
    request.passes = passes;
    request.tier = Tier::exact;
    request.sums.weight = PassSettings().weight;  // of all three: each would be fitted to its own scene
    accumulate(request, folder + "/near.exr");
    request.shot.inputs = {far};
    accumulate(request, folder + "/far-alone.exr");
    EXPECT_THROW(inTwoSteps(request, {folder + "/near.exr", folder + "/far-alone.exr"}), std::runtime_error);
    request.heldOutBy = {folder + "/near.exr"};
    accumulate(request, folder + "/far.exr");
    const Image<glm::vec4> added = inTwoSteps(request, {folder + "/near.exr", folder + "/far.exr"});
    request.heldOutBy.clear();
    request.shot.inputs = {both};
    const Image<glm::vec4> whole = atOnce(request);
    double largest = 0.0;
    for (std::size_t i = 0; i < added.size(); ++i)
      for (int c = 0; c < 4; ++c)
        largest = std::max(largest, std::abs(static_cast<double>(added[i][c]) - static_cast<double>(whole[i][c])));
    EXPECT_LE(largest, 1e-6) << passes;  // sums of two files are rounded once more
  }
}

TEST_F(TwoSteps, PlanesTakeTheWeightOfThoseThatHoldThemOut) {
  const std::string near = folder + "/near.glb", far = folder + "/far.glb";
  std::vector<Quad> nearer, farther;  // each with another weight of its own
  for (int i = 0; i < 4; ++i) {
    const auto f = static_cast<float>(i);
    nearer.push_back({{-1.0f, -1.0f, -2.0f - f}, {2, 0, 0}, {0, 2, 0}, unlit(0.9f - 0.2f * f, 0.1f, 0.1f, 0.6f)});
    farther.push_back({{-3.0f, -3.0f, -6.0f - f}, {6, 0, 0}, {0, 6, 0}, unlit(0.1f, 0.2f * f, 0.1f, 0.2f)});
  }
  writeGlb(near, nearer);
  writeGlb(far, farther);
  Request request = requestOf(files.flat, near);
  const auto weightIn = [&](const std::string& planes) {
    return weightText(readPasses(folder + planes)[0].planes.info.weight);
  };
  accumulate(request, folder + "/near.exr");
  request.shot.inputs = {far};
  accumulate(request, folder + "/far-alone.exr");
  EXPECT_NE(weightIn("/far-alone.exr"), weightIn("/near.exr"));
  // The sentence says what to do.
  try {
    inTwoSteps(request, {folder + "/near.exr", folder + "/far-alone.exr"});
    FAIL() << "planes of two weights were added";
  } catch (const MeaningError& error) {
    EXPECT_NE(std::string(error.what()).find("--weight-from"), std::string::npos) << error.what();
  }
  request.heldOutBy = {folder + "/near.exr"};
  accumulate(request, folder + "/far.exr");
  EXPECT_EQ(weightIn("/far.exr"), weightIn("/near.exr"));
  inTwoSteps(request, {folder + "/near.exr", folder + "/far.exr"});
}

}  // namespace
}  // namespace pellucid
