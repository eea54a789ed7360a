// Any renderer's file to one beauty, one depth, one camera: which channels, what their numbers mean, what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exr_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kPixels = 48;

class OpaqueRead : public testing::Test {
 protected:
  // Channels "name=value"; values are the same in every pixel, and small, so that half keeps them.
  Part part(const std::vector<std::pair<std::string, float>>& channels, exr::PixelType type = exr::HALF) {
    Part made;
    for (const auto& [name, value] : channels) made.planes.push_back(constantPlane(name, type, value, kPixels));
    return made;
  }
  OpaqueFile read(const std::vector<Part>& parts, const ReadOptions& options = {}, const Camera* camera = nullptr) {
    writeFile(folder_.path("shot.exr"), parts);
    return readOpaque(folder_.path("shot.exr"), options, camera);
  }
  template <class Kind>
  std::string refusal(const std::vector<Part>& parts, const ReadOptions& options = {}) {
    try {
      read(parts, options);
    } catch (const Kind& error) {
      return error.what();
    }
    return "";
  }
  static bool noted(const OpaqueFile& file, const std::string& words) {
    for (const std::string& note : file.notes)
      if (note.find(words) != std::string::npos) return true;
    return false;
  }
  TemporaryFolder folder_;
};

struct Names {
  const char* who;
  std::vector<std::string> channels;  // 1, 2, 3, ... in this order
  std::string red, depth;             // "" for depth: refused
};

