// Two renderers, one scene: rays against rasterisation, and ours against Blender's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine_bridge/embree/opaque_render.h"
#include "engine_bridge/embree/opaque_scene.h"
#include "engine_bridge/gl/opaque_pass.h"
#include "tests/embree/traced_scenes.h"

namespace pellucid::test {
namespace {

using rays::BlockHits;
using rays::kMissed;

// What lies under a pixel: the triangle at its centre, and whether it also covers a sixteenth of a pixel around: GL
// snaps vertices to 1/256, so there the two cannot see different triangles.
struct Under {
  std::uint32_t instance = kMissed, triangle = kMissed;
  bool awayFromEdges = true;
};

Image<Under> look(const rays::OpaqueScene& traced, const rays::CameraRays& rays, const Window& window) {
  Image<Under> under(window.width(), window.height());
  constexpr float r = 1.0f / 16.0f;
  const glm::vec2 offsets[] = {{0, 0}, {-r, -r}, {r, -r}, {-r, r}, {r, r}};
  for (const glm::vec2 offset : offsets)
    for (int y = 0; y < window.height(); y += 4)
      for (int x = 0; x < window.width(); x += 4) {
        std::array<glm::vec2, 16> samples;
        samples.fill(glm::vec2(0.5f) + offset);
        BlockHits hits;
        traced.traceBlock(rays, window.x0 + x, window.y0 + y, samples, hits);
        for (int i = 0; i < 16; ++i) {
          if (x + i % 4 >= window.width() || y + i / 4 >= window.height()) continue;
          Under& pixel = under.at(x + i % 4, y + i / 4);
          const std::uint32_t triangle = hits.instance[i] == kMissed ? kMissed : hits.triangle[i];
          if (offset == glm::vec2(0.0f)) {
            pixel.instance = hits.instance[i];
            pixel.triangle = triangle;
          } else if (pixel.instance != hits.instance[i] || pixel.triangle != triangle) {
            pixel.awayFromEdges = false;
          }
        }
      }
  return under;
}

struct Difference {
  std::size_t pixels = 0, hits = 0, badZ = 0, badNormal = 0, badColour = 0, badAlbedo = 0;
  double worstZ = 0, worstNormal = 0, worstColour = 0;
};

Difference compare(const Scene& scene, const Camera& camera, const Window& window, const OpaquePlanes& rayed,
                   const OpaquePlanes& drawn) {
  const rays::OpaqueScene traced(scene, camera);
  const rays::CameraRays rays(camera, window);
  const Image<Under> under = look(traced, rays, window);
  Difference result;
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x) {
      const Under& pixel = under.at(x, y);
      if (!pixel.awayFromEdges) continue;
      ++result.pixels;
      const float a = rayed.viewZ.at(x, y), b = drawn.viewZ.at(x, y);
      if (pixel.instance == kMissed) {
        result.badZ += std::isinf(a) && std::isinf(b) ? 0 : 1;
        continue;
      }
      ++result.hits;
      const Primitive& primitive =
          scene.primitives[static_cast<std::size_t>(scene.instances[pixel.instance].primitive)];
      const rays::Corners corners =
          rays::cornersOf(primitive, traced.placed(pixel.instance).viewFromObject, pixel.triangle);
      const auto depth = [&](double dx, double dy) {
        const auto hit =
            rays::intersectPlane(rays.through({window.x0 + x + 0.5 + dx, window.y0 + y + 0.5 + dy}), corners);
        return hit ? hit->z : 0.0;
      };
      const double slope = std::abs(depth(1, 0) - depth(0, 0)) + std::abs(depth(0, 1) - depth(0, 0));
      const double tolerance = 1e-5 * static_cast<double>(a) + slope / 256;
      const double error = std::abs(static_cast<double>(a) - static_cast<double>(b));
      result.worstZ = std::max(result.worstZ, error / tolerance);
      result.badZ += error <= tolerance ? 0 : 1;
      const glm::dvec3 n(rayed.normal.at(x, y)), m(drawn.normal.at(x, y));
      const double angle = glm::degrees(std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m)));
      result.worstNormal = std::max(result.worstNormal, angle);
      result.badNormal += angle <= 0.1 ? 0 : 1;
      for (int c = 0; c < 3; ++c) {
        const double colour =
            std::abs(static_cast<double>(rayed.beauty.at(x, y)[c]) - static_cast<double>(drawn.beauty.at(x, y)[c]));
        const double scale = std::max(1.0, std::abs(static_cast<double>(rayed.beauty.at(x, y)[c])));
        result.worstColour = std::max(result.worstColour, colour / scale);
        if (!(colour <= 1e-3 * scale)) {
          ++result.badColour;
          break;
        }
      }
    }
  return result;
}

void expectAgreement(const std::string& name, const Scene& scene, const Window& window) {
  const Camera camera = cameraIn(scene, window);
  const glm::vec3 sky(0.2f, 0.3f, 0.4f);
  OpaqueRenderSettings settings;
  settings.samples = 1;
  settings.shadows = false;
  settings.aoRadius = 0.0f;
  const OpaquePlanes rayed = renderOpaque(scene, camera, window, window, Environment(sky), settings);
  GlContext context;
  OpaquePassSettings pass;
  pass.filter = TextureFilter::bilinear;
  pass.surroundings = sky;
  const OpaquePlanes drawn = rasteriseOpaque(context, scene, camera, window, window, pass);
  const Difference d = compare(scene, camera, window, rayed, drawn);
  std::printf(
      "%s: %zu of %d pixels away from edges, %zu of them hit; beyond tolerance: Z %zu (worst %.2f of it), normals %zu "
      "(worst %.4f degrees), colour %zu (worst %.2g)\n",
      name.c_str(), d.pixels, window.width() * window.height(), d.hits, d.badZ, d.worstZ, d.badNormal, d.worstNormal,
      d.badColour, d.worstColour);
  EXPECT_GT(d.hits, 1000u);
  EXPECT_GT(d.pixels, static_cast<std::size_t>(window.width() * window.height()) / 2);
  EXPECT_EQ(d.badZ, 0u);
  EXPECT_EQ(d.badNormal, 0u);
  // A texel's edge may fall between the two positions of a pixel's centre: 1/256 of a pixel apart.
  EXPECT_LE(d.badColour, d.hits / 1000);
  ASSERT_EQ(rayed.lights.size(), drawn.lights.size());
}

