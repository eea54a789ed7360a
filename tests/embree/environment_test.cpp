// Light of a lat-long picture on transparent things: the split sum against brute-force integration, and rays against
// GL.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "engine_bridge/embree/ray_fragments.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/surroundings.h"
#include "tests/embree/traced_scenes.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 512, kHeight = 256;
using Radiance = double (*)(glm::dvec3);

double constant(glm::dvec3) {
  return 1.0;
}
double lobe(glm::dvec3 d) {
  return std::pow(std::max(glm::dot(d, glm::normalize(glm::dvec3(1, 1, 0.5))), 0.0), 8.0);
}
double horizon(glm::dvec3 d) {
  return d.y > 0 ? 0.3 + 0.7 * d.y : 0.05;
}
// A window of 17 by 17 degrees, forty times as bright as the room.
double window(glm::dvec3 d) {
  return std::abs(std::atan2(d.z, d.x) - 0.4) < 0.15 && std::abs(d.y - 0.5) < 0.13 ? 8.0 : 0.2;
}

Image<glm::vec3> mapOf(Radiance radiance) {
  Image<glm::vec3> map(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight);
      map.at(x, y) = glm::vec3(static_cast<float>(radiance(glm::dvec3(shading::directionOfLatLong(uv)))));
    }
  return map;
}

shading::Surface surfaceOf(float metallic, float roughness, float transmission, float ior) {
  shading::MaterialPoint point{};
  point.base = glm::vec4(0.8f, 0.6f, 0.4f, 1.0f);
  point.metallic = metallic;
  point.roughness = roughness;
  point.transmission = transmission;
  point.ior = ior;
  point.specular = glm::vec4(1.0f);
  return shading::surfaceOf(point, 1.0f, glm::vec3(1.0f), false);
}

// The middle of every texel of the map, through the BRDF itself.
glm::dvec3 bruteForce(const Image<glm::vec3>& map, const shading::Surface& surface, glm::vec3 normal, glm::vec3 toEye) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < kHeight; ++y) {
    const double band = std::cos(M_PI * y / kHeight) - std::cos(M_PI * (y + 1) / kHeight);
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight);
      const glm::vec3 towards = glm::normalize(shading::directionOfLatLong(uv));
      if (glm::dot(towards, normal) <= 0.0f) continue;
      sum += glm::dvec3(shading::reflectTowardsEye(surface, normal, toEye, towards)) * glm::dvec3(map.at(x, y)) *
             (band * 2.0 * M_PI / kWidth);
    }
  }
  return sum;
}

struct Error {
  double worst = 0, sum = 0;
  int count = 0;
  void add(double relative) {
    worst = std::max(worst, relative);
    sum += relative;
    ++count;
  }
  double mean() const { return sum / count; }
};

// Of what the eye sees: relative to the larger of the brute-force value and a hundredth of the map's mean.
Error errorOf(Radiance radiance, float metallic, float transmission, float roughness) {
  const Image<glm::vec3> map = mapOf(radiance);
  static std::map<Radiance, Surroundings> prepared;
  if (!prepared.count(radiance)) prepared.emplace(radiance, prepareSurroundings(map));
  const Surroundings& surroundings = prepared.at(radiance);
  Error error;
  const shading::Surface surface = surfaceOf(metallic, roughness, transmission, 1.5f);
  for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(1, 0.3f, 0.2f), glm::vec3(-0.4f, -0.2f, 1)})
    for (const float cosine : {1.0f, 0.8f, 0.5f, 0.3f}) {
      const float azimuth = 0.3f + 7.0f * cosine;
      const glm::vec3 normal = glm::normalize(axis);
      const glm::vec3 side = glm::normalize(glm::cross(normal, glm::vec3(0.3f, 0.1f, 0.9f)));
      const glm::vec3 level = std::cos(azimuth) * side + std::sin(azimuth) * glm::cross(normal, side);
      const glm::vec3 toEye = glm::normalize(cosine * normal + std::sqrt(1.0f - cosine * cosine) * level);
      const glm::dvec3 expected = bruteForce(map, surface, normal, toEye);
      const glm::dvec3 found(surroundings.reflected(surface, normal, toEye, cosine));
      error.add(std::abs(found.r - expected.r) / std::max(expected.r, 0.01));
    }
  return error;
}

