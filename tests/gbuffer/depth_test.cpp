// Depth as it is stored: every kind to planar metres, what is said of it, and what is warned of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "room.h"

namespace pellucid::test {
namespace {

bool noted(const OpaqueFile& file, const std::string& words) {
  for (const std::string& note : file.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

class DepthKinds : public testing::Test {
 protected:
  template <class F>
  OpaqueFile read(F of, const ReadOptions& options = {}, bool withCamera = true) {
    Part part = room_.part(withCamera);
    part.planes.push_back(floatPlane("Z", room_.depth(of)));
    writeFile(folder_.path("shot.exr"), {part});
    return readOpaque(folder_.path("shot.exr"), options);
  }
  double worst(const OpaqueFile& file) const {
    double most = 0;
    for (std::size_t i = 0; i < room_.z.size(); ++i)
      most = std::max(most, std::abs(static_cast<double>(file.gbuffer.viewZ[i]) / room_.z[i] - 1));
    return most;
  }
  Room room_;
  TemporaryFolder folder_;
};

TEST_F(DepthKinds, EachBecomesPlanarMetres) {
  const auto kind = [](const char* text, double unit = 1) {
    ReadOptions options;
    options.depthKind = text;
    options.metresPerUnit = unit;
    return options;
  };
  EXPECT_LT(worst(read([](double z, double) { return -z; }, kind("negative"))), 1e-6);
  EXPECT_LT(worst(read([](double z, double) { return (z - .5) / 39.5; }, kind("normalised:0.5:40"))), 1e-5);
  EXPECT_LT(worst(read([](double z, double) { return 1 - (z - .5) / 39.5; }, kind("normalised:0.5:40:inverted"))),
            1e-5);
  EXPECT_LT(worst(read([](double z, double) { return (100 * z - 50) / 3950; }, kind("normalised:50:4000", .01))), 1e-5);
  ReadOptions device = kind("device:reversed");
  Camera camera = room_.camera;
  camera.rangeNear = 0.5;
  camera.rangeFar = 100;
  Part part = room_.part(false);
  part.planes.push_back(floatPlane("Z", room_.depth([](double z, double) { return (.5 * 100 / z - .5) / 99.5; })));
  writeFile(folder_.path("shot.exr"), {part});
  EXPECT_LT(worst(readOpaque(folder_.path("shot.exr"), device, &camera)), 1e-5);
}

// glTF's word for a projection that ends nowhere, which engines with reversed depth draw by.
TEST_F(DepthKinds, AClipRangeWithoutAnEndIsRead) {
  Camera camera = room_.camera;
  camera.rangeNear = 0.5;
  camera.rangeFar = 0;
  for (const bool reversed : {true, false}) {
    ReadOptions device;
    device.depthKind = reversed ? "device:reversed" : "device";
    Part part = room_.part(false);
    part.planes.push_back(
        floatPlane("Z", room_.depth([&](double z, double) { return reversed ? .5 / z : 1 - .5 / z; })));
    const std::string path = folder_.path(reversed ? "reversed.exr" : "shot.exr");
    writeFile(path, {part});
    EXPECT_LT(worst(readOpaque(path, device, &camera)), 1e-5);
    camera.orthographic = true;
    EXPECT_THROW(readOpaque(path, device, &camera), MeaningError);
    camera.orthographic = false;
  }
}

// What is allowed for is what a step of the stored numbers moves: much where 1 is near, nothing where 0 is far.
TEST_F(DepthKinds, PrecisionIsThatOfTheStoredNumbers) {
  ReadOptions options;
  const auto ramp = [](double z, double) { return 1 - z / 1000; };
  options.depthKind = "normalised:0:1000:inverted";
  const OpaqueFile inverted = read(ramp, options);
  EXPECT_LT(worst(inverted), static_cast<double>(inverted.gbuffer.depthPrecision));
  EXPECT_LT(inverted.gbuffer.depthPrecision, 1e-4f);
  options.depthKind = "normalised:0:1000";
  EXPECT_EQ(read([](double z, double) { return z / 1000; }, options).gbuffer.depthPrecision, 0x1p-20f);
  Camera camera = room_.camera;
  camera.rangeNear = 1e-4;
  camera.rangeFar = 1e6;
  Part part = room_.part(false);
  part.planes.push_back(floatPlane("Z", room_.depth([](double z, double) { return 1e-4 * (1 / z - 1e-6); })));
  writeFile(folder_.path("reversed.exr"), {part});
  options.depthKind = "device:reversed";
  const OpaqueFile reversed = readOpaque(folder_.path("reversed.exr"), options, &camera);
  EXPECT_EQ(reversed.gbuffer.depthPrecision, 0x1p-20f);
  EXPECT_LT(worst(reversed), 1e-6);
}

// Matrices of floats lose of the camera's place what floats of its distance from the origin lose.
TEST_F(DepthKinds, ACameraFarOffIsAllowedWhatItsMatricesLose) {
  for (const double metres : {0.0, 20.0, 1e5}) {
    Room room;
    room.camera.viewFromWorld[3] = glm::dvec4(0.6 * metres, 0.0, 0.8 * metres, 1.0);
    Part part = room.part(true);
    part.planes.push_back(floatPlane("Z", room.depth([](double z, double) { return z; })));
    const std::string path = folder_.path(std::to_string(metres) + ".exr");
    writeFile(path, {part});
    const OpaqueFile file = readOpaque(path, {});
    std::vector<double> z = room.z;
    std::nth_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2), z.end());
    const double lost = 0x1p-23 * metres / z[z.size() / 2];
    EXPECT_NEAR(static_cast<double>(file.gbuffer.depthPrecision), std::max(lost, 0x1p-20), 1e-3 * lost) << metres;
  }
}

TEST_F(DepthKinds, LimitsOfARampAreNothing) {
  ReadOptions options;
  options.depthKind = "normalised:2:4";
  const GBuffer far = read([](double, double) { return 1.0; }, options).gbuffer;
  EXPECT_FALSE(std::isfinite(far.viewZ[0]));
  EXPECT_EQ(read([](double, double) { return 0.0; }, options).gbuffer.viewZ[0], 2.0f) << "at the near limit";
  options.depthKind = "normalised:2:4:inverted";
  EXPECT_FALSE(std::isfinite(read([](double, double) { return 0.0; }, options).gbuffer.viewZ[0]));
  EXPECT_EQ(read([](double, double) { return 1.0; }, options).gbuffer.viewZ[0], 2.0f);
}

TEST(DepthKindText, IsReadAndWritten) {
  for (const char* text : {"planar", "ray", "inverse", "device", "device:reversed", "negative", "ray:negative",
                           "inverse:negative", "normalised:0:40", "normalised:0.5:40:inverted"})
    EXPECT_EQ(depthKindText(parseDepthKind(text)), text);
  EXPECT_EQ(parseDepthKind("auto").meaning, DepthMeaning::evidence);
  for (const char* text : {"", "radial", "planar:", "planar:1", "device:forward", "planar:negative", "normalised",
                           "normalised:1", "normalised:4:2", "normalised:-1:2", "normalised:1:x",
                           "normalised:1:2:upside", "auto:1", "normalised:1:2:inverted:", "planar|radial"})
    EXPECT_THROW(parseDepthKind(text), UsageError) << text;
}

TEST_F(DepthKinds, WhatWasUnderstoodIsSaid) {
  const std::vector<std::string> lines = understoodLines(read([](double z, double) { return z; }));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].find("picture: R G B"), 0u) << lines[0];
  for (const char* words : {"depth: Z, planar depth (planar), ", " to ", "1 unit is 1 m", "0% of the pixels"})
    EXPECT_NE(lines[1].find(words), std::string::npos) << lines[1];
}

