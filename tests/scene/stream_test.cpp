// Triangles that stay in their file are the same triangles, to the bit, and only so much of the file is in memory.
#include "engine_bridge/scene/triangle_source.h"

#include <algorithm>
#include <limits>

#include "engine_bridge/scene/mapped_file.h"
#include "tests/scene/gltf_builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

// Less than a window of pages: nearly every read lets go of the one before.
SceneOptions streaming(std::size_t bytes = std::size_t{64} << 10) {
  SceneOptions options;
  options.streamBytes = bytes;
  return options;
}

// Corners of all triangles in order, read `step` triangles at a time.
std::vector<Vertex> cornersOf(const Primitive& primitive, std::size_t step) {
  VertexPlaces places;
  TriangleBatch batch;
  std::vector<Vertex> corners;
  for (std::size_t first = 0; first < primitive.triangles(); first += step) {
    readTriangles(primitive, first, std::min(step, primitive.triangles() - first), places, batch);
    EXPECT_LE(batch.vertices.size(), 3 * step);
    for (const std::uint32_t i : batch.indices) corners.push_back(batch.vertices.at(i));
  }
  return corners;
}

void expectTheSame(const Scene& streamed, const Scene& decoded) {
  ASSERT_EQ(streamed.primitives.size(), decoded.primitives.size());
  ASSERT_EQ(streamed.notes, decoded.notes);
  for (std::size_t p = 0; p < decoded.primitives.size(); ++p) {
    const Primitive &one = streamed.primitives[p], &other = decoded.primitives[p];
    ASSERT_TRUE(one.streamed && !other.streamed && one.vertices.empty());
    ASSERT_EQ(one.triangles(), other.triangles());
    EXPECT_EQ(one.material, other.material);
    EXPECT_EQ(coloursOf(one).least, coloursOf(other).least);
    EXPECT_EQ(coloursOf(one).most, coloursOf(other).most);
    const std::vector<Vertex> expected = cornersOf(other, other.triangles());
    for (const std::size_t step : {std::size_t{13}, std::size_t{1000}, std::size_t{5000}}) {
      const std::vector<Vertex> found = cornersOf(one, step);
      ASSERT_EQ(found.size(), expected.size());
      ASSERT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Vertex)), 0) << "step " << step;
    }
  }
}

// A cloud of triangles with every attribute; some without area, some not finite, some values out of range.
Builder cloud(int mode, bool normals, bool scattered, bool faults) {
  constexpr std::uint32_t kVertices = 2800, kCorners = 4200;
  Random random(static_cast<std::uint64_t>(mode) + 1);
  std::vector<float> positions, directions, uvs, along;
  std::vector<std::uint8_t> colours;
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    for (int c = 0; c < 3; ++c) positions.push_back(random.uniformf());
    for (int c = 0; c < 3; ++c) directions.push_back(random.uniformf() - 0.5f);
    for (int c = 0; c < 3; ++c) along.push_back(random.uniformf() - 0.5f);
    along.push_back(random.uniformf() < 0.5f ? -1.0f : 1.0f);
    for (int c = 0; c < 2; ++c) uvs.push_back(random.uniformf());
    for (int c = 0; c < 4; ++c) colours.push_back(static_cast<std::uint8_t>(255.0f * random.uniformf()));
    if (faults && i % 40 == 7) positions.back() = std::numeric_limits<float>::infinity();
    if (faults && i % 50 == 9) std::fill(directions.end() - 3, directions.end(), 0.0f);
    if (faults && i % 60 == 11) uvs.back() = 1e30f;
  }
  std::vector<std::uint16_t> indices;
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const std::uint32_t place = i * kVertices / kCorners;
    indices.push_back(static_cast<std::uint16_t>(scattered ? static_cast<std::uint32_t>(random.uniformf() * kVertices)
                                                           : std::min(place + i % 3, kVertices - 1)));
    if (faults && i % 30 == 5) indices.back() = indices[indices.size() - 2];
  }
  Builder builder;
  nlohmann::json attributes = {{"POSITION", builder.floats(positions, "VEC3", 3)},
                               {"TEXCOORD_0", builder.floats(uvs, "VEC2", 2)},
                               {"COLOR_0", builder.accessor(colours, 5121, "VEC4", 4, true)}};
  if (normals) attributes["NORMAL"] = builder.floats(directions, "VEC3", 3);
  if (normals) attributes["TANGENT"] = builder.floats(along, "VEC4", 4);
  Json& primitive = builder.mesh(attributes);
  primitive["mode"] = mode;
  primitive["indices"] = builder.indices(indices);
  // Once more, seen in a mirror.
  builder.json["nodes"].push_back({{"mesh", 0}, {"scale", {-1.0, 1.0, 1.0}}});
  return builder;
}

