// Nothing may depend on how geometry is cut, ordered or tiled: the same fragments exactly, and planes that differ only
// as float sums do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "composite/denormals.h"
#include "engine_bridge/gl/geometry_stream.h"
#include "tests/gl/clutter.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 150, kHeight = 100;

using Pixel = std::vector<Fragment>;
struct Lists {
  explicit Lists(int wide, int high)
      : width(wide), pixels(static_cast<std::size_t>(wide * high)), solid(pixels.size()), visits(pixels.size()) {}
  int width;
  std::vector<Pixel> pixels;
  std::vector<glm::vec4> solid;
  std::vector<int> visits;
};

bool before(const Fragment& a, const Fragment& b) {
  return std::memcmp(&a, &b, sizeof(Fragment)) < 0;
}

// One sorted list per pixel, whatever the bands were.
Lists gather(const std::vector<FragmentLists>& bands, int width = kWidth, int height = kHeight) {
  Lists lists(width, height);
  for (const FragmentLists& band : bands)
    for (int y = band.window.y0; y < band.window.y1; ++y)
      for (int x = band.window.x0; x < band.window.x1; ++x) {
        const auto local = static_cast<std::size_t>((y - band.window.y0) * band.window.width() + x - band.window.x0);
        const auto pixel = static_cast<std::size_t>(y * lists.width + x);
        ++lists.visits[pixel];
        lists.solid[pixel] = band.solid[local];
        lists.pixels[pixel].assign(band.fragments.begin() + static_cast<std::ptrdiff_t>(band.offsets[local]),
                                   band.fragments.begin() + static_cast<std::ptrdiff_t>(band.offsets[local + 1]));
        std::sort(lists.pixels[pixel].begin(), lists.pixels[pixel].end(), before);
      }
  return lists;
}

std::vector<PassSettings> variations() {
  PassSettings plain;
  std::vector<PassSettings> all(1, plain);
  for (const std::size_t budget : {std::size_t{4} << 10, std::size_t{60} << 10}) {
    all.push_back(plain);
    all.back().budgetBytes = budget;
  }
  for (const int tile : {16, 37, 64}) {
    all.push_back(plain);
    all.back().tile = tile;
  }
  all.push_back(plain);
  all.back().order.kind = SubmissionOrder::reverse;
  for (const std::uint64_t seed : {1, 2}) {
    all.push_back(plain);
    all.back().order = {SubmissionOrder::shuffle, seed};
    if (seed == 2) all.back().budgetBytes = 20 << 10, all.back().tile = 41;
  }
  for (PassSettings& settings : all) settings.surroundings = glm::vec3(0.1f);
  return all;
}

void expectSameBits(const glm::vec4& a, const glm::vec4& b) {
  ASSERT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
}