TEST_F(OpaqueRead, FindsBeautyAndDepthOfEachRenderer) {
  const Names files[] = {
      {"plain", {"R", "G", "B", "A", "Z"}, "R", "Z"},
      {"lower case", {"r", "g", "b", "z"}, "r", "z"},
      {"words", {"red", "green", "blue", "alpha", "depth.Z"}, "red", "depth.Z"},
      {"Blender",
       {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
        "ViewLayer.Denoising Depth.Z", "ViewLayer.Depth.Z", "ViewLayer.Normal.X", "ViewLayer.Normal.Y",
        "ViewLayer.Normal.Z", "ViewLayer.Position.X", "ViewLayer.Position.Y", "ViewLayer.Position.Z",
        "ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B", "ViewLayer.Mist.Z",
        "ViewLayer.CryptoObject00.r", "ViewLayer.CryptoObject00.g", "ViewLayer.CryptoObject00.b"},
       "ViewLayer.Combined.R",
       "ViewLayer.Depth.Z"},
      {"Arnold",
       {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "RGBA_key.R", "RGBA_key.G", "RGBA_key.B"},
       "R",
       "Z"},
      {"V-Ray", {"R", "G", "B", "A", "VRayZDepth.R", "VRayZDepth.G", "VRayZDepth.B"}, "R", "VRayZDepth.R"},
      {"V-Ray single", {"R", "G", "B", "VRayZDepth"}, "R", "VRayZDepth"},
      {"Karma",
       {"C.R", "C.G", "C.B", "C.A", "hitPz", "directdiffuse.R", "directdiffuse.G", "directdiffuse.B"},
       "C.R",
       "hitPz"},
      {"RenderMan", {"Ci.r", "Ci.g", "Ci.b", "z", "Nn.x", "Nn.y", "Nn.z"}, "Ci.r", "z"},
      {"Unreal",
       {"FinalImageMovieRenderQueue_FinalImage.R", "FinalImageMovieRenderQueue_FinalImage.G",
        "FinalImageMovieRenderQueue_FinalImage.B", "FinalImageMovieRenderQueue_FinalImage.A",
        "FinalImageMovieRenderQueue_WorldDepth.R", "FinalImageMovieRenderQueue_WorldDepth.G",
        "FinalImageMovieRenderQueue_WorldDepth.B", "ActorHitProxyMask00.R", "ActorHitProxyMask00.G",
        "ActorHitProxyMask00.B"},
       "FinalImageMovieRenderQueue_FinalImage.R",
       "FinalImageMovieRenderQueue_WorldDepth.R"},
      {"beauty layer",
       {"beauty.R", "beauty.G", "beauty.B", "depth.Z", "albedo.R", "albedo.G", "albedo.B"},
       "beauty.R",
       "depth.Z"},
      {"unknown single layer", {"shot.R", "shot.G", "shot.B", "Z"}, "shot.R", "Z"},
      {"vectors only", {"R", "G", "B", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"}, "R", ""},
      {"root vector", {"R", "G", "B", "X", "Y", "Z"}, "R", ""},
      {"other depths", {"R", "G", "B", "Normal.Z", "Position.Z", "Denoising Depth.Z", "Vector.Z"}, "R", ""},
  };
  for (const Names& names : files) {
    SCOPED_TRACE(names.who);
    std::vector<std::pair<std::string, float>> channels;
    for (const std::string& name : names.channels) channels.emplace_back(name, static_cast<float>(channels.size() + 1));
    if (names.depth.empty()) {
      const std::string sentence = refusal<MeaningError>({part(channels)});
      EXPECT_NE(sentence.find("no depth: found"), std::string::npos) << sentence;
      EXPECT_NE(sentence.find("--depth"), std::string::npos) << sentence;
      continue;
    }
    ReadOptions named;  // of one value everywhere no picture tells what it means
    named.depthKind = "planar";
    named.metresPerUnit = 1.0;
    const OpaqueFile file = read({part(channels)}, named);
    EXPECT_EQ(file.choice.beautyChannel[0], names.red);
    EXPECT_EQ(file.choice.depthChannel, names.depth);
    for (std::size_t i = 0; i < names.channels.size(); ++i) {
      const auto value = static_cast<float>(i + 1);
      if (names.channels[i] == names.red) {
        EXPECT_EQ(file.gbuffer.beauty.at(3, 2).r, value);
      }
      if (names.channels[i] == names.depth) {
        EXPECT_EQ(file.gbuffer.viewZ.at(3, 2), value);
      }
    }
    EXPECT_EQ(file.gbuffer.hasAlpha, !file.choice.beautyChannel[3].empty());
    if (!file.gbuffer.hasAlpha) {
      EXPECT_EQ(file.gbuffer.beauty.at(0, 0).a, 1.0f);
    }
  }
}

TEST_F(OpaqueRead, TwoCandidatesAreRefusedByName) {
  const Part twoDepths = part({{"R", 1}, {"G", 2}, {"B", 3}, {"Z", 4}, {"depth.Z", 5}});
  const std::string depths = refusal<MeaningError>({twoDepths});
  EXPECT_NE(depths.find("found Z and depth.Z"), std::string::npos) << depths;
  EXPECT_NE(depths.find("--depth"), std::string::npos);
  ReadOptions options;
  options.depthChannel = "depth.Z";
  EXPECT_EQ(read({twoDepths}, options).gbuffer.viewZ.at(0, 0), 5.0f);
  options.depthChannel = "nothing.Z";
  EXPECT_NE(refusal<MeaningError>({twoDepths}, options).find("nothing.Z"), std::string::npos);

  const Part twoLayers = part({{"a.Combined.R", 1},
                               {"a.Combined.G", 2},
                               {"a.Combined.B", 3},
                               {"a.Depth.Z", 4},
                               {"b.Combined.R", 5},
                               {"b.Combined.G", 6},
                               {"b.Combined.B", 7},
                               {"b.Depth.Z", 8}});
  const std::string beauties = refusal<MeaningError>({twoLayers});
  EXPECT_NE(beauties.find("found a.Combined and b.Combined"), std::string::npos) << beauties;
  EXPECT_NE(beauties.find("--beauty"), std::string::npos);
  options = {};
  options.beautyLayer = "b.Combined";
  const OpaqueFile second = read({twoLayers}, options);
  EXPECT_EQ(second.gbuffer.beauty.at(0, 0).r, 5.0f);
  EXPECT_EQ(second.gbuffer.viewZ.at(0, 0), 8.0f) << "depth of the same view layer";
  options.beautyLayer = "c";
  EXPECT_NE(refusal<MeaningError>({twoLayers}, options).find("'c'"), std::string::npos);
}

TEST_F(OpaqueRead, BlendersCompositeGivesWayToTheViewLayer) {
  Part layers = part({{"Composite.Combined.R", 1},
                      {"Composite.Combined.G", 1},
                      {"Composite.Combined.B", 1},
                      {"ViewLayer.Combined.R", 2},
                      {"ViewLayer.Combined.G", 2},
                      {"ViewLayer.Combined.B", 2},
                      {"ViewLayer.Depth.Z", 3}});
  EXPECT_NE(refusal<MeaningError>({layers}), "");
  ReadOptions blender;
  blender.preset = "blender";
  EXPECT_EQ(read({layers}, blender).gbuffer.beauty.at(0, 0).r, 2.0f);
  layers.strings["BlenderMultiChannel"] = "Blender V2.55.1 and newer";
  EXPECT_EQ(read({layers}).gbuffer.beauty.at(0, 0).r, 2.0f);
  blender.preset = "paint";
  EXPECT_NE(refusal<UsageError>({layers}, blender), "");
}

TEST_F(OpaqueRead, PartNamesAreLayersAndViewsArePicked) {
  Part colour = part({{"R", 1}, {"G", 2}, {"B", 3}, {"A", 1}}), depth = part({{"Z", 4}}),
       other = part({{"X", 5}, {"Y", 6}, {"Z", 7}});
  colour.name = "rgba";
  depth.name = "depth";
  other.name = "N";
  depth.data = {2, 1, 6, 5};  // its own data window
  depth.planes = {constantPlane("Z", exr::HALF, 4, 16)};
  const OpaqueFile file = read({colour, depth, other});
  EXPECT_EQ(file.choice.depthPart, 1);
  EXPECT_EQ(file.gbuffer.viewZ.at(2, 1), 4.0f);
  EXPECT_EQ(file.gbuffer.viewZ.at(5, 4), 4.0f);
  EXPECT_EQ(file.gbuffer.viewZ.at(1, 1), kInf) << "outside the depth's data window nothing was hit";
  EXPECT_EQ(file.gbuffer.viewZ.at(6, 4), kInf);
  EXPECT_FALSE(file.gbuffer.normal.empty());

  std::vector<Part> stereo;
  for (const char* view : {"right", "left"}) {
    Part c = colour, d = part({{"Z", view[0] == 'r' ? 8.0f : 9.0f}});
    c.view = d.view = view;
    c.name = std::string("rgba_") + view;
    d.name = std::string("depth_") + view;
    stereo.insert(stereo.begin(), d);  // depth of the left comes first
    stereo.push_back(c);
  }
  const OpaqueFile left = read(stereo);  // the first part's view
  EXPECT_EQ(left.gbuffer.viewZ.at(0, 0), 9.0f);
  EXPECT_TRUE(noted(left, "view left"));
  ReadOptions options;
  options.beautyLayer = "right";
  EXPECT_EQ(read(stereo, options).gbuffer.viewZ.at(0, 0), 8.0f);
}

TEST_F(OpaqueRead, PartsThatAreNumberedHaveNoNames) {
  for (const std::string front : {"subimage0", "part"}) {
    Part colour = part({{"R", 1}, {"G", 2}, {"B", 3}, {"A", 1}}), depth = part({{"Z", 4}}),
         normal = part({{"N.X", 0}, {"N.Y", 0}, {"N.Z", 1}});
    colour.name = front + "0";
    depth.name = front + "1";
    normal.name = front + "2";
    const OpaqueFile file = read({colour, depth, normal});
    EXPECT_EQ(file.choice.beautyPart, 0);
    EXPECT_EQ(file.choice.depthPart, 1);
    EXPECT_EQ(file.gbuffer.viewZ.at(0, 0), 4.0f);
    EXPECT_FALSE(file.gbuffer.normal.empty());
  }
}

TEST_F(OpaqueRead, LuminanceChromaIsRefused) {
  EXPECT_NE(refusal<InputError>({part({{"Y", 1}, {"Z", 2}})}).find("luminance-chroma"), std::string::npos);
  EXPECT_NE(refusal<MeaningError>({part({{"Z", 2}})}).find("no colour"), std::string::npos);
}

TEST_F(OpaqueRead, DepthKindsBecomePlanarMetres) {
  Camera camera;
  camera.focal = {2.0, 3.0};
  camera.centre = {0.1, -0.2};
  camera.rangeNear = 0.5;
  camera.rangeFar = 50.0;
  Part colour = part({{"R", 1}, {"G", 1}, {"B", 1}}, exr::FLOAT);
  const double truth = 7.25;
  for (const std::string kind : {"planar", "ray", "inverse", "device"}) {
    SCOPED_TRACE(kind);
    std::vector<float> values;
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        const double a = ((x + 0.5) / 4.0 - 1.0 - camera.centre.x) / camera.focal.x;
        const double b = (1.0 - (y + 0.5) / 3.0 - camera.centre.y) / camera.focal.y;
        const double n = camera.rangeNear, f = camera.rangeFar;
        values.push_back(static_cast<float>(kind == "planar"    ? truth
                                            : kind == "ray"     ? truth * std::sqrt(1.0 + a * a + b * b)
                                            : kind == "inverse" ? 1.0 / truth
                                                                : f * (truth - n) / (truth * (f - n))));
      }
    Part whole = colour;
    whole.planes.push_back(floatPlane("Z", values));
    ReadOptions options;
    options.depthKind = kind;
    const OpaqueFile file = read({whole}, options, &camera);
    // A window depth near 1 spreads half an ulp of 6e-8 over z/near times as much.
    const double tolerance = kind == "device" ? 2e-6 : 3e-7;
    for (std::size_t i = 0; i < kPixels; ++i)
      EXPECT_NEAR(static_cast<double>(file.gbuffer.viewZ[i]) / truth, 1.0, tolerance);
    if (kind == "ray" || kind == "device") {
      EXPECT_NE(refusal<MeaningError>({whole}, options).find("no camera"), std::string::npos);
    }
    if (kind == "device") {
      camera.rangeNear = 0;
      EXPECT_THROW(read({whole}, options, &camera), MeaningError);
    } else {
      options.metresPerUnit = 0.01;
      EXPECT_NEAR(static_cast<double>(read({whole}, options, &camera).gbuffer.viewZ[9]) / truth, 0.01, 1e-8);
    }
  }
  ReadOptions unknown;
  unknown.depthKind = "radial";
  EXPECT_NE(refusal<UsageError>({part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 1}})}, unknown).find("radial"),
            std::string::npos);
}

