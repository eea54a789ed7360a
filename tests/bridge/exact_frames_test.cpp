// The exact tier behind a host's own draws: triangles in any order, other methods and stages, and room that does not
// suffice.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "composite/resolve.h"
#include "tests/bridge/host.h"
#include "tests/reference/sorted_over.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr uint32_t kScatter = PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION | PLD_FEATURE_DISPERSION,
                   kColoured = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT;

// Triangles that know what they are by their number, wherever they come in a draw.
const char* const kHash = R"(
float hash(int i) {
  uint x = uint(i) * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
  return float(((x >> 22) ^ x) >> 8) / 16777216.0;
}
)";
const char* const kVertex = R"(
uniform vec2 focal;
uniform mat4 clipFromView;
out vec3 viewPosition;
flat out int triangle;
void main() {
  triangle = gl_VertexID / 3;
  float z = 2.0 + 8.0 * hash(7 * triangle) + hash(11 * gl_VertexID + 1);
  vec2 corner = 1.6 * vec2(hash(3 * triangle + 5), hash(3 * triangle + 6)) - 0.8;
  corner += vec2(hash(5 * gl_VertexID + 2), hash(5 * gl_VertexID + 3)) - 0.5;
  viewPosition = vec3(corner * z / focal, -z);
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";
const char* const kFragment = R"(
in vec3 viewPosition;
flat in int triangle;
void main() {
  float coverage = 0.1 + 0.8 * fract(viewPosition.y + hash(13 * triangle));
  vec2 gradient = vec2(dFdx(coverage), dFdy(coverage));
  if (fract(2.0 * viewPosition.x + hash(triangle)) < 0.1) discard;
  vec3 tint = vec3(hash(17 * triangle), hash(19 * triangle), hash(23 * triangle));
  bool solid = triangle % 17 == 0;
  if (solid) coverage = 1.0;
  vec3 transmission = solid ? vec3(0.0) : COLOUR(tint);
  PldSurface surface = pldSurface(coverage * exp2(8.0 * tint.bgr - 4.0), coverage, transmission, viewPosition);
  surface.normal = normalize(vec3(tint.xy - 0.5, 1.0));
  surface.eta = 1.0 / 1.5;
  surface.etaRedBlue = vec2(1.0 / 1.48, 1.0 / 1.52);
  surface.collimation = 0.8;
#ifdef CUT_OUT
  pldWriteRim(surface, 0.5 * surface.radiance, gradient);
#else
  pldWriteFragment(surface);
#endif
}
)";

struct Kind {
  const char* what;
  pld_method method;
  pld_tier tier;
  uint32_t features;
  pld_depth depth;
};

class Scene {
 public:
  explicit Scene(const Kind& kind, float room = 60.0f) : host(kWidth, kHeight), kind_(kind) {
    std::vector<float> depths(kWidth * kHeight, 1.0f);
    for (std::size_t i = 0; i < depths.size(); ++i)
      if (i % kWidth < kWidth / 2) depths[i] = 1.0f - 0.1f / 6.0f;  // six metres off
    device_ = makeTexture(GL_DEPTH_COMPONENT32F, kWidth, kHeight);
    fillTexture(device_, kWidth, kHeight, GL_DEPTH_COMPONENT, depths.data());
    for (float& one : depths) one = one < 1.0f ? 6.0f : INFINITY;
    fillTexture(host.depth, kWidth, kHeight, GL_RED, depths.data());
    pld_create_info info = host.info();
    info.method = kind.method;
    info.tier = kind.tier;
    info.features = kind.features;
    info.depth = kind.depth;
    info.weight = PLD_WEIGHT_BY_POWER;
    info.fragments_per_pixel = room;
    info.storage_binding = 1;
    info.flags = flags;
    pass = host.create(info);
    frame = host.frame();
    if (kind.depth != PLD_DEPTH_LINEAR) frame.depth_texture = device_;
    frame.pre_exposure = 1.3f;
    glCreateVertexArrays(1, &array_);
    glCreateBuffers(1, &indices_);
    glVertexArrayElementBuffer(array_, indices_);
    if (kind.features & PLD_FEATURE_SOLIDS) stages.push_back(PLD_STAGE_SOLIDS);
    if (kind.method == PLD_METHOD_FRONT_TAIL && kind.tier != PLD_TIER_EXACT) stages.push_back(PLD_STAGE_FRONT);
    stages.push_back(PLD_STAGE_LAYERS);
    if ((kind.features & PLD_FEATURE_RIMS) && kind.method != PLD_METHOD_FRONT_TAIL) stages.push_back(PLD_STAGE_RIMS);
    if (kind.features & PLD_FEATURE_LOW_RESOLUTION) stages.push_back(PLD_STAGE_LOW);
    for (const pld_stage stage : stages) programs_.push_back(programOf(stage));
  }
  ~Scene() {
    pld_destroy(&pass);
    for (const GLuint one : programs_) glDeleteProgram(one);
    glDeleteVertexArrays(1, &array_);
    glDeleteBuffers(1, &indices_);
    glDeleteTextures(1, &device_);
  }

