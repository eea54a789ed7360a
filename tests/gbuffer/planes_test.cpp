// OIT planes: every bit through a file, sums that merge, and mismatches refused.
#include "gbuffer/planes_io.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "exr_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"

namespace pellucid::test {
namespace {

OitPlanes somePlanes(unsigned seed) {
  OitPlanes planes = emptyPlanes({0, 0, 20, 10}, {-3, 2, 14, 11});
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> d(0.0f, 10.0f);
  for (Image<glm::vec4>* image : {&planes.radiance, &planes.weight, &planes.opacity, &planes.depth, &planes.light})
    for (std::size_t i = 0; i < image->size(); ++i) (*image)[i] = glm::vec4(d(random), d(random), d(random), d(random));
  for (std::size_t i = 0; i < planes.light.size(); ++i) planes.light[i].a = 0.0f;  // unused
  planes.radiance[3] = glm::vec4(1e-40f, -0.0f, std::numeric_limits<float>::max(), 1e-30f);
  for (std::size_t i = 0; i < planes.frontZ.size(); i += 2) {
    planes.frontZ[i] = 0.5f + d(random);
    planes.solid[i] = glm::vec4(d(random), d(random), d(random), 1.0f + d(random));
  }
  planes.info.method = "weighted";
  planes.info.weight = {shading::PLD_WEIGHT_POWER, 0.1f, 333.3333f, 1.0f / 3.0f, 1.0f};
  planes.info.solidHash = "0123abcd";
  planes.camera.viewFromWorld[3] = glm::dvec4(1.0 / 3.0, -2e7 / 7.0, 1e-9, 1.0);
  planes.camera.focal = {16.0 / 9.0, 3.1};
  planes.camera.rangeFar = 1e6 / 3.0;
  planes.camera.origin = "glTF node cam";
  return planes;
}

template <class T>
bool sameBits(const Image<T>& a, const Image<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Planes, RoundTripKeepsEveryBit) {
  TemporaryFolder folder;
  for (const int kind :
       {shading::PLD_WEIGHT_EQ5, shading::PLD_WEIGHT_EQ10Z, shading::PLD_WEIGHT_POWER, shading::PLD_WEIGHT_UNIFORM})
    for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED}) {
      OitPlanes planes = somePlanes(1);
      planes.info.weight.kind = kind;
      planes.info.normalisation = normalisation;
      planes.info.solidHash = normalisation ? "" : "ff";
      planes.camera.orthographic = normalisation != 0;
      writePlanes(folder.path("planes.exr"), planes);
      const OitPlanes back = readPlanes(folder.path("planes.exr"));
      EXPECT_TRUE(sameBits(back.radiance, planes.radiance));
      EXPECT_TRUE(sameBits(back.weight, planes.weight));
      EXPECT_TRUE(sameBits(back.opacity, planes.opacity));
      EXPECT_TRUE(sameBits(back.depth, planes.depth));
      EXPECT_TRUE(sameBits(back.light, planes.light));
      EXPECT_TRUE(sameBits(back.frontZ, planes.frontZ));
      EXPECT_TRUE(sameBits(back.solid, planes.solid));
      EXPECT_EQ(back.display, planes.display);
      EXPECT_EQ(back.data, planes.data);
      EXPECT_EQ(back.info.method, "weighted");
      EXPECT_EQ(back.info.normalisation, normalisation);
      EXPECT_EQ(back.info.solidHash, planes.info.solidHash);
      EXPECT_EQ(std::memcmp(&back.info.weight, &planes.info.weight, sizeof planes.info.weight), 0);
      EXPECT_EQ(back.camera.viewFromWorld, planes.camera.viewFromWorld);
      EXPECT_EQ(back.camera.focal, planes.camera.focal);
      EXPECT_EQ(back.camera.rangeFar, planes.camera.rangeFar);
      EXPECT_EQ(back.camera.orthographic, planes.camera.orthographic);
      EXPECT_EQ(back.camera.origin, "glTF node cam");
    }
}

