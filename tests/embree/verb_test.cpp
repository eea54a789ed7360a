// `pellucid gbuffer` as a user runs it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/embree/traced_scenes.h"
#include "tests/support/shots.h"

namespace pellucid::test {
namespace {

using nlohmann::json;

// A floor and a wall, lit by a lamp named "lamp.1" and a sun; a glass pane that must not show.
std::string writeRoom(const std::string& folder) {
  const json matt = {{"doubleSided", true},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.8, 0.5, 0.2, 1}}}}};
  json glowing = matt;
  glowing["emissiveFactor"] = {0.1, 0.2, 0.3};
  GlbOptions options;
  options.extra = {
      {"extensionsUsed", {"KHR_materials_unlit", "KHR_lights_punctual"}},
      {"extensions",
       {{"KHR_lights_punctual",
         {{"lights",
           {{{"type", "point"}, {"name", "lamp.1"}, {"intensity", 6830.0}},
            {{"type", "directional"}, {"name", "sun"}, {"intensity", 683.0}}}}}}}},
  };
  const std::vector<Quad> quads{{{-3, -1, -6}, {6, 0, 0}, {0, 0, 5}, matt},
                                {{-3, -1, -6}, {6, 0, 0}, {0, 2.5f, 0}, glowing},
                                {{-0.5f, -0.9f, -4}, {1, 0, 0}, {0, 1, 0}, matt},
                                {{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, 0.5)}};
  // Nodes: four quads, the camera, then the lights.
  json nodes = json::array();
  for (int i = 0; i < 4; ++i) nodes.push_back({{"mesh", i}, {"name", "quad"}});
  nodes.push_back({{"camera", 0}, {"name", "cam"}});
  nodes.push_back(
      {{"name", "a"}, {"translation", {-1, 1, -1.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  nodes.push_back({{"name", "b"},
                   {"rotation", {-0.3826834, 0, 0, 0.9238795}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  options.extra["nodes"] = nodes;
  options.extra["scenes"] = {{{"nodes", {0, 1, 2, 3, 4, 5, 6}}}};
  const std::string path = folder + "/room.glb";
  writeGlb(path, quads, options);
  return path;
}

const ExrChannel& channel(const OpaqueFile& file, const std::string& name) {
  const ExrChannel* found = file.document.parts[0].find(name);
  if (!found) throw std::runtime_error("no channel " + name);
  return *found;
}

TEST(GbufferVerb, PlanesAddUpAndTheCameraIsWritten) {
  const std::string folder = freshFolder("embree_verb");
  const std::string room = writeRoom(folder);
  for (const std::string renderer : {"embree", "gl"}) {
    const std::string out = folder + "/" + renderer + ".exr";
    const Ended ended = runProgram(
        {"gbuffer", room, "-o", out, "--size", "96x64", "--renderer", renderer, "--environment", "0.1,0.2,0.3"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const OpaqueFile file = readOpaque(out, ReadOptions{});
    ASSERT_TRUE(file.gbuffer.camera.has_value());
    const Scene scene = sceneOf(room);
    const Camera expected = cameraIn(scene, {0, 0, 96, 64});
    for (const glm::dvec3 point : {glm::dvec3(-1, 0.5, -3), glm::dvec3(2, -1, -6)}) {
      const glm::dvec2 a = project(*file.gbuffer.camera, file.gbuffer.display, point).pixel;
      EXPECT_LE(glm::length(a - project(expected, {0, 0, 96, 64}, point).pixel), 1e-3);
    }
    std::size_t sky = 0, lit = 0, occluded = 0;
    for (std::size_t i = 0; i < file.gbuffer.viewZ.size(); ++i) {
      const bool hit = std::isfinite(file.gbuffer.viewZ[i]);
      sky += hit ? 0 : 1;
      EXPECT_EQ(file.gbuffer.beauty[i].a, 1.0f);
      // The pane in front, at z = 2, belongs to the transparent pass.
      EXPECT_GT(file.gbuffer.viewZ[i], 2.01f);
      if (!hit) continue;
      const float sum = channel(file, "emission.G").at(i) + channel(file, "light.lamp_1.G").at(i) +
                        channel(file, "light.sun.G").at(i) + channel(file, "indirect.G").at(i);
      lit += channel(file, "light.lamp_1.G").at(i) > 0.0f ? 1 : 0;
      const bool edge = renderer == "embree";  // whose colour is filtered: sky shows through at edges
      if (edge ? sum > file.gbuffer.beauty[i].g + 1e-6f : sum != file.gbuffer.beauty[i].g) ADD_FAILURE() << i;
      if (renderer == "embree") occluded += channel(file, "AO").at(i) < 0.9f ? 1 : 0;
    }
    EXPECT_GT(sky, 100u);
    EXPECT_GT(lit, 1000u);
    if (renderer == "embree") {
      EXPECT_GT(occluded, 100u);
    }
  }
  // The board throws a shadow: somewhere gl has light of the lamp and embree has none.
  const OpaqueFile traced = readOpaque(folder + "/embree.exr", ReadOptions{}),
                   drawn = readOpaque(folder + "/gl.exr", ReadOptions{});
  std::size_t shadowed = 0;
  for (std::size_t i = 0; i < traced.gbuffer.viewZ.size(); ++i)
    shadowed +=
        channel(traced, "light.lamp_1.G").at(i) == 0.0f && channel(drawn, "light.lamp_1.G").at(i) > 0.01f ? 1 : 0;
  EXPECT_GT(shadowed, 50u);
}

TEST(GbufferVerb, ThreadsChangeNoBit) {
  const std::string folder = freshFolder("embree_threads");
  const std::string room = writeRoom(folder);
  for (const std::string threads : {"1", "2"}) {
    const Ended ended = runProgram({"gbuffer", room, "-o", folder + "/" + threads + ".exr", "--size", "61x43",
                                    "--samples", "5", "--environment", "0.1,0.2,0.3", "--threads", threads});
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  EXPECT_EQ(slurp(folder + "/1.exr"), slurp(folder + "/2.exr"));
}

TEST(GbufferVerb, WhatCannotBeHonouredIsRefused) {
  const std::string folder = freshFolder("embree_refused");
  const std::string room = writeRoom(folder);
  const std::vector<std::pair<std::vector<std::string>, int>> cases{
      {{"--size", "0x10"}, 2},
      {{"--size", "10"}, 2},
      {{"--size", "10x10junk"}, 2},
      {{"--size", "70000x10"}, 2},
      {{"--size", "8x8", "--samples", "0"}, 2},
      {{"--size", "8x8", "--ao-radius", "-1"}, 2},
      {{"--size", "8x8", "--camera", "nobody"}, 2},
      {{"--size", "8x8", "--environment", "1,2,-3"}, 2},
      {{"--size", "8x8", "--environment", folder + "/none.exr"}, 3},
      {{"--size", "8x8", "--environment", room}, 3},
      {{"--size", "8x8", "--device", "0"}, 2},
      {{"--size", "8x8", "--texture-filter", "mipmap"}, 2},
      {{"--size", "8x8", "--renderer", "gl", "--samples", "4"}, 2},
      {{"--size", "8x8", "--renderer", "gl", "--shadows", "exact"}, 2},
      {{"--size", "8x8", "--renderer", "gl", "--ao-radius", "2"}, 2},
      {{"--size", "8x8", "--renderer", "gl", "--environment", folder + "/none.exr"}, 2},
  };
  for (const auto& [flags, code] : cases) {
    std::vector<std::string> arguments{"gbuffer", room, "-o", folder + "/out.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments);
    EXPECT_EQ(ended.code, code) << flags.back() << ": " << ended.err;
    EXPECT_FALSE(ended.err.empty());
  }
  EXPECT_EQ(filesIn(folder).size(), 1u) << "only the scene";
}

// How far the glass of two pictures is apart, in pixels: least squares of a shift on the transparent layer's alpha.
glm::dvec2 shiftBetween(const OpaqueFile& a, const OpaqueFile& b) {
  const ExrChannel &p = channel(a, "transparent.A"), &q = channel(b, "transparent.A");
  const int width = a.gbuffer.data.width(), height = a.gbuffer.data.height();
  double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const auto at = [&](const ExrChannel& plane, int dx, int dy) {
        return static_cast<double>(plane.at(static_cast<std::size_t>((y + dy) * width + x + dx)));
      };
      const double gx = 0.5 * (at(p, 1, 0) - at(p, -1, 0)), gy = 0.5 * (at(p, 0, 1) - at(p, 0, -1));
      const double d = at(q, 0, 0) - at(p, 0, 0);
      xx += gx * gx, xy += gx * gy, yy += gy * gy, xd += gx * d, yd += gy * d;
    }
  const double determinant = xx * yy - xy * xy;
  return glm::dvec2(yy * xd - xy * yd, xx * yd - xy * xd) / -determinant;
}

TEST(GbufferVerb, GlassFallsWhereItFallsOverBlendersRender) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
  const std::string blender = assets() + "/blender/", folder = freshFolder("embree_registration");
  const std::string ours = folder + "/ours.exr";
  Ended ended = runProgram(
      {"gbuffer", blender + "scene.glb", "-o", ours, "--size", "640x360", "--samples", "4", "--ao-radius", "0"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::vector<std::pair<std::string, std::string>> runs{{ours, folder + "/a.exr"},
                                                              {blender + "gbuffer.exr", folder + "/b.exr"}};
  for (const auto& [opaque, out] : runs) {
    ended = runProgram({"composite", opaque, blender + "transparent_lit.glb", "-o", out, "--layers", "transparent",
                        "--aa", "4", "--environment", "0.2,0.2,0.2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  const OpaqueFile a = readOpaque(folder + "/a.exr", ReadOptions{});
  ReadOptions multilayer;
  multilayer.depthChannel = "ViewLayer.Depth.Z";
  const OpaqueFile b = readOpaque(folder + "/b.exr", multilayer);
  const glm::dvec2 shift = shiftBetween(a, b);
  std::printf("registration over our G-buffer against Blender's: (%.5f, %.5f) px\n", shift.x, shift.y);
  EXPECT_LE(glm::length(shift), 0.05);
}

}  // namespace
}  // namespace pellucid::test
