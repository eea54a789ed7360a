// Pictures whose colour is filtered over edges while their depth is one sample a pixel: an antialiased post before a
// wall, and glass behind it, before it and between them, against the closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kSize = 32, kFine = 32;
constexpr double kPostZ = 3.0, kWallZ = 10.0;
constexpr float kNothing = std::numeric_limits<float>::infinity();
const glm::dvec3 kPost(0.02, 0.03, 0.01), kWall(2.0, 1.6, 1.1);
const glm::dvec3 kGlass(0.1, 0.2, 0.3);
constexpr double kAlpha = 0.7;

// Left of a slanted line stands the post.
struct Edge {
  double across = 1.0, down = 0.13, at = 0.17;
  bool isPost(double x, double y) const { return across * (x / kSize - 0.5) - down * (y / kSize - 0.5) < at; }
  double share(int x, int y) const {  // of the post in a pixel, by the box filter
    int inside = 0;
    for (int v = 0; v < kFine; ++v)
      for (int u = 0; u < kFine; ++u) inside += isPost(x + (u + 0.5) / kFine, y + (v + 0.5) / kFine) ? 1 : 0;
    return static_cast<double>(inside) / (kFine * kFine);
  }
};

class Edges : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-edges"); }
  std::string path(const char* name) const { return folder + "/" + name; }

  // Before a wall, or before nothing at all.
  void writePost(const Edge& edge, bool wall = true) {
    std::vector<Image<float>> planes(5, Image<float>(kSize, kSize));
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double f = edge.share(x, y);
        const glm::dvec3 colour = f * kPost + (wall ? (1.0 - f) * kWall : glm::dvec3(0.0));
        for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].at(x, y) = static_cast<float>(colour[c]);
        planes[3].at(x, y) = static_cast<float>(wall ? 1.0 : f);
        planes[4].at(x, y) = edge.isPost(x + 0.5, y + 0.5) ? static_cast<float>(kPostZ)
                             : wall                        ? static_cast<float>(kWallZ)
                                                           : kNothing;
      }
    const Window window{0, 0, kSize, kSize};
    writeLayers(path("post.exr"), window, window,
                {{"", {{"R", planes[0]}, {"G", planes[1]}, {"B", planes[2]}, {"A", planes[3]}, {"Z", planes[4]}}}});
  }
  void writeGlass(double z) {
    const auto far = static_cast<float>(-z);
    writeGlb(path("glass.glb"), {Quad{{-60, -60, far},
                                      {120, 0, 0},
                                      {0, 120, 0},
                                      unlit(static_cast<float>(kGlass.r), static_cast<float>(kGlass.g),
                                            static_cast<float>(kGlass.b), static_cast<float>(kAlpha))}});
  }
  Request request(int passes, const std::string& method = "over") {
    Request request = requestOf(path("post.exr"), path("glass.glb"));
    request.method = method;
    request.paint = paintOf(method);
    if (auto* samples = std::get_if<PaintSamples>(&request.paint)) samples->settings.samples = 4096;
    request.passes = passes;
    return request;
  }
  static Picture run(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture;
  }
  // Glass at distance z, where the post and the wall have these shares.
  static glm::dvec4 expected(double f, double z, bool wall = true) {
    const glm::dvec4 post(kPost, 1.0), behind = wall ? glm::dvec4(kWall, 1.0) : glm::dvec4(0.0);
    const auto through = [](const glm::dvec4& c) { return kAlpha * glm::dvec4(kGlass, 1.0) + (1.0 - kAlpha) * c; };
    return f * (z < kPostZ ? through(post) : post) + (1.0 - f) * (z < kWallZ ? through(behind) : behind);
  }
  struct Error {
    double mean = 0.0, worst = 0.0, elsewhere = 0.0;
  };
  static Error errorOf(const Picture& picture, const Edge& edge, double z, bool wall = true) {
    Error error;
    int pixels = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double f = edge.share(x, y);
        const glm::dvec4 off = glm::abs(glm::dvec4(picture.rgba.at(x, y)) - expected(f, z, wall));
        const double largest = std::max({off.r, off.g, off.b, off.a});
        if (f == 0.0 || f == 1.0) {
          error.elsewhere = std::max(error.elsewhere, largest);
          continue;
        }
        // At the picture's border an edge may have no pixel on its other side.
        if (x == 0 || y == 0 || x == kSize - 1 || y == kSize - 1) continue;
        ++pixels;
        error.mean += largest;
        error.worst = std::max(error.worst, largest);
      }
    error.mean /= std::max(pixels, 1);
    return error;
  }
  std::string folder;
};