  // Draws these triangles, in this order and in one call a stage; what pld_end() of the last stage says.
  pld_status draw(const std::vector<GLuint>& triangles) {
    std::vector<GLuint> corners;
    for (const GLuint one : triangles)
      for (GLuint i = 0; i < 3; ++i) corners.push_back(3 * one + i);
    glNamedBufferData(indices_, static_cast<GLsizeiptr>(4 * corners.size()), corners.data(), GL_STREAM_DRAW);
    pld_status status = PLD_OK;
    for (std::size_t i = 0; i < stages.size() && status == PLD_OK; ++i) {
      EXPECT_EQ(pld_begin(pass, stages[i], &frame), PLD_OK) << pld_message(pass);
      glUseProgram(programs_[i]);
      glBindVertexArray(array_);
      glUniformMatrix4fv(glGetUniformLocation(programs_[i], "clipFromView"), 1, GL_FALSE, frame.projection);
      glUniform2f(glGetUniformLocation(programs_[i], "focal"), frame.projection[0], frame.projection[5]);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corners.size()), GL_UNSIGNED_INT, nullptr);
      status = pld_end(pass);
    }
    return status;
  }

  std::vector<float> planes() const {
    std::vector<float> all;
    for (int i = 0; i < 8; ++i) {
      uint64_t name = 0;
      EXPECT_EQ(pld_query(pass, static_cast<pld_value>(PLD_VALUE_FIRST_PLANE + i), &name), PLD_OK);
      if (!name) continue;
      const std::vector<float> plane = readTexture(static_cast<GLuint>(name), kWidth, kHeight, GL_RGBA);
      all.insert(all.end(), plane.begin(), plane.end());
    }
    return all;
  }
  std::vector<float> picture(pld_view view = PLD_VIEW_PICTURE) const {
    pld_target target = host.target();
    target.view = view;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    return host.picture();
  }
  uint64_t query(pld_value what) const {
    uint64_t value = 0;
    EXPECT_EQ(pld_query(pass, what, &value), PLD_OK) << pld_message(pass);
    return value;
  }

  static inline uint32_t flags = 0;
  Host host;
  pld_pass* pass = nullptr;
  pld_frame frame{};
  std::vector<pld_stage> stages;

 private:
  GLuint programOf(pld_stage stage) {
    const char* seam = nullptr;
    EXPECT_EQ(pld_glsl(pass, stage, 430, &seam), PLD_OK) << pld_message(pass);
    const std::string first = "#version 430 core\n";
    const std::string colour =
        kind_.features & PLD_FEATURE_COLOURED ? "#define COLOUR(t) t\n" : "#define COLOUR(t) vec3(0.9 * t.r)\n";
    const std::string rims = (kind_.features & PLD_FEATURE_RIMS) && stage != PLD_STAGE_LOW && stage != PLD_STAGE_SOLIDS
                                 ? "#define CUT_OUT\n"
                                 : "";
    return makeProgram(first + kHash + kVertex, first + (seam ? seam : "") + colour + rims + kHash + kFragment);
  }

  Kind kind_;
  GLuint device_ = 0, array_ = 0, indices_ = 0;
  std::vector<GLuint> programs_;
};