TEST_F(OpaqueRead, NothingHitIsInfinite) {
  std::vector<float> values(kPixels, 5.0f);
  const float none[] = {kInf, -kInf, kNan, 0.0f, -1.0f, 1e9f, 1e10f, 3e38f};
  std::copy(std::begin(none), std::end(none), values.begin());
  values[10] = 9.9e8f;
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}}, exr::FLOAT);
  whole.planes.push_back(floatPlane("Z", values));
  const OpaqueFile file = read({whole});
  for (std::size_t i = 0; i < std::size(none); ++i) EXPECT_EQ(file.gbuffer.viewZ[i], kInf) << none[i];
  EXPECT_EQ(file.gbuffer.viewZ[10], 9.9e8f);
  EXPECT_EQ(file.choice.farPixels, std::size(none));
  EXPECT_EQ(file.choice.nonFiniteDepth, 2u) << "infinity is a far value, NaN and -infinity are not";
  EXPECT_TRUE(noted(file, "first at (1, 0)"));
  EXPECT_EQ(file.gbuffer.depthPrecision, 0x1p-20f);
  ReadOptions options;
  options.farValue = 5.0;
  EXPECT_EQ(read({whole}, options).choice.farPixels, kPixels);

  Part half = part({{"R", 1}, {"G", 1}, {"B", 1}});
  half.planes.push_back(halfPlane("Z", std::vector<float>(kPixels, 65504.0f)));
  const OpaqueFile halves = read({half});
  EXPECT_EQ(halves.choice.farPixels, kPixels) << "the largest half stands for anything beyond";
  EXPECT_EQ(halves.gbuffer.depthPrecision, 0x1p-10f);
  EXPECT_TRUE(noted(halves, "half"));
}

