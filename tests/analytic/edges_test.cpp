// Filtered edges taken apart, against closed forms: shares, planes and directions of what was filtered, and the mean of
// passes that each see one of the two surfaces.
#include <gtest/gtest.h>

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>

#include "composite/antialias.h"
#include "composite/edges.h"
#include "composite/methods/stochastic.h"
#include "composite/resolve.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr int kSize = 32, kFine = 32;
const glm::dvec4 kFront(0.02, 0.3, 0.01, 1.0), kBack(2.0, 0.1, 1.1, 1.0);

GBuffer emptyPicture(float depthPrecision) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, kSize, kSize};
  gbuffer.depthPrecision = depthPrecision;
  gbuffer.beauty = Image<glm::vec4>(kSize, kSize);
  gbuffer.viewZ = Image<float>(kSize, kSize);
  return gbuffer;
}

// A front whose edge is the line a x + b y = c, in pixels; both surfaces are tilted.
struct Scene {
  double a, b, c;
  bool inFront(double x, double y) const { return a * x + b * y < c; }
  static double frontZ(double x, double y) { return 1.0 / (0.3 + 0.0004 * x - 0.0002 * y); }
  static double backZ(double x, double y) { return 1.0 / (0.1 - 0.0003 * x + 0.0005 * y); }
  double share(int x, int y) const {
    int inside = 0;
    for (int v = 0; v < kFine; ++v)
      for (int u = 0; u < kFine; ++u) inside += inFront(x + (u + 0.5) / kFine, y + (v + 0.5) / kFine) ? 1 : 0;
    return static_cast<double>(inside) / (kFine * kFine);
  }
  GBuffer picture() const {
    GBuffer gbuffer = emptyPicture(0x1p-20f);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double f = share(x, y), u = x + 0.5, v = y + 0.5;
        gbuffer.beauty.at(x, y) = glm::vec4(f * kFront + (1.0 - f) * kBack);
        gbuffer.viewZ.at(x, y) = static_cast<float>(inFront(u, v) ? frontZ(u, v) : backZ(u, v));
      }
    return gbuffer;
  }
};
const Scene kScenes[] = {{1.0, 0.0, 16.3}, {1.0, 0.21, 18.0}, {-0.3, 1.0, 9.7}, {0.7, 0.7, 20.8}, {-1.0, -0.4, -22.2}};

bool atBorder(int x, int y) {
  return x == 0 || y == 0 || x == kSize - 1 || y == kSize - 1;
}

TEST(Edges, SharesPlanesAndDirections) {
  for (const Scene& scene : kScenes) {
    const GBuffer gbuffer = scene.picture();
    const std::vector<EdgePixel> edges = edgePixels(gbuffer, DepthPlanes(gbuffer, Camera()));
    std::size_t mixed = 0;
    for (int y = 1; y < kSize - 1; ++y)
      for (int x = 1; x < kSize - 1; ++x) {
        const double f = scene.share(x, y);
        mixed += f > 0.0 && f < 1.0 ? 1 : 0;
      }
    std::size_t inside = 0;
    const double length = std::hypot(scene.a, scene.b);
    for (const EdgePixel& edge : edges) {
      if (atBorder(edge.x, edge.y)) continue;
      ++inside;
      EXPECT_NEAR(edge.share, scene.share(edge.x, edge.y), 1e-5);
      const double u = edge.x + 0.8, v = edge.y + 0.1;
      // In a corner that holds two pixels of a surface their slope is not known across it.
      EXPECT_NEAR(edge.nearer.z(0.3, -0.4), Scene::frontZ(u, v), 5e-4 * Scene::frontZ(u, v));
      EXPECT_NEAR(edge.farther.z(0.3, -0.4), Scene::backZ(u, v), 5e-4 * Scene::backZ(u, v));
      EXPECT_GT(glm::dot(edge.towardsNearer, glm::dvec2(-scene.a, -scene.b) / length), 0.94) << "20 degrees";
    }
    EXPECT_EQ(inside, mixed);
  }
}

// One layer at depth z, in the place of the transparent pass.
Veil layerBefore(const Image<float>& viewZ, float z, const glm::vec3& light, const glm::vec3& transmission) {
  Veil veil(kSize, kSize);
  for (std::size_t i = 0; i < viewZ.size(); ++i) {
    if (z > viewZ[i]) continue;
    veil.light[i] = light;
    veil.transmission[i] = transmission;
    veil.touched[i] = 1;
  }
  return veil;
}