// Half the edge of the others' picture: with 4 KiB there are some hundred bands, each drawn in some dozen chunks.
TEST(Invariance, FragmentSetsAreIdentical) {
  constexpr int kWide = kWidth / 2, kHigh = kHeight / 2;
  Stage stage = clutter(kWide, kHigh, 120);
  const Lists plain = gather(stage.fragments(variations()[0]), kWide, kHigh);
  std::size_t total = 0, deepest = 0;
  for (const Pixel& pixel : plain.pixels) total += pixel.size(), deepest = std::max(deepest, pixel.size());
  std::printf("fragments %zu, deepest pixel %zu\n", total, deepest);
  ASSERT_GT(deepest, 8u);
  std::size_t mostChunks = 0, mostBands = 0;
  for (const PassSettings& settings : variations()) {
    const Lists lists = gather(stage.fragments(settings), kWide, kHigh);
    mostChunks = std::max(mostChunks, stage.statistics.chunks);
    mostBands = std::max(mostBands, stage.statistics.tiles);
    EXPECT_EQ(stage.statistics.fragments, total);
    for (std::size_t i = 0; i < lists.pixels.size(); ++i) {
      ASSERT_EQ(lists.visits[i], 1) << "pixel " << i;
      expectSameBits(lists.solid[i], plain.solid[i]);
      ASSERT_EQ(lists.pixels[i].size(), plain.pixels[i].size()) << "pixel " << i;
      if (lists.pixels[i].empty()) continue;
      for (std::size_t k = 0; k < lists.pixels[i].size(); ++k) {
        const Fragment &found = lists.pixels[i][k], &expected = plain.pixels[i][k];
        ASSERT_EQ(std::memcmp(&found, &expected, sizeof(Fragment)), 0)
            << "pixel " << i << ", fragment " << k << ": z " << found.z - expected.z << ", radiance "
            << found.radiance.r - expected.radiance.r << ", coverage " << found.coverage - expected.coverage
            << ", transmission " << found.transmission.r - expected.transmission.r << ", identity " << found.identity
            << " and " << expected.identity << "; budget " << settings.budgetBytes << ", tile " << settings.tile
            << ", order " << settings.order.kind;
      }
    }
  }
  EXPECT_GT(mostChunks, 50u);
  EXPECT_GT(mostBands, 100u);
}

// float sums of n terms of one sign: relative error at most n * 2^-24, between two orders twice that.
TEST(Invariance, PlanesAgreeToRounding) {
  Stage stage = clutter(kWidth, kHeight, 120);
  const OitPlanes plain = stage.accumulate(variations()[0]);
  float deepest = 0;
  for (std::size_t i = 0; i < plain.weight.size(); ++i) deepest = std::max(deepest, plain.weight[i].a);
  const float bound = 2.0f * deepest * 0x1p-24f;
  double worst = 0;
  for (const PassSettings& settings : variations()) {
    const OitPlanes planes = stage.accumulate(settings);
    EXPECT_EQ(planes.info.solidHash, plain.info.solidHash);
    for (std::size_t i = 0; i < planes.weight.size(); ++i) {
      ASSERT_EQ(planes.frontZ[i], plain.frontZ[i]);
      expectSameBits(planes.solid[i], plain.solid[i]);
      ASSERT_EQ(planes.weight[i].a, plain.weight[i].a);
      const auto pairs = {std::pair(&planes.radiance, &plain.radiance), std::pair(&planes.weight, &plain.weight),
                          std::pair(&planes.opacity, &plain.opacity), std::pair(&planes.depth, &plain.depth),
                          std::pair(&planes.light, &plain.light)};
      for (const auto& [a, b] : pairs)
        for (int c = 0; c < 4; ++c) {
          const float left = (*a)[i][c], right = (*b)[i][c];
          ASSERT_LE(std::abs(left - right), bound * std::abs(right));
          if (right != 0) worst = std::max(worst, static_cast<double>(std::abs(left - right) / std::abs(right)));
        }
    }
  }
  std::printf("planes: worst relative difference %.2e, bound %.2e\n", worst, static_cast<double>(bound));
}

TEST(Invariance, TwoRunsAreTheSameBits) {
  Stage stage = clutter(kWidth, kHeight, 60);
  const OitPlanes a = stage.accumulate(), b = stage.accumulate();
  for (std::size_t i = 0; i < a.radiance.size(); ++i) expectSameBits(a.radiance[i], b.radiance[i]);
}