TEST_F(OpaqueRead, NonFiniteColourIsCountedAndKept) {
  Part whole = part({{"G", 1}, {"B", 1}, {"Z", 1}}, exr::FLOAT);
  whole.data = {-3, 10, 5, 16};
  std::vector<float> red(kPixels, 1.0f);
  red[17] = kNan;
  red[30] = kInf;
  whole.planes.push_back(floatPlane("R", red));
  const OpaqueFile file = read({whole});
  EXPECT_EQ(file.choice.nonFiniteColour, 2u);
  EXPECT_TRUE(noted(file, "2 pixels are not finite, first at (-2, 12)")) << "in the display window's coordinates";
  EXPECT_TRUE(std::isnan(file.gbuffer.beauty[17].r));
}

TEST_F(OpaqueRead, NormalsAreUnitAndOcclusionIsBounded) {
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 1}}, exr::FLOAT);
  std::vector<float> x(kPixels, 0.6f), y(kPixels, 0.0f), z(kPixels, 0.6f), ao(kPixels, 0.25f);
  x[1] = 0.1f, z[1] = 0.2f;  // averaged away
  x[2] = kNan;
  ao[3] = 2.0f, ao[4] = -1.0f, ao[5] = kNan;
  whole.planes.insert(whole.planes.end(),
                      {floatPlane("N.X", x), floatPlane("N.Y", y), floatPlane("N.Z", z), floatPlane("AO", ao)});
  const GBuffer gbuffer = read({whole}).gbuffer;
  EXPECT_NEAR(static_cast<double>(gbuffer.normal[0].x), std::sqrt(0.5), 1e-7);
  EXPECT_EQ(gbuffer.normal[1], glm::vec3(0.0f));
  EXPECT_EQ(gbuffer.normal[2], glm::vec3(0.0f));
  const float expected[] = {0.25f, 0.25f, 0.25f, 1.0f, 0.0f, 1.0f};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(gbuffer.occlusion[i], expected[i]);

  ReadOptions blender;
  blender.preset = "blender";
  const GBuffer turned = read({whole}, blender).gbuffer;
  EXPECT_NEAR(static_cast<double>(turned.normal[0].y), std::sqrt(0.5), 1e-7) << "z-up becomes y-up";
  EXPECT_EQ(turned.normal[0].z, 0.0f);
}