TEST(Edges, ALayerIsCompositedOverEitherSide) {
  const glm::vec3 light(0.05f, 0.1f, 0.2f), transmission(0.3f, 0.6f, 0.1f);
  for (const Scene& scene : kScenes)
    for (const int passes : {2, 3, 8, 16, 64})
      for (const float z : {2.0f, 5.0f, 20.0f}) {
        const GBuffer gbuffer = scene.picture();
        const DepthPlanes planes(gbuffer, Camera());
        std::vector<glm::dvec2> samples;
        for (int i = 0; i < passes; ++i) samples.push_back(samplePosition(i, passes));
        const EdgePasses edges(edgePixels(gbuffer, planes), samples);
        VeilMean mean;
        Image<float> there = gbuffer.viewZ, weights(kSize, kSize, 1.0f), sum(kSize, kSize, 0.0f);
        for (int i = 0; i < passes; ++i) {
          planes.depthAt(samples[static_cast<std::size_t>(i)], there);
          edges.depthAt(i, there);
          Veil veil = layerBefore(there, z, light, transmission);
          edges.weigh(i, veil);
          mean.add(std::move(veil));
          edges.weightAt(i, weights);
          for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weights[k];
        }
        Veil veil = mean.finish();
        edges.finish(veil);
        const Picture picture = compose(veil, gbuffer);
        for (int y = 1; y < kSize - 1; ++y)
          for (int x = 1; x < kSize - 1; ++x) {
            const double f = scene.share(x, y);
            const auto seen = [&](const glm::dvec4& c, bool before) {
              return before ? glm::dvec3(light) + glm::dvec3(transmission) * glm::dvec3(c) : glm::dvec3(c);
            };
            const glm::dvec3 expected = f * seen(kFront, z < 3.0f) + (1.0 - f) * seen(kBack, z < 8.0f);
            for (int c = 0; c < 3; ++c)
              EXPECT_NEAR(static_cast<double>(picture.rgba.at(x, y)[c]), expected[c], 2e-5) << x << ", " << y;
            EXPECT_NEAR(sum.at(x, y), static_cast<float>(passes), 1e-4f * static_cast<float>(passes));
            if (z > 10.0f) {
              EXPECT_EQ(picture.rgba.at(x, y), gbuffer.beauty.at(x, y));
            }
          }
      }
}

// Samples are filtered over all passes before they are divided, so their means take the passes' weights too.
TEST(Edges, StochasticSamplesTakeThePassesWeights) {
  constexpr int kPasses = 8;
  const glm::vec3 light(0.5f, 1.0f, 2.0f);
  const Scene& scene = kScenes[1];
  const GBuffer gbuffer = scene.picture();
  const DepthPlanes planes(gbuffer, Camera());
  std::vector<glm::dvec2> samples;
  for (int i = 0; i < kPasses; ++i) samples.push_back(samplePosition(i, kPasses));
  const EdgePasses edges(edgePixels(gbuffer, planes), samples);
  StochasticSettings settings;
  StochasticMean stochastic(kSize, kSize, settings, kPasses);
  VeilMean mean;
  Image<float> there = gbuffer.viewZ, weights(kSize, kSize, 1.0f);
  for (int i = 0; i < kPasses; ++i) {
    planes.depthAt(samples[static_cast<std::size_t>(i)], there);
    edges.depthAt(i, there);
    edges.weightAt(i, weights);
    FragmentLists lists;
    lists.window = gbuffer.data;
    lists.solid = Image<glm::vec4>(kSize, kSize, glm::vec4(0, 0, 0, std::numeric_limits<float>::infinity()));
    lists.offsets.assign(1, 0);
    for (std::size_t k = 0; k < there.size(); ++k) {
      Fragment glass{};
      glass.radiance = 0.7f * light;
      glass.coverage = 0.7f;
      glass.z = 5.0f;
      glass.identity = static_cast<std::uint32_t>(k);
      if (glass.z <= there[k]) lists.fragments.push_back(glass);
      lists.offsets.push_back(lists.fragments.size());
    }
    Veil veil(kSize, kSize);
    stochastic.add(i, lists, gbuffer.data, veil, &weights);
    edges.weigh(i, veil);
    mean.add(std::move(veil));
  }
  Veil veil = mean.finish();
  edges.finish(veil);
  stochastic.finish(veil);
  const Picture picture = compose(veil, gbuffer);
  for (int y = 1; y < kSize - 1; ++y)
    for (int x = 1; x < kSize - 1; ++x) {
      const double f = scene.share(x, y);
      for (int c = 0; c < 3; ++c) {
        const double behind = 0.7 * static_cast<double>(light[c]) + 0.3 * kBack[c];
        EXPECT_NEAR(static_cast<double>(picture.rgba.at(x, y)[c]), f * kFront[c] + (1.0 - f) * behind, 2e-5);
      }
    }
}