TEST_F(Edges, APostAndGlassBeforeBetweenAndBehind) {
  for (const Edge& edge : {Edge{}, Edge{1.0, 0.0, 0.013}, Edge{0.3, 1.0, -0.05}, Edge{-0.7, 0.7, 0.1}}) {
    writePost(edge);
    for (const double z : {2.0, 5.0, 12.0})
      for (const int passes : {2, 8, 64}) {
        SCOPED_TRACE(testing::Message() << "glass at " << z << ", --aa " << passes);
        writeGlass(z);
        const Error error = errorOf(run(request(passes)), edge, z);
        EXPECT_LE(error.mean, 1e-6);
        EXPECT_LE(error.worst, 1e-5);
        EXPECT_LE(error.elsewhere, 1e-6);
      }
  }
}

TEST_F(Edges, AreFarOffWhereTheyAreLeftAsTheyAre) {
  const Edge edge;
  writePost(edge);
  writeGlass(5.0);
  Request off = request(8);
  off.edges = EdgeRule::off;
  EXPECT_GT(errorOf(run(off), edge, 5.0).mean, 0.1);
  EXPECT_GT(errorOf(run(request(1)), edge, 5.0).mean, 0.1) << "one pass sees one surface";
}

TEST_F(Edges, ByEveryMethod) {
  const Edge edge;
  writePost(edge);
  writeGlass(5.0);
  for (const char* method :
       {"phenomenological", "weighted", "average", "sum", "mlab:4", "moments:4", "wavelet:2", "front+tail"}) {
    SCOPED_TRACE(method);
    EXPECT_LE(errorOf(run(request(8, method)), edge, 5.0).worst, 2e-3);
  }
  for (const bool onDevice : {false, true}) {
    Request samples = request(8, "stochastic");
    std::get<PaintSamples>(samples.paint).onDevice = onDevice;
    EXPECT_LE(errorOf(run(samples), edge, 5.0).worst, 5e-3) << "the noise of 4096 samples";
  }
  Request within = request(8);
  within.paint = PaintWithin{0.01};
  EXPECT_LE(errorOf(run(within), edge, 5.0).worst, 0.01);
}

TEST_F(Edges, BeforeNothingTheAlphaIsRightToo) {
  const Edge edge;
  writePost(edge, false);
  for (const double z : {2.0, 5.0}) {
    writeGlass(z);
    const Error error = errorOf(run(request(8)), edge, z, false);
    EXPECT_LE(error.worst, 1e-5) << z;
    EXPECT_LE(error.elsewhere, 1e-6) << z;
  }
}

TEST_F(Edges, PixelsKeepTheirBitsWhereNothingIsTransparent) {
  const Edge edge;
  writePost(edge);
  writeGlb(path("glass.glb"), {Quad{{-1, -0.2f, -5}, {2, 0, 0}, {0, 0.4f, 0}, unlit(1, 1, 1, 0.5f)}});
  const Request asked = request(8);
  Compositor compositor(asked);
  const Result result = compositor.run(asked);
  const Image<glm::vec4>& before = compositor.shot().opaque.gbuffer.beauty;
  int untouched = 0;
  const Veil veil = widened(result.veil, result.dataWindow);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!result.picture.touched[i]) {
      ++untouched;
      EXPECT_EQ(result.picture.rgba[i], before[i]);
      EXPECT_EQ(veil.transmission[i], glm::vec3(1.0f));
    }
  EXPECT_GT(untouched, kSize * kSize / 2);
}