// The names are a contract with other programs.
TEST(Planes, ChannelNames) {
  TemporaryFolder folder;
  const OitPlanes planes = somePlanes(2);
  writePlanes(folder.path("planes.exr"), planes);
  const Contents file = readFile(folder.path("planes.exr"));
  const std::size_t i = 40;
  const std::map<std::string, float> expected = {
      {"oit.A.R", planes.radiance[i].r},  {"oit.A.G", planes.radiance[i].g},  {"oit.A.B", planes.radiance[i].b},
      {"oit.Wz", planes.radiance[i].a},   {"oit.W.R", planes.weight[i].r},    {"oit.W.G", planes.weight[i].g},
      {"oit.W.B", planes.weight[i].b},    {"oit.count", planes.weight[i].a},  {"oit.O.R", planes.opacity[i].r},
      {"oit.O.G", planes.opacity[i].g},   {"oit.O.B", planes.opacity[i].b},   {"oit.Oz", planes.opacity[i].a},
      {"oit.tau.R", planes.depth[i].r},   {"oit.tau.G", planes.depth[i].g},   {"oit.tau.B", planes.depth[i].b},
      {"oit.E.W", planes.depth[i].a},     {"oit.E.R", planes.light[i].r},     {"oit.E.G", planes.light[i].g},
      {"oit.E.B", planes.light[i].b},     {"oit.front.Z", planes.frontZ[i]},  {"oit.solid.R", planes.solid[i].r},
      {"oit.solid.G", planes.solid[i].g}, {"oit.solid.B", planes.solid[i].b}, {"oit.solid.Z", planes.solid[i].a}};
  EXPECT_EQ(file.planes.size(), expected.size());
  for (const auto& [name, value] : expected) {
    ASSERT_TRUE(file.planes.contains("0/" + name)) << name;
    float stored = 0;
    std::memcpy(&stored, file.planes.at("0/" + name).data() + i * 4, 4);
    EXPECT_EQ(stored, value) << name;
  }
  EXPECT_EQ(file.attributes.at("0/pellucid:method"), "string:weighted");
  EXPECT_EQ(file.attributes.at("0/pellucid:normalisation"), "string:spectral");
}

TEST(Planes, MergeAddsAndKeepsTheNearest) {
  OitPlanes a = somePlanes(3);
  const OitPlanes before = a;
  OitPlanes b = somePlanes(4);
  b.solid = a.solid;
  mergePlanes(a, b);
  for (std::size_t i = 0; i < a.radiance.size(); ++i) {
    EXPECT_EQ(a.radiance[i], before.radiance[i] + b.radiance[i]);
    EXPECT_EQ(a.weight[i], before.weight[i] + b.weight[i]);
    EXPECT_EQ(a.opacity[i], before.opacity[i] + b.opacity[i]);
    EXPECT_EQ(a.depth[i], before.depth[i] + b.depth[i]);
    EXPECT_EQ(a.light[i], before.light[i] + b.light[i]);
    EXPECT_EQ(a.frontZ[i], std::min(before.frontZ[i], b.frontZ[i]));
    EXPECT_EQ(a.solid[i], before.solid[i]);
  }
  OitPlanes empty = emptyPlanes(before.display, before.data);
  empty.info = before.info;
  empty.camera = before.camera;
  empty.solid = before.solid;
  mergePlanes(empty, before);
  EXPECT_TRUE(sameBits(empty.frontZ, before.frontZ)) << "empty planes change nothing";
  EXPECT_EQ(empty.radiance[9], before.radiance[9]);
}