TEST_F(DepthKinds, EvidenceAgainstAReadingIsSaid) {
  const OpaqueFile planar = read([](double z, double) { return z; });
  EXPECT_FALSE(noted(planar, "--depth-kind")) << planar.notes[0];
  EXPECT_TRUE(noted(read([](double z, double ray) { return z * ray; }), "--depth-kind ray?"));
  EXPECT_FALSE(noted(read([](double z, double ray) { return z * ray; }, {}, false), "--depth-kind ray?"));
  EXPECT_TRUE(noted(read([](double z, double) { return 50 / z; }), "--depth-kind inverse?"));
  EXPECT_TRUE(noted(read([](double z, double) { return z / 100; }), "--depth-kind normalised:NEAR:FAR"));
  ReadOptions told;
  told.depthKind = "planar";
  EXPECT_TRUE(read([](double z, double) { return z / 100; }, told).notes.empty()) << "who says so is not warned";
  const OpaqueFile negative = read([](double z, double) { return -z; });
  EXPECT_TRUE(noted(negative, "negative"));
  EXPECT_LT(worst(negative), 1e-6);
}

// Where nothing tells, that is said.
TEST_F(DepthKinds, NoiseHidesRaysAndThatIsSaid) {
  auto noise = [state = 1u](double size) mutable {
    state = state * 1664525u + 1013904223u;
    return 1 + size * (2 * (state / 4294967296.0) - 1);
  };
  for (const double size : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
    const OpaqueFile rays = read([&, noise](double z, double ray) mutable { return z * ray * noise(size); });
    EXPECT_TRUE(noted(rays, "--depth-kind ray")) << size;
    EXPECT_EQ(noted(rays, "do not tell from"), size > 1e-6) << size;
  }
  ReadOptions arnold;
  arnold.preset = "arnold";
  const auto noisy = [&, noise](double z, double) mutable { return z * noise(1e-3); };
  EXPECT_FALSE(noted(read(noisy, arnold), "do not tell")) << "its row says what it writes";
}