// Every pixel of so small a picture is a probe, and all passes are probed: what the fit says that the picture errs by
// is what it errs by, edges included. The panes cross before, behind and at the post, so that most of the error lies
// there.
TEST_F(Edges, TheFitOfTheWeightSeesThemAsThePassesDo) {
  writePost(Edge{});
  writeGlb(path("glass.glb"), {Quad{{-0.2f, -9, -9}, {0, 18, 0}, {1.5f, 0, 8}, unlit(0.9f, 0.1f, 0.1f, 0.6f)},
                               Quad{{-0.3f, -9, -4}, {0, 18, 0}, {2.0f, 0, 0}, unlit(0.1f, 0.2f, 0.9f, 0.5f)},
                               Quad{{-0.3f, -9, -5}, {0, 18, 0}, {2.5f, 0, 0}, unlit(0.1f, 0.9f, 0.2f, 0.5f)},
                               Quad{{-0.3f, -9, -2}, {0, 18, 0}, {1.0f, 0, 0}, unlit(0.5f, 0.9f, 0.2f, 0.4f)}});
  Request asked = request(4, "phenomenological");
  asked.measure = true;
  std::string said;
  Compositor compositor(asked, [&](const std::string& note) { said += note + "\n"; });
  const Result result = compositor.run(asked);
  const auto at = said.find("--weight auto");
  ASSERT_NE(at, std::string::npos) << said;
  double mean = 0.0;
  std::size_t probes = 0;
  ASSERT_EQ(std::sscanf(said.c_str() + said.find("mean error", at), "mean error %lf on %zu", &mean, &probes), 2)
      << said;
  EXPECT_GT(probes, 100u);
  EXPECT_GT(result.error->mean, 1e-4);
  // Printed with four digits.
  EXPECT_NEAR(mean * static_cast<double>(probes) / (kSize * kSize), result.error->mean, 1e-3 * result.error->mean);
}

TEST_F(Edges, TwoStepsGiveTheSameBits) {
  const Edge edge;
  writePost(edge);
  writeGlass(5.0);
  const Request asked = request(8, "phenomenological");
  Compositor compositor(asked);
  std::vector<PassPlanes> passes;
  compositor.accumulate(asked, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
  writePasses(path("planes.exr"), passes);
  PlanesRequest resolve;
  resolve.opaque = path("post.exr");
  resolve.planes = {path("planes.exr")};
  Journal journal;
  const ResolvedPlanes resolved = resolvePlanes(resolve, journal);
  const Picture whole = run(asked);
  for (std::size_t i = 0; i < whole.rgba.size(); ++i) EXPECT_EQ(resolved.picture.rgba[i], whole.rgba[i]);
}

TEST_F(Edges, TheLayerShowsSharesAndDepths) {
  const Edge edge;
  writePost(edge);
  writeGlass(5.0);
  Request asked = request(8);
  asked.layers = {LayerName::edges};
  Compositor compositor(asked);
  const Result result = compositor.run(asked);
  ASSERT_EQ(result.layers.size(), 1u);
  const ExtraLayer& layer = result.layers[0];
  EXPECT_EQ(layer.name, "edges");
  const Image<float>&share = layer.channels[0].second, &nearer = layer.channels[1].second,
        &farther = layer.channels[2].second;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double f = edge.share(x, y);
      const bool mixed = f > 0.0 && f < 1.0;
      EXPECT_NEAR(static_cast<double>(share.at(x, y)), mixed ? f : 0.0, 1e-5);
      if (!mixed) continue;
      EXPECT_FLOAT_EQ(nearer.at(x, y), 3.0f);
      EXPECT_FLOAT_EQ(farther.at(x, y), 10.0f);
    }
}

}  // namespace
}  // namespace pellucid