TEST(Planes, ScatterPlanesAreThereOnlyWhereSomethingScatters) {
  TemporaryFolder folder;
  OitPlanes planes = somePlanes(8);
  writePlanes(folder.path("still.exr"), planes);
  EXPECT_FALSE(readPlanes(folder.path("still.exr")).scatters());
  addScatterPlanes(planes);
  EXPECT_EQ(planes.diffuseZ[5], std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < planes.refraction.size(); ++i) {
    planes.refraction[i] = planes.weight[i] * glm::vec4(-1.0f, 1.0f, 0.5f, 3.0f);
    planes.diffuseZ[i] = planes.frontZ[i];
    planes.light[i].a = planes.depth[i].r;
  }
  writePlanes(folder.path("scatters.exr"), planes);
  const OitPlanes back = readPlanes(folder.path("scatters.exr"));
  EXPECT_TRUE(sameBits(back.refraction, planes.refraction));
  EXPECT_TRUE(sameBits(back.diffuseZ, planes.diffuseZ));
  EXPECT_TRUE(sameBits(back.light, planes.light));

  OitPlanes sum = somePlanes(8);  // lacks them
  mergePlanes(sum, planes);
  EXPECT_TRUE(sameBits(sum.refraction, planes.refraction));
  mergePlanes(sum, planes);
  EXPECT_EQ(sum.refraction[11], 2.0f * planes.refraction[11]);
  EXPECT_EQ(sum.diffuseZ[11], planes.diffuseZ[11]);
}

TEST(Planes, MismatchesAreRefused) {
  const OitPlanes a = somePlanes(5);
  const auto refused = [&](auto change) -> std::string {
    OitPlanes to = a, from = a;
    change(from);
    try {
      mergePlanes(to, from);
    } catch (const MeaningError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused([](OitPlanes&) {}), "");
  EXPECT_NE(refused([](OitPlanes& p) { p.info.method = "average"; }).find("average"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.info.weight.rangeFar = 2.0f; }).find("weight"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.info.weight.kind = shading::PLD_WEIGHT_EQ8; }).find("eq8"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.info.normalisation = shading::PLD_NORMALISE_PUBLISHED; }), "");
  EXPECT_NE(refused([](OitPlanes& p) { p.info.tier = "exact"; }).find("exact"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.info.solidHash = "other"; }).find("solid"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.camera.focal.x *= 1.001; }).find("camera"), std::string::npos);
  EXPECT_NE(refused([](OitPlanes& p) { p.data = {0, 0, 17, 9}; }).find("data window"), std::string::npos);
}

TEST(Planes, OtherFilesAreRefused) {
  TemporaryFolder folder;
  Part part;
  part.planes = {constantPlane("R", exr::FLOAT, 1, 48)};
  writeFile(folder.path("picture.exr"), {part});
  EXPECT_THROW(readPlanes(folder.path("picture.exr")), MeaningError);
  EXPECT_THROW(readPlanes(folder.path("none.exr")), InputError);

  OitPlanes planes = somePlanes(6);
  writePlanes(folder.path("planes.exr"), planes);
  const ExrDocument document = readExr(folder.path("planes.exr"));
  for (const auto& [attribute, value] : std::map<std::string, std::string>{{"pellucid:weight", "eq99 1 2 3"},
                                                                           {"pellucid:weight", "eq5 1 2"},
                                                                           {"pellucid:weight", "power 1 2 3 0"},
                                                                           {"pellucid:camera", "1 2 3"},
                                                                           {"pellucid:normalisation", "both"}}) {
    std::map<int, ExrPartEdit> edits;
    edits[0].attributes[attribute] = value;
    writeExr(folder.path("bad.exr"), document, edits);
    EXPECT_THROW(readPlanes(folder.path("bad.exr")), MeaningError) << attribute;
  }
  planes.depth[7].g = std::numeric_limits<float>::infinity();
  writePlanes(folder.path("infinite.exr"), planes);
  try {
    readPlanes(folder.path("infinite.exr"));
    FAIL() << "an infinite sum was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("oit.tau.G: found inf at pixel (4, 2)"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pellucid::test