std::vector<GLuint> firstTriangles(GLuint count) {
  std::vector<GLuint> order(count);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

void shuffle(std::vector<GLuint>& order, Random& random) {
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
}

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t words = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) words += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
  return words;
}

double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(double(a[i]) - double(b[i])) / std::max(1.0, std::abs(double(a[i]))));
  return largest;
}

const Kind kKinds[] = {
    {"all phenomena, depth test", PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT,
     kColoured | kScatter | PLD_FEATURE_SOLIDS, PLD_DEPTH_DEVICE},
    {"grey, linear depth", PLD_METHOD_WEIGHTED, PLD_TIER_EXACT, 0, PLD_DEPTH_LINEAR},
    {"front+tail", PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, kColoured | PLD_FEATURE_SOLIDS, PLD_DEPTH_DEVICE},
    {"front+tail, rims", PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, PLD_FEATURE_RIMS, PLD_DEPTH_DEVICE},
    {"rims, low resolution", PLD_METHOD_WEIGHTED, PLD_TIER_EXACT,
     kColoured | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION, PLD_DEPTH_DEVICE},
    {"rims, low resolution, all phenomena", PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT,
     kColoured | kScatter | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION, PLD_DEPTH_LINEAR}};

// Sixty layers of float sums, weights and radiance over decades: an ulp each, and what the resolve makes of them.
constexpr double kFloatTolerance = 60 * 0x1p-23;