// Two paths through the same stage: blended, and listed then added on the CPU.
TEST(Invariance, SumsOverTheListsAreThePlanes) {
  Stage stage = clutter(kWidth, kHeight, 120);
  PassSettings settings;
  settings.surroundings = glm::vec3(0.1f);
  const OitPlanes planes = stage.accumulate(settings);
  const Lists lists = gather(stage.fragments(settings));
  const FlushDenormals flush;
  double worst = 0;
  for (std::size_t i = 0; i < lists.pixels.size(); ++i) {
    glm::dvec4 sums[5] = {};
    float front = kSky;
    for (const Fragment& fragment : lists.pixels[i]) {
      const shading::Layer layer{fragment.radiance, fragment.coverage, fragment.transmission, fragment.z};
      const shading::OitTargets added =
          shading::packSums(shading::layerSums(layer, settings.weight, settings.normalisation));
      sums[0] += added.radiance, sums[1] += added.weight, sums[2] += added.opacity;
      sums[3] += added.depth, sums[4] += added.light;
      front = std::min(front, fragment.z);
    }
    ASSERT_EQ(planes.frontZ[i], front) << "pixel " << i;
    ASSERT_EQ(planes.weight[i].a, static_cast<float>(lists.pixels[i].size())) << "pixel " << i;
    expectSameBits(planes.solid[i], lists.solid[i]);
    const glm::vec4 blended[] = {planes.radiance[i], planes.weight[i], planes.opacity[i], planes.depth[i],
                                 planes.light[i]};
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 4; ++c) {
        const double bound = static_cast<double>(lists.pixels[i].size() + 1) * 0x1p-24;
        const double difference = std::abs(static_cast<double>(blended[k][c]) - sums[k][c]);
        ASSERT_LE(difference, bound * std::abs(sums[k][c])) << "pixel " << i << " plane " << k << " channel " << c;
        if (sums[k][c] != 0) worst = std::max(worst, difference / std::abs(sums[k][c]));
      }
  }
  std::printf("lists against planes: worst relative difference %.2e\n", worst);
}

TEST(Invariance, IdentityNamesInstanceAndTriangle) {
  Stage stage = clutter(kWidth, kHeight, 120);
  std::map<std::uint32_t, int> perPixelTwins;
  std::set<std::uint32_t> seen;
  for (const FragmentLists& lists : stage.fragments())
    for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i) {
      std::set<std::uint32_t> here;
      for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) {
        here.insert(lists.fragments[k].identity);
        seen.insert(lists.fragments[k].identity);
      }
      // A triangle covers a sample once at most.
      ASSERT_EQ(here.size(), lists.offsets[i + 1] - lists.offsets[i]);
    }
  std::printf("%zu identities\n", seen.size());
  EXPECT_GT(seen.size(), 500u);
  EXPECT_LE(seen.size(), 4u * 3u * 120u);
}

// A grid of one pixel per triangle pair, larger than any batch that a driver may split a draw into.
TEST(Invariance, TriangleNumbersSurviveLargeDraws) {
  Stage stage(256, 128);
  Primitive grid;
  grid.material = stage.add(unlitBlend({1, 1, 1}, 0.5f));
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 256; ++x) {
      const auto first = static_cast<std::uint32_t>(grid.vertices.size());
      // One triangle around each pixel's centre.
      for (const glm::vec2 corner : {glm::vec2(0.1, 0.9), glm::vec2(0.9, 0.9), glm::vec2(0.5, 0.1)}) {
        Vertex vertex{};
        vertex.position = stage.at(static_cast<double>(static_cast<float>(x) + corner.x),
                                   static_cast<double>(static_cast<float>(y) + corner.y), 2.0);
        vertex.normal = {0, 0, 1};
        vertex.colour = glm::vec4(1.0f);
        grid.vertices.push_back(vertex);
      }
      for (std::uint32_t i = 0; i < 3; ++i) grid.indices.push_back(first + i);
    }
  stage.place(std::move(grid));
  PassSettings shuffled;
  shuffled.order = {SubmissionOrder::shuffle, 3};
  std::vector<std::uint32_t> identities[2];
  const PassSettings settings[2] = {{}, shuffled};
  for (int i = 0; i < 2; ++i)
    for (const FragmentLists& lists : stage.fragments(settings[i]))
      for (const Fragment& fragment : lists.fragments) identities[i].push_back(fragment.identity);
  ASSERT_EQ(identities[0].size(), 256u * 128u);
  EXPECT_EQ(identities[0], identities[1]);
  std::sort(identities[0].begin(), identities[0].end());
  const auto last = std::unique(identities[0].begin(), identities[0].end());
  // 32-bit hashes of 32768 triangles: 0.1 collisions expected.
  EXPECT_GE(last - identities[0].begin(), 256 * 128 - 2);
}

