// Glass that bends rays between an antialiased post and its wall: pixels of the edge show it the wall alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kSide = 32, kPlaces = 32;
constexpr double kPostAt = 3.0, kWallAt = 10.0;

nlohmann::json bendingGlass(double thickness) {
  return {{"alphaMode", "BLEND"},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {0.9, 0.6, 0.3, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.0}}},
          {"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
            {"KHR_materials_ior", {{"ior", 1.5}}},
            {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}};
}

class BentEdges : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-bent-edges"); }
  std::string path(const char* name) const { return folder + "/" + name; }

  // Of the post left of a slanted line, by the box filter.
  static bool onPost(double x, double y) { return x / kSide - 0.13 * y / kSide < 0.37; }
  static double share(int x, int y) {
    int inside = 0;
    for (int v = 0; v < kPlaces; ++v)
      for (int u = 0; u < kPlaces; ++u) inside += onPost(x + (u + 0.5) / kPlaces, y + (v + 0.5) / kPlaces) ? 1 : 0;
    return static_cast<double>(inside) / (kPlaces * kPlaces);
  }
  template <class Colour, class Depth>
  void writePicture(const char* name, const Colour& colour, const Depth& depth) {
    std::vector<Image<float>> planes(4, Image<float>(kSide, kSide));
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const glm::dvec3 c = colour(x, y);
        for (int k = 0; k < 3; ++k) planes[static_cast<std::size_t>(k)].at(x, y) = static_cast<float>(c[k]);
        planes[3].at(x, y) = static_cast<float>(depth(x, y));
      }
    const Window window{0, 0, kSide, kSide};
    writeLayers(path(name), window, window,
                {{"", {{"R", planes[0]}, {"G", planes[1]}, {"B", planes[2]}, {"Z", planes[3]}}}});
  }
  void writePost(const char* name, const glm::dvec3& post, const glm::dvec3& wall) {
    writePicture(
        name, [&](int x, int y) { return share(x, y) * post + (1.0 - share(x, y)) * wall; },
        [](int x, int y) { return onPost(x + 0.5, y + 0.5) ? kPostAt : kWallAt; });
  }
  void writeWall(const char* name, const glm::dvec3& wall) {
    writePicture(
        name, [&](int, int) { return wall; }, [](int, int) { return kWallAt; });
  }
  Request request(const char* picture, int passes, const std::string& method) {
    Request request = requestOf(path(picture), path("glass.glb"));
    request.method = method;
    request.paint = paintOf(method);
    request.passes = passes;
    return request;
  }
  static Picture run(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture;
  }
  std::string folder;
};

// What the glass makes of the wall is what it makes of a wall alone, whatever it bends: the wall has one colour. Rays
// that are bent by less than a pixel meet the pixel itself.
TEST_F(BentEdges, GlassBetweenAPostAndItsWall) {
  struct Colours {
    glm::dvec3 post, wall;
  };
  for (const Colours& colours :
       {Colours{{0.02, 0.03, 0.01}, {2.0, 1.6, 1.1}}, Colours{{3.0, 0.2, 1.0}, {0.1, 0.4, 0.2}}}) {
    writePost("post.exr", colours.post, colours.wall);
    writeWall("wall.exr", colours.wall);
    for (const double thickness : {0.05, 0.5, 3.0}) {
      writeGlb(path("glass.glb"), {Quad{{-60, -60, -5}, {120, 0, 0}, {0, 120, 0}, bendingGlass(thickness)}});
      for (const char* method : {"over", "phenomenological", "mlab:4"})
        for (const bool onDevice : {false, true})
          for (const int passes : {8, 64}) {
            if (onDevice && std::string(method) != "phenomenological") continue;
            SCOPED_TRACE(testing::Message()
                         << thickness << " m, " << method << (onDevice ? " on the device" : "") << ", --aa " << passes);
            Request asked = request("post.exr", passes, method), alone = request("wall.exr", passes, method);
            asked.resolveOnDevice = alone.resolveOnDevice = onDevice;
            const Picture picture = run(asked), wall = run(alone);
            for (int y = 1; y < kSide - 1; ++y)
              for (int x = 1; x < kSide - 1; ++x) {
                const double f = share(x, y);
                for (int c = 0; c < 3; ++c) {
                  const double right = f * colours.post[c] + (1.0 - f) * static_cast<double>(wall.rgba.at(x, y)[c]);
                  ASSERT_NEAR(picture.rgba.at(x, y)[c], right, 2e-5) << x << " " << y << " " << f;
                }
              }
          }
    }
  }
}

}  // namespace
}  // namespace pellucid