TEST(Environment, SplitSumAgainstBruteForce) {
  const struct {
    const char* name;
    Radiance radiance;
    // Mean and largest error of the diffuse light, of metal and of a clear dielectric's reflection, roughness 1/4 to 1:
    // measured, rounded up. A constant map shows the table alone; the rest is the lobe, which the split sum takes as
    // round and does not cut off at the horizon: it errs most at a grazing eye and half a roughness.
    double diffuse, metalMean, metalWorst, glassMean, glassWorst;
  } maps[] = {{"constant", constant, 0.001, 0.005, 0.01, 0.005, 0.01},
              {"lobe", lobe, 0.005, 0.22, 0.85, 0.08, 0.35},
              {"horizon", horizon, 0.005, 0.09, 0.5, 0.07, 0.45},
              {"window", window, 0.005, 0.08, 0.4, 0.1, 0.5}};
  for (const auto& one : maps) {
    shading::Surface matte = surfaceOf(0.0f, 1.0f, 0.0f, 1.0f);
    const Image<glm::vec3> map = mapOf(one.radiance);
    const Surroundings surroundings = prepareSurroundings(map, 64);
    Error diffuse;
    for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(-1, 1, 1)}) {
      const glm::vec3 normal = glm::normalize(axis);
      const double expected = bruteForce(map, matte, normal, normal).r;
      diffuse.add(std::abs(static_cast<double>(surroundings.reflected(matte, normal, normal, 1.0f).r) - expected) /
                  std::max(expected, 0.01));
    }
    std::printf("%s: diffuse worst %.4f\n", one.name, diffuse.worst);
    EXPECT_LT(diffuse.worst, one.diffuse);
    for (const float metallic : {1.0f, 0.0f}) {
      Error all;
      for (const float roughness : {0.25f, 0.4f, 0.6f, 0.8f, 1.0f}) {
        const Error error = errorOf(one.radiance, metallic, 1.0f, roughness);
        std::printf("%s: %s, roughness %.2f: mean error %.3f, worst %.3f\n", one.name, metallic > 0 ? "metal" : "glass",
                    static_cast<double>(roughness), error.mean(), error.worst);
        all.worst = std::max(all.worst, error.worst);
        all.sum += error.sum;
        all.count += error.count;
      }
      std::printf("%s: %s: mean error %.3f, worst %.3f\n", one.name, metallic > 0 ? "metal" : "glass", all.mean(),
                  all.worst);
      EXPECT_LT(all.mean(), metallic > 0 ? one.metalMean : one.glassMean);
      EXPECT_LT(all.worst, metallic > 0 ? one.metalWorst : one.glassWorst);
    }
  }
}

// A mirror shows the map itself, times what its interface reflects.
TEST(Environment, ASmoothSurfaceMirrorsTheMap) {
  const Image<glm::vec3> map = mapOf(lobe);
  const Surroundings surroundings = prepareSurroundings(map);
  const shading::Surface glass = surfaceOf(0.0f, 0.0f, 1.0f, 1.5f);
  const glm::vec3 normal(0, 1, 0);
  double worst = 0;
  for (int i = 0; i < 64; ++i) {
    const float cosine = 0.15f + 0.013f * static_cast<float>(i), angle = 0.7f * static_cast<float>(i);
    const float across = std::sqrt(1.0f - cosine * cosine);
    const glm::vec3 toEye(across * std::cos(angle), cosine, across * std::sin(angle));
    const glm::vec3 mirrored(-toEye.x, toEye.y, -toEye.z);
    const double expected = lobe(glm::dvec3(mirrored)) * static_cast<double>(shading::fresnelDielectric(cosine, 1.5f));
    worst = std::max(worst,
                     std::abs(static_cast<double>(surroundings.reflected(glass, normal, toEye, cosine).r) - expected));
  }
  std::printf("smooth glass: worst error %.5f of a map whose brightest is 1\n", worst);
  EXPECT_LT(worst, 0.005);  // the table's smoothest row has roughness .03, and 32 columns
}

TEST(Environment, NoNumberOfThreadsShows) {
  const Image<glm::vec3> map = mapOf(window);
  const Surroundings many = prepareSurroundings(map, 64);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Surroundings few = prepareSurroundings(map, 64);
  EXPECT_EQ(0, std::memcmp(many.atlas.data(), few.atlas.data(), many.atlas.size() * sizeof(glm::vec4)));
}

TEST(Environment, RaysAndGlShowTheSame) {
  const Scene scene = sceneOf(makeSample("bottles") + ".glb");
  const Window window{0, 0, 160, 90};
  const Camera camera = cameraIn(scene, window);
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = window;
  gbuffer.viewZ = Image<float>(window.width(), window.height(), INFINITY);
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  settings.environment = std::make_shared<const Surroundings>(prepareSurroundings(mapOf(lobe), 128));
  std::map<std::pair<std::size_t, std::uint32_t>, glm::vec3> traced;
  const auto each = [&](const FragmentLists& lists, auto&& use) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i)
        for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k)
          use(std::make_pair(static_cast<std::size_t>(y * window.width() + x), lists.fragments[k].identity),
              lists.fragments[k].radiance);
  };
  RayFragments(scene, gbuffer, camera).fragments(settings, [&](const FragmentLists& lists) {
    each(lists, [&](const auto& key, glm::vec3 radiance) { traced[key] = radiance; });
  });
  GlContext context;
  std::size_t fragments = 0, off = 0;
  double worst = 0;
  TransparentPass(context, scene, gbuffer, camera).fragments(settings, [&](const FragmentLists& lists) {
    each(lists, [&](const auto& key, glm::vec3 radiance) {
      const auto other = traced.find(key);
      if (other == traced.end()) return;  // edges: fragments_test counts them
      ++fragments;
      const glm::vec3 difference = glm::abs(radiance - other->second);
      const auto error = static_cast<double>(std::max({difference.r, difference.g, difference.b}));
      worst = std::max(worst, error);
      off += error > 1e-3 ? 1 : 0;
    });
  });
  std::printf("environment: %zu fragments, worst difference between rays and GL %.2g, %zu beyond 1e-3\n", fragments,
              worst, off);
  EXPECT_GT(fragments, 2000u);
  // GL snaps vertices to 1/256 pixel: at silhouettes normals turn fast.
  EXPECT_LE(off, fragments / 500);
  ASSERT_GT(traced.size(), 0u);
}

}  // namespace
}  // namespace pellucid::test