TEST_F(OpaqueRead, DataThroughLossyCompressionIsNoted) {
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}, {"WorldDepth.R", 1}});
  EXPECT_FALSE(noted(read({whole}), "compression"));
  whole.compression = exr::DWAA_COMPRESSION;
  EXPECT_TRUE(noted(read({whole}), "dwaa"));
  Part exact = part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 1}});
  exact.compression = exr::DWAA_COMPRESSION;
  EXPECT_FALSE(noted(read({exact}), "dwaa")) << "DWA keeps channels named Z";
  exact.compression = exr::B44_COMPRESSION;
  EXPECT_TRUE(noted(read({exact}), "b44"));
}

TEST_F(OpaqueRead, CameraAttributesAreReadAndScaled) {
  Camera camera;
  camera.viewFromWorld[3] = glm::dvec4(10, 20, -300, 1);
  camera.focal = {1.5, 2.5};
  float matrices[2][4][4];
  cameraToExr(camera, matrices[0], matrices[1]);
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 100}});
  whole.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
  ReadOptions centimetres;
  centimetres.metresPerUnit = 0.01;
  EXPECT_FALSE(read({whole}).gbuffer.camera.has_value());
  EXPECT_TRUE(noted(read({whole}), "worldToNDC"));
  whole.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
  const OpaqueFile file = read({whole}, centimetres);
  ASSERT_TRUE(file.gbuffer.camera.has_value());
  EXPECT_NEAR(file.gbuffer.camera->viewFromWorld[3].z, -3.0, 1e-6);
  EXPECT_NEAR(file.gbuffer.camera->focal.y, 2.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(file.gbuffer.viewZ[0]), 1.0, 1e-6);
  whole.matrices["worldToNDC"][3] = 5.0f;  // contradicts worldToCamera
  const OpaqueFile broken = read({whole});
  EXPECT_FALSE(broken.gbuffer.camera.has_value());
  EXPECT_TRUE(noted(broken, "worldToNDC: found"));
}