TEST(BridgeExactFrames, TrianglesInAnyOrderGiveTheSameBits) {
  GlContext context;
  for (const Kind& kind : kKinds) {
    Kind floats = kind;
    floats.tier = PLD_TIER_FLOAT;
    Scene exact(kind), blended(floats);
    ASSERT_TRUE(exact.pass && blended.pass);
    Random random(5);
    std::vector<GLuint> order = firstTriangles(300);
    std::vector<float> planes, picture, blendedPlanes;
    std::size_t changed = 0, shown = 0, blendedChanged = 0;
    for (int turn = 0; turn <= 20; ++turn) {
      ASSERT_EQ(exact.draw(order), PLD_OK) << pld_message(exact.pass);
      if (turn == 0) planes = exact.planes(), picture = exact.picture();
      changed += differing(planes, exact.planes());
      shown += differing(picture, exact.picture());
      if (turn <= 2) {
        ASSERT_EQ(blended.draw(order), PLD_OK) << pld_message(blended.pass);
        if (turn == 0) blendedPlanes = blended.planes();
        blendedChanged += differing(blendedPlanes, blended.planes());
      }
      shuffle(order, random);
    }
    const double off = largestDifference(blended.picture(), picture);
    std::printf(
        "exact, drawn, %s: 20 shuffles of 300 triangles, at most %llu fragments a stage: %zu of 20 x %zu words of "
        "planes and %zu of pictures "
        "change (float: %zu in 2); off the float tier's picture by %.2g\n",
        kind.what, static_cast<unsigned long long>(exact.query(PLD_VALUE_FRAGMENTS)), changed, planes.size(), shown,
        blendedChanged, off);
    EXPECT_EQ(changed, 0u) << kind.what;
    EXPECT_EQ(shown, 0u) << kind.what;
    EXPECT_GT(blendedChanged, 100u) << kind.what;
    EXPECT_LT(off, kFloatTolerance) << kind.what;
    EXPECT_GT(differing(picture, readTexture(exact.host.colour, kWidth, kHeight, GL_RGBA)), picture.size() / 3);
    EXPECT_EQ(exact.query(PLD_VALUE_GEOMETRY_PASSES) + (kind.method == PLD_METHOD_FRONT_TAIL ? 1u : 0u),
              blended.query(PLD_VALUE_GEOMETRY_PASSES));
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
}

// What the opaque hides, what the host discards and what no pixel's centre lies in is listed no more than it is
// blended.
TEST(BridgeExactFrames, ListsHoldWhatTheFloatTierCounts) {
  GlContext context;
  for (const pld_depth depth : {PLD_DEPTH_DEVICE, PLD_DEPTH_LINEAR}) {
    Kind kind{"", PLD_METHOD_WEIGHTED, PLD_TIER_EXACT, kColoured, depth};
    Scene exact(kind);
    kind.tier = PLD_TIER_FLOAT;
    Scene blended(kind);
    const std::vector<GLuint> order = firstTriangles(200);
    ASSERT_EQ(exact.draw(order), PLD_OK);
    ASSERT_EQ(blended.draw(order), PLD_OK);
    uint64_t name = 0;
    ASSERT_EQ(pld_query(blended.pass, static_cast<pld_value>(PLD_VALUE_FIRST_PLANE + 1), &name), PLD_OK);
    const std::vector<float> weights = readTexture(static_cast<GLuint>(name), kWidth, kHeight, GL_RGBA);
    double counted = 0;
    for (std::size_t i = 3; i < weights.size(); i += 4) counted += static_cast<double>(weights[i]);
    const uint64_t listed = exact.query(PLD_VALUE_FRAGMENTS);
    std::printf("exact, depth %d: %llu fragments listed, %.0f blended in the float tier\n", static_cast<int>(depth),
                static_cast<unsigned long long>(listed), counted);
    EXPECT_EQ(static_cast<double>(listed), counted);
    EXPECT_GT(listed, 5000u);
  }
}

TEST(BridgeExactFrames, MoreFragmentsThanRoomIsAnErrorAndTheNextFrameIsRight) {
  GlContext context;
  const Kind kind{"", PLD_METHOD_WEIGHTED, PLD_TIER_EXACT, kColoured | PLD_FEATURE_SOLIDS, PLD_DEPTH_DEVICE};
  Scene wide(kind), narrow(kind, 2.0f);
  const std::vector<GLuint> many = firstTriangles(300), few = firstTriangles(60);
  ASSERT_EQ(wide.draw(many), PLD_OK);
  const uint64_t came = wide.query(PLD_VALUE_FRAGMENTS), room = narrow.query(PLD_VALUE_FRAGMENT_ROOM);
  EXPECT_EQ(room, 2u * kWidth * kHeight);
  ASSERT_GT(came, room);
  ASSERT_EQ(wide.draw(few), PLD_OK);
  ASSERT_LT(wide.query(PLD_VALUE_FRAGMENTS), room);
  const std::vector<float> expected = wide.picture();
  EXPECT_EQ(narrow.draw(many), PLD_ERROR_MEMORY);
  const std::string message = pld_message(narrow.pass);
  std::printf("exact, without room: %s\n", message.c_str());
  EXPECT_NE(message.find(std::to_string(came)), std::string::npos) << message;
  EXPECT_NE(message.find(std::to_string(room)), std::string::npos) << message;
  EXPECT_EQ(narrow.query(PLD_VALUE_FRAGMENTS), came);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  const pld_target target = narrow.host.target();
  EXPECT_EQ(pld_resolve(narrow.pass, &target), PLD_ERROR_ORDER);  // no half picture
  ASSERT_EQ(narrow.draw(few), PLD_OK) << pld_message(narrow.pass);
  EXPECT_EQ(differing(expected, narrow.picture()), 0u);
  // The last place of the room is one: a frame of as many fragments as fit.
  const uint64_t fits = narrow.query(PLD_VALUE_FRAGMENTS);
  Scene tight(kind, static_cast<float>(fits) / (kWidth * kHeight));
  EXPECT_EQ(tight.query(PLD_VALUE_FRAGMENT_ROOM), fits);
  ASSERT_EQ(tight.draw(few), PLD_OK) << pld_message(tight.pass);
  EXPECT_EQ(differing(expected, tight.picture()), 0u);
  // A room that no storage block of this device holds.
  pld_create_info info = wide.host.info();
  info.tier = PLD_TIER_EXACT;
  info.fragments_per_pixel = 65536.0f;
  pld_pass* pass = nullptr;
  ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
  EXPECT_EQ(pld_resize(pass, 4096, 4096), PLD_ERROR_MEMORY);
  std::printf("exact, with too much room: %s\n", pld_message(pass));
  const pld_frame frame = wide.host.frame();
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ORDER);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

// Lists may be as deep as they like: the time of pld_end() grows as the fragments do.
TEST(BridgeExactFrames, AThousandLayersAPixel) {
  GlContext context;
  constexpr int wide = 32, high = 24;
  Host host(wide, high);
  pld_create_info info = host.info();
  info.features = kColoured | kScatter;
  info.tier = PLD_TIER_EXACT;
  info.fragments_per_pixel = 1000.0f;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const char* seam = nullptr;
  ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK);
  const std::string first = std::string("#version 450 core\n") + kHash;
  const GLuint program = makeProgram(first + R"(
flat out int layer;
void main() {
  layer = gl_InstanceID;
  gl_Position = vec4(vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - vec2(1.0), 0.5, 1.0);
})",
                                     std::string("#version 450 core\n") + seam + kHash + R"(
flat in int layer;
void main() {
  pldWriteLayer(vec3(hash(layer)), 0.01, vec3(0.5), 1.0 + 8.0 * hash(layer + 7), vec2(1.0), 0.5, vec4(0.25));
})");
  ASSERT_NE(program, 0u);
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  const pld_frame frame = host.frame();
  double milliseconds[2] = {1e9, 1e9};
  for (int turn = 0; turn < 3; ++turn)
    for (int deep = 0; deep < 2; ++deep) {
      ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
      glUseProgram(program);
      glBindVertexArray(array);
      glDrawArraysInstanced(GL_TRIANGLES, 0, 3, deep ? 1000 : 100);
      glFinish();
      const auto start = std::chrono::steady_clock::now();
      ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
      glFinish();
      milliseconds[deep] =
          std::min(milliseconds[deep],
                   std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  std::printf("exact, %dx%d: pld_end() takes %.2f ms for 100 layers a pixel, %.1f ms for 1,000: %.0f ns a fragment\n",
              wide, high, milliseconds[0], milliseconds[1], milliseconds[1] * 1e6 / (wide * high * 1000));
  uint64_t came = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_FRAGMENTS, &came), PLD_OK);
  EXPECT_EQ(came, uint64_t{wide} * high * 1000);
  glDeleteProgram(program);
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