TEST(Agreement, ShippedSamplesPaintedOpaque) {
  for (const std::string name : {"bars", "bottles", "smoke"}) {
    Scene scene = sceneOf(makeSample(name) + ".glb");
    makeOpaque(scene);
    expectAgreement(name, scene, {0, 0, 320, 180});
  }
}

TEST(Agreement, BlenderScene) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
  Scene scene = sceneOf(assets() + "/blender/scene.glb");
  expectAgreement("blender", scene, {0, 0, 640, 360});
  makeOpaque(scene);
  expectAgreement("blender, everything opaque", scene, {0, 0, 320, 180});
}

// Windows that do not begin at the display's corner see the same pixels.
TEST(Agreement, CropsAreTheSamePixels) {
  Scene scene = sceneOf(makeSample("bars") + ".glb");
  makeOpaque(scene);
  const Window display{0, 0, 160, 90}, crop{37, 21, 98, 80};
  const Camera camera = cameraIn(scene, display);
  OpaqueRenderSettings settings;
  settings.samples = 4;
  const Environment sky(glm::vec3(0.5f));
  const OpaquePlanes whole = renderOpaque(scene, camera, display, display, sky, settings);
  const OpaquePlanes part = renderOpaque(scene, camera, display, crop, sky, settings);
  for (int y = 0; y < crop.height(); ++y)
    for (int x = 0; x < crop.width(); ++x) {
      ASSERT_EQ(part.beauty.at(x, y), whole.beauty.at(crop.x0 + x, crop.y0 + y)) << x << ' ' << y;
      ASSERT_EQ(part.viewZ.at(x, y), whole.viewZ.at(crop.x0 + x, crop.y0 + y)) << x << ' ' << y;
      ASSERT_EQ(part.occlusion.at(x, y), whole.occlusion.at(crop.x0 + x, crop.y0 + y)) << x << ' ' << y;
    }
}

// Pixels within 3 of one that shows the instance, so that no other subdivision of it shows there.
Image<std::uint8_t> around(const Image<Under>& under, const Scene& scene, const std::string& node) {
  Image<std::uint8_t> mask(under.width(), under.height(), 0);
  for (int y = 0; y < under.height(); ++y)
    for (int x = 0; x < under.width(); ++x) {
      const std::uint32_t instance = under.at(x, y).instance;
      if (instance == kMissed || scene.instances[instance].node != node) continue;
      for (int v = std::max(y - 3, 0); v <= std::min(y + 3, under.height() - 1); ++v)
        for (int u = std::max(x - 3, 0); u <= std::min(x + 3, under.width() - 1); ++u) mask.at(u, v) = 1;
    }
  return mask;
}

// Both depths at pixel centres. The monkey is left out: Cycles rendered it with two levels of subdivision, and the
// exporter wrote it with one. It is another mesh, 3% of the picture.
TEST(Agreement, DepthOfBlender) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout";
  const Scene scene = sceneOf(assets() + "/blender/scene.glb");
  for (const std::string file : {"flat_gbuffer_center.exr", "gbuffer.exr"}) {
    const OpaqueFile theirs = readOpaque(assets() + "/blender/" + file, ReadOptions{});
    const Window window = theirs.gbuffer.data;
    const Camera camera = cameraIn(scene, window);
    OpaqueRenderSettings settings;
    settings.samples = 1;
    settings.aoRadius = 0.0f;
    const OpaquePlanes ours = renderOpaque(scene, camera, window, window, Environment{}, settings);
    const rays::OpaqueScene traced(scene, camera);
    const Image<std::uint8_t> monkey = around(look(traced, rays::CameraRays(camera, window), window), scene, "Suzanne");
    std::size_t all = 0, allClose = 0, pixels = 0, close = 0, hitByOne = 0;
    for (std::size_t i = 0; i < ours.viewZ.size(); ++i) {
      const float a = ours.viewZ[i], b = theirs.gbuffer.viewZ[i];
      const bool same = std::isinf(a) || std::isinf(b) ? a == b : std::abs(a - b) <= 1e-4f * b;
      ++all;
      allClose += same ? 1 : 0;
      if (monkey[i]) continue;
      ++pixels;
      close += same ? 1 : 0;
      hitByOne += std::isinf(a) != std::isinf(b) ? 1 : 0;
    }
    const auto percent = [](std::size_t part, std::size_t whole) {
      return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
    };
    std::printf("%s: Z within 1e-4 on %.4f%% of pixels without the monkey (%.3f%% with it); %zu hit by one only\n",
                file.c_str(), percent(close, pixels), percent(allClose, all), hitByOne);
    EXPECT_GE(percent(close, pixels), 99.5);
    EXPECT_GE(percent(pixels, all), 90.0);
  }
}

}  // namespace
}  // namespace pellucid::test