// A ball before a wall, seen through the middle of the picture by a camera `kFocal` pixels from it.
struct BallPicture {
  static constexpr double kFocal = 24.0, kWallZ = 60.0;
  glm::dvec3 centre;
  double radius;
  bool halfDepth;
  // Distance along the axis; infinite beside the ball.
  double ballZ(double x, double y) const {
    const glm::dvec3 ray((x - 0.5 * kSize) / kFocal, (y - 0.5 * kSize) / kFocal, 1.0);
    const double a = glm::dot(ray, ray), b = glm::dot(ray, centre), c = glm::dot(centre, centre) - radius * radius;
    const double inside = b * b - a * c;
    return inside < 0.0 ? std::numeric_limits<double>::infinity() : (b - std::sqrt(inside)) / a;
  }
  double share(int x, int y) const {
    int inside = 0;
    for (int v = 0; v < kFine; ++v)
      for (int u = 0; u < kFine; ++u)
        inside += std::isfinite(ballZ(x + (u + 0.5) / kFine, y + (v + 0.5) / kFine)) ? 1 : 0;
    return static_cast<double>(inside) / (kFine * kFine);
  }
  GBuffer picture() const {
    GBuffer gbuffer = emptyPicture(halfDepth ? 0x1p-10f : 0x1p-20f);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double f = share(x, y);
        const auto z = static_cast<float>(std::min(ballZ(x + 0.5, y + 0.5), kWallZ));
        const double light = 0.5 + 0.5 * std::min(1.0, 4.0 / ballZ(x + 0.5, y + 0.5)) + 0.02 * (x + y);
        gbuffer.beauty.at(x, y) = glm::vec4(glm::dvec3(f * light * kFront + (1.0 - f) * kBack), 1.0);
        gbuffer.viewZ.at(x, y) = halfDepth ? imath_half_to_float(imath_float_to_half(z)) : z;
      }
    return gbuffer;
  }
};

// However steeply a ball falls off towards its limb, along rows, columns and diagonals: only pixels that show the wall
// as well are taken apart.
TEST(Edges, BallsHaveNoneButTheirLimb) {
  int balls = 0, mixed = 0, found = 0, wrong = 0;
  double worst = 0.0;
  for (const bool halfDepth : {false, true})
    for (double radius = 2.0; radius <= 12.01; radius += 0.5)
      for (int i = 0; i < 4; ++i) {
        const BallPicture ball{{5.0 * std::sin(i + radius), 5.0 * std::cos(2.3 * i), 24.0}, radius, halfDepth};
        const GBuffer gbuffer = ball.picture();
        ++balls;
        for (int y = 3; y < kSize - 3; ++y)
          for (int x = 3; x < kSize - 3; ++x) {
            const double f = ball.share(x, y);
            mixed += f > 0.0 && f < 1.0 ? 1 : 0;
          }
        for (const EdgePixel& edge : edgePixels(gbuffer, DepthPlanes(gbuffer, Camera()))) {
          // At the border the steps before one are not in the picture.
          if (std::min({edge.x, edge.y, kSize - 1 - edge.x, kSize - 1 - edge.y}) < 3) continue;
          const double f = ball.share(edge.x, edge.y);
          if (f > 0.0 && f < 1.0) {
            ++found;
            worst = std::max(worst, std::abs(edge.share - f));
            continue;
          }
          ++wrong;
        }
      }
  std::printf("%d balls: %d mixed pixels, %d taken apart, shares off by %.3f at most; %d others taken apart\n", balls,
              mixed, found, worst, wrong);
  EXPECT_EQ(wrong, 0);
}

// A floor seen so steeply that its plane leaves the picture within a pixel behind the place where it meets the wall.
struct MeetingPicture {
  glm::dvec2 across;  // of the floor's 1/z, per pixel
  double floor(glm::dvec2 at) const { return 0.0038 + glm::dot(across, at - 0.5 * kSize); }
  static double wall(glm::dvec2 at) { return 0.0034 - 3e-5 * at.x + 1e-5 * at.y; }
  double z(glm::dvec2 at) const { return 1.0 / std::max(floor(at), wall(at)); }
  GBuffer picture() const {
    GBuffer gbuffer = emptyPicture(0x1p-20f);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        glm::dvec4 sum(0.0);
        for (int i = 0; i < kFine * kFine; ++i) {
          const glm::dvec2 at(x + (i % kFine + 0.5) / kFine, y + (i / kFine + 0.5) / kFine);
          sum += floor(at) > wall(at) ? kFront : kBack;
        }
        gbuffer.beauty.at(x, y) = glm::vec4(sum / (1.0 * kFine * kFine));
        gbuffer.viewZ.at(x, y) = static_cast<float>(z({x + 0.5, y + 0.5}));
      }
    return gbuffer;
  }
};