// Layers whose light is one colour wherever they hide: their mean is that colour whatever the weights, so the picture
// is the sorted one.
TEST(BridgeExactFrames, LayersOfOneColourAreTheSortedTruth) {
  GlContext context;
  Random random(23);
  GBuffer gbuffer;
  FragmentLists lists;
  gbuffer.display = gbuffer.data = lists.window = {0, 0, kWidth, kHeight};
  gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
  gbuffer.viewZ = Image<float>(kWidth, kHeight, 1e3f);
  lists.offsets = {0};
  std::vector<reference::Rgb> truths;
  for (std::size_t pixel = 0; pixel < gbuffer.beauty.size(); ++pixel) {
    const glm::vec4 background(random.uniformf(), 5 * random.uniformf(), 0.1f, 1.0f);
    gbuffer.beauty[pixel] = background;
    const double scale = std::pow(10.0, random.between(-6, 6));
    const std::uint32_t count = pixel % 50 == 0 ? 100 : random.below(9);
    std::vector<reference::Layer> layers;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float coverages[] = {1e-5f, 0.999f, 1.0f, random.uniformf()};
      Fragment fragment{};
      fragment.coverage = coverages[random.below(4)];
      fragment.transmission = 0.9f * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
      fragment.z = static_cast<float>(std::pow(10.0, random.between(-1, 2)));
      reference::Layer layer;
      layer.coverage = static_cast<double>(fragment.coverage);
      layer.z = static_cast<double>(fragment.z);
      for (int c = 0; c < 3; ++c) {
        const double t = static_cast<double>(fragment.transmission[c]);
        fragment.radiance[c] = static_cast<float>(scale * layer.coverage * (1 - t));
        layer.transmission[static_cast<std::size_t>(c)] = t;
        layer.reflected[static_cast<std::size_t>(c)] = static_cast<double>(fragment.radiance[c]) / layer.coverage;
      }
      layers.push_back(layer);
      lists.fragments.push_back(fragment);
    }
    lists.offsets.push_back(lists.fragments.size());
    truths.push_back(reference::sortedOver(
        layers,
        {static_cast<double>(background.r), static_cast<double>(background.g), static_cast<double>(background.b)}));
  }
  Host host(kWidth, kHeight);
  host.upload(gbuffer);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_COLOURED;
  info.tier = PLD_TIER_EXACT;
  info.weight = PLD_WEIGHT_BY_POWER;
  info.fragments_per_pixel = 16.0f;
  info.storage_binding = 7;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  replay(pass, lists, host.frame(), {PLD_STAGE_LAYERS});
  const std::vector<float> picture = host.finish(pass);
  double worst = 0;
  for (std::size_t i = 0; i < truths.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst,
                       std::abs(static_cast<double>(picture[4 * i + c]) - truths[i][c]) / std::max(1.0, truths[i][c]));
  std::printf(
      "exact, layers of one colour against the sorted truth in double: off by %.2g x max(1, value), %zu fragments\n",
      worst, lists.fragments.size());
  EXPECT_LE(worst, 1e-6);
}