TEST(Stream, EveryTriangleOnceWithinTheBudget) {
  const Stage stage = clutter(kWidth, kHeight, 200);
  for (const auto kind : {SubmissionOrder::file, SubmissionOrder::reverse, SubmissionOrder::shuffle})
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{5000}, std::size_t{1} << 30}) {
      gl::ChunkCutter cutter(stage.scene, {kind, 9}, bytes);
      gl::ChunkData chunk;
      std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
      std::size_t submitted = 0, chunks = 0;
      while (cutter.next(chunk)) {
        ++chunks;
        if (bytes == 1) {
          EXPECT_EQ(chunk.triangleNumbers.size(), 1u);
        } else {
          EXPECT_LE(chunk.bytes(), bytes);
        }
        for (const gl::ChunkDraw& draw : chunk.draws)
          for (std::uint32_t t = draw.firstTriangle; t < draw.firstTriangle + draw.triangles; ++t) {
            ++submitted;
            seen.emplace(draw.instance, chunk.triangleNumbers[t]);
            const Primitive& primitive =
                stage.scene.primitives[static_cast<std::size_t>(stage.scene.instances[draw.instance].primitive)];
            for (std::size_t c = 0; c < 3; ++c) {
              const Vertex& expected = primitive.vertices[primitive.indices[3 * chunk.triangleNumbers[t] + c]];
              ASSERT_EQ(std::memcmp(&chunk.vertices[chunk.indices[3 * t + c]], &expected, sizeof(Vertex)), 0);
            }
          }
      }
      EXPECT_EQ(submitted, 4u * 3u * 200u);
      EXPECT_EQ(seen.size(), submitted);
      if (bytes == std::size_t{1} << 30) {
        EXPECT_EQ(chunks, 1u);
      }
    }
}

// Instances of one mesh share its vertices: a forest costs one tree.
TEST(Stream, InstancesShareVertices) {
  const Stage stage = clutter(kWidth, kHeight, 200);
  gl::ChunkCutter cutter(stage.scene, {}, std::size_t{1} << 30);
  gl::ChunkData chunk;
  ASSERT_TRUE(cutter.next(chunk));
  EXPECT_EQ(chunk.triangleNumbers.size(), 4u * 200u);
  EXPECT_EQ(chunk.draws.size(), 12u);
}

TEST(Stream, OrdersDiffer) {
  const Stage stage = clutter(kWidth, kHeight, 200);
  std::vector<std::uint32_t> orders[4];
  const SubmissionOrder kinds[] = {{SubmissionOrder::file, 0},
                                   {SubmissionOrder::reverse, 0},
                                   {SubmissionOrder::shuffle, 1},
                                   {SubmissionOrder::shuffle, 2}};
  for (int i = 0; i < 4; ++i) {
    gl::ChunkCutter cutter(stage.scene, kinds[i], std::size_t{1} << 30);
    gl::ChunkData chunk;
    cutter.next(chunk);
    for (const gl::ChunkDraw& draw : chunk.draws)
      for (std::uint32_t t = 0; t < draw.triangles; ++t)
        orders[i].push_back(draw.instance * 1000u + chunk.triangleNumbers[draw.firstTriangle + t]);
  }
  EXPECT_TRUE(std::equal(orders[0].begin(), orders[0].end(), orders[1].rbegin(), orders[1].rend()));
  EXPECT_NE(orders[0], orders[2]);
  EXPECT_NE(orders[2], orders[3]);
}

}  // namespace
}  // namespace pellucid::test