// Layers behind the wall would shine through where passes look past it along the floor's plane, which ends there.
TEST(Edges, WhereSurfacesMeetTheNearerIsSeen) {
  int count = 0, left = 0;
  double worst = 0.0;
  for (const glm::dvec2 across : {glm::dvec2(-0.004, 0.0), {0.0, 0.0041}, {-0.0041, -0.0005}, {0.002, -0.003}}) {
    const MeetingPicture meeting{across};
    const GBuffer gbuffer = meeting.picture();
    const DepthPlanes planes(gbuffer, Camera());
    const std::vector<EdgePixel> pixels = edgePixels(gbuffer, planes);
    std::vector<glm::dvec2> samples;
    for (int i = 0; i < 8; ++i) samples.push_back(samplePosition(i, 8));
    const EdgePasses edges(pixels, samples);
    for (const EdgePixel& pixel : pixels) {
      if (std::min({pixel.x, pixel.y, kSize - 1 - pixel.x, kSize - 1 - pixel.y}) < 3) continue;
      ++count;
      for (const glm::dvec2 corner : {glm::dvec2(-0.5, -0.5), {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}})
        left +=
            std::isinf(pixel.nearer.z(corner.x, corner.y)) || std::isinf(pixel.farther.z(corner.x, corner.y)) ? 1 : 0;
      for (int i = 0; i < 8; ++i) {
        Image<float> there = gbuffer.viewZ;
        edges.depthAt(i, there);
        const double right = meeting.z(glm::dvec2(pixel.x, pixel.y) + samples[static_cast<std::size_t>(i)]);
        worst = std::max(worst, std::abs(static_cast<double>(there.at(pixel.x, pixel.y)) / right - 1.0));
      }
    }
  }
  std::printf("%d edge pixels, at %d of their corners a plane has left the picture; depth off by %.1e at most\n", count,
              left, worst);
  EXPECT_GT(left, 0);
  EXPECT_LT(worst, 1e-3);
}

// Balls of all sizes before a wall, filtered, with noise in depth and colour.
GBuffer crowd(test::Random& random, int size) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, size, size};
  gbuffer.depthPrecision = 0x1p-12f;
  gbuffer.beauty = Image<glm::vec4>(size, size, glm::vec4(0.1f, 0.2f, 0.9f, 1.0f));
  gbuffer.viewZ = Image<float>(size, size, 9.0f);
  for (int i = 0; i < 60; ++i) {
    const double cx = random.between(0, size), cy = random.between(0, size), radius = random.between(1, 12);
    const double z = random.between(2, 7);
    const glm::vec4 colour(random.uniformf(), random.uniformf(), random.uniformf(), 1.0f);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double away = std::hypot(x + 0.5 - cx, y + 0.5 - cy);
        glm::vec4& seen = gbuffer.beauty.at(x, y);
        seen = glm::mix(seen, colour, static_cast<float>(std::clamp(radius - away + 0.5, 0.0, 1.0)));
        if (away < radius)
          gbuffer.viewZ.at(x, y) = static_cast<float>(z - 0.1 * std::sqrt(radius * radius - away * away));
      }
  }
  return gbuffer;
}

