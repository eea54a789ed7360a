// Every pixel of a mesh exactly once: triangles share their edges vertex by vertex, so a pixel that is missed or met
// twice is a hole or a seam, whatever the triangles look like.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// Layers of every pixel.
Image<int> countLayers(Stage& stage, GlContext& context, glm::dvec2 sample) {
  PassSettings settings;
  settings.sample = sample;
  Image<int> count(stage.gbuffer.data.width(), stage.gbuffer.data.height(), 0);
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  pass.fragments(settings, [&](const FragmentLists& lists) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i)
        count.at(x, y) += static_cast<int>(lists.offsets[i + 1] - lists.offsets[i]);
  });
  return count;
}

struct Tally {
  std::size_t pixels = 0, missed = 0, doubled = 0;
  void add(int layers) {
    ++pixels;
    missed += layers == 0;
    doubled += layers > 1;
  }
};

Vertex vertexAt(glm::vec3 position) {
  Vertex vertex{};
  vertex.position = position;
  vertex.normal = {0, 0, 1};
  vertex.colour = glm::vec4(1.0f);
  return vertex;
}

// A mesh in the picture's plane, pixels.
struct FlatMesh {
  std::vector<glm::dvec2> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

double leastHeight(const std::array<glm::dvec2, 3>& p) {
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
  const double area = std::abs(a.x * b.y - a.y * b.x);
  return area / std::max({glm::length(a), glm::length(b), glm::length(p[2] - p[1])});
}

// A rectangle, its triangles split at points inside them, most of them around one place.
FlatMesh splitRectangle(glm::dvec2 low, glm::dvec2 high, int splits, double least, Random& random) {
  FlatMesh mesh;
  mesh.points = {low, {high.x, low.y}, high, {low.x, high.y}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  for (int i = 0; i < splits; ++i) {
    // The younger, the smaller.
    const double old = random.uniform();
    const auto chosen = static_cast<std::size_t>((1.0 - old * old * old) * static_cast<double>(mesh.triangles.size()));
    auto& triangle = mesh.triangles[std::min(chosen, mesh.triangles.size() - 1)];
    double w[3], sum = 0.0;
    for (double& one : w) sum += one = 0.02 + random.uniform();
    const glm::dvec2 a = mesh.points[triangle[0]], b = mesh.points[triangle[1]], c = mesh.points[triangle[2]];
    const glm::dvec2 p = (w[0] * a + w[1] * b + w[2] * c) / sum;
    if (std::min({leastHeight({a, b, p}), leastHeight({b, c, p}), leastHeight({c, a, p})}) < least) continue;
    const auto at = static_cast<std::uint32_t>(mesh.points.size());
    const std::array<std::uint32_t, 3> whole = triangle;
    mesh.points.push_back(p);
    triangle = {whole[0], whole[1], at};
    mesh.triangles.push_back({whole[1], whole[2], at});
    mesh.triangles.push_back({whole[2], whole[0], at});
  }
  return mesh;
}

// Needles from a point to the border of a rectangle.
FlatMesh fan(glm::dvec2 low, glm::dvec2 high, std::uint32_t needles, Random& random) {
  FlatMesh mesh;
  mesh.points = {low + (high - low) * glm::dvec2(0.2 + 0.6 * random.uniform(), 0.2 + 0.6 * random.uniform())};
  const glm::dvec2 size = high - low;
  for (std::uint32_t i = 0; i < needles; ++i) {
    const double along = 4.0 * i / needles, part = along - std::floor(along);
    const int side = static_cast<int>(along);
    const glm::dvec2 corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    mesh.points.push_back(low + size * glm::mix(corner[side], corner[side + 1], part));
    mesh.triangles.push_back({0, (i + 1) % needles + 1, i + 1});
  }
  return mesh;
}

void place(Stage& stage, const FlatMesh& mesh, double z, double tilt, int material) {
  Primitive primitive;
  primitive.material = material;
  for (const glm::dvec2& p : mesh.points) {
    // A plane through 1 / z, so that straight lines of the picture stay straight.
    const double depth = 1.0 / (1.0 / z + tilt / z * (p.x - p.y) / stage.gbuffer.display.width());
    primitive.vertices.push_back(vertexAt(stage.at(p.x, p.y, depth)));
  }
  for (const auto& triangle : mesh.triangles)
    primitive.indices.insert(primitive.indices.end(), triangle.begin(), triangle.end());
  stage.place(std::move(primitive));
}

TEST(Holes, EveryPixelOfAThousandMeshesExactlyOnce) {
  constexpr int kBlock = 16, kBlocks = 8, kEdge = kBlock * kBlocks;
  GlContext context;
  Random random(17);
  Tally tally;
  std::size_t meshes = 0, triangles = 0;
  for (int batch = 0; batch < 16; ++batch) {
    Stage stage(kEdge, kEdge);
    stage.camera.orthographic = batch % 4 == 3;
    const int material = stage.add(unlitBlend({1, 0, 0}, 0.5f));
    for (int block = 0; block < kBlocks * kBlocks; ++block, ++meshes) {
      const glm::dvec2 low(block % kBlocks * kBlock, block / kBlocks * kBlock), high = low + double{kBlock};
      const double z = std::pow(10.0, 8.0 * random.uniform() - 4.0),
                   tilt = batch % 2 == 0 ? 0.0 : random.uniform() - 0.5;
      FlatMesh mesh;
      if (block % 8 == 7)
        mesh = fan(low, high, block == 63 ? 20000u : 16u << random.below(7), random);
      else
        mesh = splitRectangle(low, high, 400, block % 2 == 0 ? 1e-3 : 0.05, random);
      triangles += mesh.triangles.size();
      place(stage, mesh, z, tilt, material);
    }
    const glm::dvec2 sample =
        batch == 0 ? glm::dvec2(0.5) : glm::dvec2(0.02 + 0.96 * random.uniform(), 0.02 + 0.96 * random.uniform());
    const Image<int> count = countLayers(stage, context, sample);
    for (std::size_t i = 0; i < count.size(); ++i) tally.add(count[i]);
  }
  std::printf("%zu meshes of %zu triangles: %zu pixels, %zu missed, %zu doubled\n", meshes, triangles, tally.pixels,
              tally.missed, tally.doubled);
  EXPECT_EQ(tally.missed, 0u);
  EXPECT_EQ(tally.doubled, 0u);
}

// A square far larger than the picture, cut into cells of moved corners.
Primitive jitteredGrid(int cells, double half, double jitter, const std::function<glm::vec3(double, double)>& at,
                       Random& random) {
  Primitive primitive;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const bool border = i == 0 || j == 0 || i == cells || j == cells;
      const double step = 2.0 * half / cells, move = border ? 0.0 : jitter * step;
      primitive.vertices.push_back(vertexAt(
          at(-half + i * step + move * (random.uniform() - 0.5), -half + j * step + move * (random.uniform() - 0.5))));
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (cells + 1) + i), row = static_cast<std::uint32_t>(cells + 1);
      for (const std::uint32_t k : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) primitive.indices.push_back(k);
    }
  return primitive;
}