TEST_F(OpaqueRead, AttributesOfOtherTypesAreNoted) {
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 100}});
  whole.strings["worldToCamera"] = whole.strings["worldToNDC"] = "1 0 0 0";
  const OpaqueFile file = read({whole});
  EXPECT_FALSE(file.gbuffer.camera.has_value());
  EXPECT_TRUE(noted(file, "found string of 7 bytes, expected m44f"));
  EXPECT_FALSE(file.cameraRefusal.empty());
  whole.strings = {{"chromaticities", "0.64 0.33"}};
  EXPECT_TRUE(noted(read({whole}), "attribute chromaticities: found string of 9 bytes"));
}

// Pixels stand in the order of the names: a name that is changed in place would give each channel another's.
TEST_F(OpaqueRead, ChannelsOutOfOrderAreRefused) {
  writeFile(folder_.path("shot.exr"), {part({{"B", 1}, {"G", 2}, {"R", 3}, {"Z", 4}})});
  std::string bytes = slurp(folder_.path("shot.exr"));
  const std::size_t at = bytes.find(std::string("G\0", 2), bytes.find("chlist"));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'T';
  spit(folder_.path("shot.exr"), bytes);
  try {
    readOpaque(folder_.path("shot.exr"), {});
    FAIL() << "it was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("found channel R after T"), std::string::npos) << error.what();
  }
}

TEST_F(OpaqueRead, MipMapsAreRefused) {
  Part whole = part({{"R", 1}, {"G", 1}, {"B", 1}, {"Z", 1}});
  whole.tileSize = 8;
  whole.levels = exr::MIPMAP_LEVELS;
  EXPECT_NE(refusal<InputError>({whole}).find("mip map"), std::string::npos);
}

TEST(Assets, BlenderFileIsUnderstood) {
  if (assets().empty()) GTEST_SKIP() << "no shared assets";
  const OpaqueFile file = readOpaque(assets() + "/blender/gbuffer.exr", {});
  EXPECT_EQ(file.choice.beautyChannel[3], "ViewLayer.Combined.A");
  EXPECT_EQ(file.choice.depthChannel, "ViewLayer.Depth.Z");
  EXPECT_GT(file.choice.farPixels, 0u);
  EXPECT_LT(file.choice.farPixels, file.gbuffer.viewZ.size());
  EXPECT_FALSE(file.gbuffer.normal.empty());
  EXPECT_FALSE(file.gbuffer.occlusion.empty());
}

}  // namespace
}  // namespace pellucid::test