// Passes over a part of a picture ask about its edges alone.
TEST(Edges, ThoseOfAPartAreThoseOfThePicture) {
  constexpr int kLarge = 120;
  test::Random random(47);
  std::size_t found = 0;
  for (int round = 0; round < 6; ++round) {
    const GBuffer gbuffer = crowd(random, kLarge);
    const std::vector<EdgePixel> all = edgePixels(gbuffer, DepthPlanes(gbuffer, Camera()));
    for (const Window& part : {Window{40, 50, 80, 70}, Window{0, 0, 33, 21}, Window{90, 60, kLarge, kLarge}}) {
      const int around = kEdgeSurroundings;
      const DepthPlanes planes(gbuffer, Camera(),
                               {std::max(part.x0 - around, 0), std::max(part.y0 - around, 0),
                                std::min(part.x1 + around, kLarge), std::min(part.y1 + around, kLarge)});
      auto next = all.begin();
      for (const EdgePixel& edge : edgePixels(gbuffer, planes, part)) {
        const auto outside = [&](const EdgePixel& one) {
          return one.x < part.x0 || one.y < part.y0 || one.x >= part.x1 || one.y >= part.y1;
        };
        next = std::find_if_not(next, all.end(), outside);
        ASSERT_NE(next, all.end());
        EXPECT_EQ(std::tie(edge.x, edge.y, edge.share, edge.nearer.plane.across, edge.farther.plane.down,
                           edge.farther.plane.centre),
                  std::tie(next->x, next->y, next->share, next->nearer.plane.across, next->farther.plane.down,
                           next->farther.plane.centre));
        EXPECT_EQ(edge.nearerPart, next->nearerPart);
        EXPECT_EQ(edge.towardsNearer, next->towardsNearer);
        ++next;
        ++found;
      }
      EXPECT_TRUE(std::all_of(next, all.end(), [&](const EdgePixel& one) {
        return one.x < part.x0 || one.y < part.y0 || one.x >= part.x1 || one.y >= part.y1;
      }));
    }
  }
  EXPECT_GT(found, 1000u);
}

// A front and a back of one colour: nothing but Cryptomatte tells how much of a pixel either has.
TEST(Edges, ObjectsTellWhatColoursDoNot) {
  const Window all{0, 0, kSize, kSize};
  const std::string path = test::freshFolder("edge-objects") + "/p.exr";
  for (const Scene& scene : kScenes)
    for (const bool objects : {false, true}) {
      const GBuffer drawn = scene.picture();
      const Image<float> grey(kSize, kSize, 0.5f), one(kSize, kSize, 1.0f);
      Image<float> id[2] = {grey, grey}, part[2] = {grey, grey};
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double front = scene.share(x, y);
          const bool most = front >= 0.5;  // the larger part comes first
          for (const int k : {0, 1}) {
            const bool isFront = (k == 0) == most;
            part[k].at(x, y) = static_cast<float>(isFront ? front : 1.0 - front);
            id[k].at(x, y) = isFront ? 3.25f : -1.75f;
          }
        }
      std::vector<ExtraLayer> layers = {{"", {{"R", grey}, {"G", grey}, {"B", grey}, {"A", one}, {"Z", drawn.viewZ}}}};
      if (objects) layers.push_back({"crypto_object00", {{"R", id[0]}, {"G", part[0]}, {"B", id[1]}, {"A", part[1]}}});
      writeLayers(path, all, all, layers, {{"cryptomatte/0123456/name", "crypto_object"}});
      const GBuffer gbuffer = readOpaque(path, {}).gbuffer;
      std::size_t inside = 0, mixed = 0;
      for (const EdgePixel& edge : edgePixels(gbuffer, DepthPlanes(gbuffer, Camera()))) {
        if (atBorder(edge.x, edge.y)) continue;
        ++inside;
        EXPECT_NEAR(edge.share, scene.share(edge.x, edge.y), 1e-6);
      }
      for (int y = 1; y < kSize - 1; ++y)
        for (int x = 1; x < kSize - 1; ++x) {
          const double f = scene.share(x, y);
          mixed += f > 0.0 && f < 1.0 ? 1 : 0;
        }
      EXPECT_EQ(inside, objects ? mixed : 0u);
    }
}

// What is not filtered has nothing to take apart, and neither has a colour that is no mixture of its neighbours'.
TEST(Edges, WhatIsNoMixtureStaysWhole) {
  const Scene scene = kScenes[1];
  GBuffer gbuffer = scene.picture();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      gbuffer.beauty.at(x, y) = glm::vec4(scene.inFront(x + 0.5, y + 0.5) ? kFront : kBack);
  EXPECT_TRUE(edgePixels(gbuffer, DepthPlanes(gbuffer, Camera())).empty());
  gbuffer = scene.picture();
  for (std::size_t i = 0; i < gbuffer.beauty.size(); ++i)
    if (gbuffer.beauty[i] != glm::vec4(kFront) && gbuffer.beauty[i] != glm::vec4(kBack))
      gbuffer.beauty[i] = glm::vec4(1.0f, 5.0f, 0.5f, 1.0f);
  EXPECT_TRUE(edgePixels(gbuffer, DepthPlanes(gbuffer, Camera())).empty());
}

}  // namespace
}  // namespace pellucid