// The pixel of an HD picture five metres away, and vertices up to kilometres from their mesh's origin.
TEST(Holes, VerticesFarFromTheirOrigin) {
  GlContext context;
  Random random(5);
  for (const double offset : {0.0, 100.0, 1024.0, 4096.0})
    for (int trial = 0; trial < 8; ++trial) {
      Stage stage(64, 64);
      const double pixel = 3e-3, z = 5.0;
      stage.camera.focal = glm::dvec2(z / (pixel * 32));
      glm::dvec3 away(0.0);
      away[trial % 3] = offset;
      Primitive primitive = jitteredGrid(
          4 + trial * 2, pixel * 64, 0.5, [&](double x, double y) { return glm::vec3(glm::dvec3(x, y, -z) + away); },
          random);
      primitive.material = stage.add(unlitBlend({1, 0, 0}, 0.5f));
      stage.place(std::move(primitive)).worldFromObject[3] = glm::dvec4(-away, 1.0);
      Tally tally;
      const Image<int> count = countLayers(stage, context, {random.uniform(), random.uniform()});
      for (std::size_t i = 0; i < count.size(); ++i) tally.add(count[i]);
      EXPECT_EQ(tally.missed, 0u) << offset << " m, trial " << trial;
      EXPECT_EQ(tally.doubled, 0u) << offset << " m, trial " << trial;
    }
}

// Floors that pass under the eye: corners behind it, far outside the picture, and beside it.
TEST(Holes, TrianglesThatPassTheEye) {
  GlContext context;
  Random random(9);
  Tally tally;
  for (int trial = 0; trial < 24; ++trial) {
    Stage stage(96, 64);
    const double height = std::pow(10.0, 3.0 * random.uniform() - 2.0), half = 400.0 * height;
    const int cells = 1 + trial % 12 * 3;
    Primitive primitive = jitteredGrid(
        cells, half, 0.4, [&](double x, double y) { return glm::vec3(x, -height, -y); }, random);
    primitive.material = stage.add(unlitBlend({1, 0, 0}, 0.5f));
    stage.place(std::move(primitive));
    const glm::dvec2 sample(random.uniform(), random.uniform());
    const Image<int> count = countLayers(stage, context, sample);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        const double down = -(1.0 - 2.0 * (y + sample.y) / 64) / stage.camera.focal.y;
        const double aside = (2.0 * (x + sample.x) / 96 - 1.0) / stage.camera.focal.x;
        if (down <= 0.0) {
          EXPECT_EQ(count.at(x, y), 0);
        } else if (height / down < 0.9 * half && std::abs(aside) * height / down < 0.9 * half) {
          tally.add(count.at(x, y));
        }
      }
  }
  std::printf("floors: %zu pixels, %zu missed, %zu doubled\n", tally.pixels, tally.missed, tally.doubled);
  EXPECT_GT(tally.pixels, 50000u);
  EXPECT_EQ(tally.missed, 0u);
  EXPECT_EQ(tally.doubled, 0u);
}

}  // namespace
}  // namespace pellucid::test