TEST(BridgeExactFrames, AHostThatRestoresGetsTheSameBits) {
  GlContext context;
  std::vector<float> pictures[2];
  for (const bool restores : {false, true}) {
    Scene::flags = restores ? static_cast<uint32_t>(PLD_FLAG_HOST_RESTORES) : 0u;
    Scene scene(kKinds[5]);
    EXPECT_EQ(scene.draw(firstTriangles(100)), PLD_OK) << pld_message(scene.pass);
    pictures[restores] = scene.picture();
    GLint bound = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 1, &bound);
    EXPECT_EQ(bound != 0, restores);
  }
  Scene::flags = 0;
  EXPECT_EQ(differing(pictures[0], pictures[1]), 0u);
}

// Views are of the same planes, and times of the same stages.
TEST(BridgeExactFrames, ViewsAndTimersAreThoseOfTheFloatTier) {
  GlContext context;
  Scene::flags = PLD_FLAG_DEBUG_VIEWS | PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS;
  for (const Kind& kind : {kKinds[2], kKinds[5]}) {
    Kind floats = kind;
    floats.tier = PLD_TIER_FLOAT;
    Scene exact(kind), blended(floats);
    ASSERT_EQ(exact.draw(firstTriangles(150)), PLD_OK) << pld_message(exact.pass);
    ASSERT_EQ(blended.draw(firstTriangles(150)), PLD_OK) << pld_message(blended.pass);
    double off = 0;
    int views = 0;
    for (int view = PLD_VIEW_LAYER_COUNT; view <= PLD_VIEW_LOW_DEPTH; ++view) {
      const bool whole = kind.features & PLD_FEATURE_LOW_RESOLUTION;  // and rims
      if (!whole && view > PLD_VIEW_SOLID) break;
      off = std::max(off, largestDifference(blended.picture(static_cast<pld_view>(view)),
                                            exact.picture(static_cast<pld_view>(view))));
      ++views;
    }
    glFinish();
    EXPECT_GT(exact.query(PLD_VALUE_NS_DRAWS), 0u);
    std::printf("exact, %s: %d views off the float tier's by %.2g at most\n", kind.what, views, off);
    EXPECT_LT(off, 2 * kFloatTolerance);  // quotients of two such sums
  }
  Scene::flags = 0;
}

// A context that says it is one of OpenGL 4.2.
TEST(BridgeExactFrames, OlderContextsAreRefused) {
  GlContext context;
  Host host(8, 8);
  pld_create_info info = host.info();
  info.tier = PLD_TIER_EXACT;
  info.fragments_per_pixel = 4.0f;
  info.get_proc_address = [](void* user, const char* name) -> pld_proc {
    if (std::string(name) != "glGetIntegerv") return procAddress(user, name);
    return reinterpret_cast<pld_proc>(+[](GLenum what, GLint* values) {
      glGetIntegerv(what, values);
      if (what == GL_MINOR_VERSION) *values = 2;
    });
  };
  pld_pass* pass = nullptr;
  EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_UNSUPPORTED);
  EXPECT_NE(host.log.last().find("4.3"), std::string::npos) << host.log.last();
  info.tier = PLD_TIER_FLOAT;
  EXPECT_EQ(pld_create(&info, &pass), PLD_OK);
  uint64_t value = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_FRAGMENTS, &value), PLD_ERROR_UNSUPPORTED);
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

}  // namespace
}  // namespace pellucid::test