TEST(Streaming, TrianglesAreThoseOfTheDecodedFile) {
  for (const int mode : {4, 5, 6})
    for (const bool normals : {true, false})
      for (const bool scattered : {true, false})
        for (const bool faults : {true, false}) {
          SCOPED_TRACE(::testing::Message() << mode << normals << scattered << faults);
          Builder builder = cloud(mode, normals, scattered, faults);
          const Scene decoded = builder.load();
          EXPECT_EQ(decoded.primitives.size(), 2u);
          expectTheSame(builder.load(streaming()), decoded);
        }
}

TEST(Streaming, SparseAndAbsentBuffersToo) {
  Builder builder;
  Json& primitive = builder.triangle();
  primitive["indices"] = builder.indices({0, 1, 2, 2, 1, 0});
  const std::vector<std::uint32_t> which = {1};
  const std::vector<float> value = {2, 0, 0};
  const int indexView = builder.view(which.data(), 4), valueView = builder.view(value.data(), 12);
  builder.json["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indexView}, {"componentType", 5125}}},
                                            {"values", {{"bufferView", valueView}}}};
  const Scene decoded = builder.load();
  EXPECT_EQ(cornersOf(decoded.primitives.at(0), 1)[1].position.x, 2.0f);
  expectTheSame(builder.load(streaming()), decoded);
}

TEST(Streaming, WhatIsRefusedStaysRefused) {
  Builder builder;
  Json& primitive = builder.triangle();
  primitive["indices"] = builder.indices({0, 1, 9});
  expectRefusal(refusalOf(builder, streaming()), 3, {"indices", "9", "below 3"});
}

// A file that is overwritten while it is drawn cannot make anybody read beyond its vertices.
TEST(Streaming, AFileThatChangesIsAnError) {
  for (const bool shrinks : {true, false}) {
    Builder builder = cloud(4, true, false, false);
    const std::string path = builder.writeGlb();
    const Scene scene = loadScene({path}, streaming());
    const auto size = std::filesystem::file_size(path);
    if (shrinks) {
      std::filesystem::resize_file(path, 4096);
    } else {
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      file.seekp(static_cast<std::streamoff>(size) - 18000);  // the indices
      for (int i = 0; i < 18000; ++i) file.put('\xff');
    }
    const Refusal refusal = refusalOf([&] { cornersOf(scene.primitives.at(0), 1000); });
    std::printf("%s\n", refusal.sentence.c_str());
    expectRefusal(refusal, 3, {"scene.glb", shrinks ? "cut short" : "changed"});
  }
}

std::size_t statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key) {
      std::size_t kilobytes = 0;
      status >> kilobytes;
      return kilobytes << 10;
    }
  return 0;
}

// 2 million triangles in an order that jumps all over a file of 100 MB, with 8 MiB of it in memory at a time.
TEST(Streaming, PagesStayWithinTheirShare) {
  constexpr std::uint32_t kVertices = 1u << 21;
  for (const bool scattered : {false, true}) {
    Builder builder;
    std::vector<std::uint32_t> indices;
    std::vector<float> positions(std::size_t{3} * kVertices), normals(std::size_t{3} * kVertices, 1.0f);
    Random random(5);
    for (float& p : positions) p = random.uniformf();
    const std::uint32_t triangles = scattered ? 4000u : kVertices;
    for (std::uint32_t t = 0; t < triangles; ++t)
      for (std::uint32_t c = 0; c < 3; ++c)
        indices.push_back(scattered ? static_cast<std::uint32_t>(random.uniformf() * (kVertices - 1))
                                    : std::min(t + c, kVertices - 1));
    Json& primitive = builder.mesh(
        {{"POSITION", builder.floats(positions, "VEC3", 3)}, {"NORMAL", builder.floats(normals, "VEC3", 3)}});
    primitive["indices"] = builder.accessor(indices, 5125, "SCALAR", 1);
    const std::string path = builder.writeGlb();
    builder = Builder();
    positions = normals = {};
    indices = {};
    std::size_t most = 0;
    const std::size_t before = statusBytes("RssFile:");
    const Scene scene = loadScene({path}, streaming(std::size_t{8} << 20));
    most = statusBytes("RssFile:");
    VertexPlaces places;
    TriangleBatch batch;
    for (std::size_t first = 0; first + 1000 <= scene.primitives.at(0).triangles(); first += 1000) {
      readTriangles(scene.primitives[0], first, 1000, places, batch);
      if (first % (scattered ? 1000 : 50000) == 0) most = std::max(most, statusBytes("RssFile:"));
    }
    std::printf("%s: %zu KiB of a file of %ju KiB in memory at most\n", scattered ? "scattered" : "in order",
                (most - std::min(before, most)) >> 10, std::filesystem::file_size(path) >> 10);
    // The share, and windows of one triangle that the share has no room for: four arrays, three corners.
    EXPECT_LE(most, before + (std::size_t{8} << 20) + 12 * PageLedger::kWindow);
  }
}

}  // namespace
}  // namespace pellucid::test