// Below 0 the sizes of the numbers are looked at as above it.
TEST_F(DepthKinds, MinusOtherReadings) {
  const auto minusInverse = [](double z, double) { return -50 / z; };
  const auto minusRay = [](double z, double ray) { return -z * ray; };
  const std::pair<const char*, double (*)(double, double)> kinds[] = {{"inverse:negative", minusInverse},
                                                                      {"ray:negative", minusRay}};
  for (const auto& [name, stored] : kinds) {
    try {
      read(stored);
      FAIL() << name << " read as minus planar depth";
    } catch (const MeaningError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("--depth-kind ") + name), std::string::npos) << error.what();
    }
    ReadOptions options;
    options.depthKind = name;
    options.metresPerUnit = name[0] == 'i' ? 50.0 : 1.0;
    EXPECT_LT(worst(read(stored, options)), 1e-6) << name;
    options.depthKind = "auto";
    EXPECT_EQ(read(stored, options).choice.depthKind, name);
  }
  ReadOptions maya;
  maya.preset = "maya";
  EXPECT_EQ(read(minusInverse, maya).choice.depthKind, "inverse:negative");
  EXPECT_EQ(read([](double z, double) { return -z; }, maya).choice.depthKind, "negative");
  EXPECT_THROW(read([](double, double) { return -5.0; }, maya), MeaningError) << "a wall may be either";
}

// What is 1/z on a plane in perspective is z itself along parallel rays.
TEST_F(DepthKinds, EvidenceOfAnOrthographicCamera) {
  room_ = Room::orthographic();
  const auto planar = [](double z, double) { return z; };
  const auto inverse = [](double z, double) { return 50 / z; };
  const OpaqueFile file = read(planar);
  EXPECT_FALSE(noted(file, "--depth-kind")) << file.notes[0];
  EXPECT_LT(worst(file), 1e-6);
  EXPECT_TRUE(noted(read(inverse), "--depth-kind inverse?"));
  ReadOptions open;
  open.depthKind = "auto";
  const OpaqueFile settled = read(planar, open);
  EXPECT_TRUE(noted(settled, "fit no other reading"));
  EXPECT_LT(worst(settled), 1e-6);
  EXPECT_EQ(read(inverse, open).choice.depthKind, "inverse");
  // Without its camera nobody can know.
  EXPECT_TRUE(noted(read(planar, {}, false), "--depth-kind inverse? Not if its camera"));
}

TEST_F(DepthKinds, EnvironmentMapsAreNoPictures) {
  Part part = room_.part(true);
  part.planes.push_back(floatPlane("Z", room_.depth([](double z, double) { return z; })));
  part.environmentMap = 0;
  writeFile(folder_.path("around.exr"), {part});
  try {
    readOpaque(folder_.path("around.exr"), {});
    FAIL() << "a lat-long map has no camera";
  } catch (const MeaningError& error) {
    EXPECT_NE(std::string(error.what()).find("envmap: found a lat-long map"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pellucid::test
