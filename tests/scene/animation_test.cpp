// Animations against an evaluation of their own: rotations by axis and angle, splines by Bezier's construction, in
// double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/triangle_source.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

using Numbers = std::vector<double>;

const std::vector<float> kTimes = {0.25f, 0.5f, 1.125f, 1.25f, 3.0f};
constexpr int kMoments = 1000;

// From before the first key to behind the last, and the keys themselves.
double momentOf(int i) {
  if (i < static_cast<int>(kTimes.size())) return static_cast<double>(kTimes[static_cast<std::size_t>(i)]);
  return -0.2 + 3.5 * i / kMoments;
}

// Deterministic numbers in [-1, 1].
std::vector<float> someNumbers(std::size_t count, unsigned seed) {
  std::vector<float> values(count);
  for (float& value : values) {
    seed = seed * 1664525u + 1013904223u;
    value = static_cast<float>(seed >> 8) / 8388608.0f - 1.0f;
  }
  return values;
}

std::vector<float> someTurns(std::size_t count, unsigned seed) {
  std::vector<float> values = someNumbers(4 * count, seed);
  for (std::size_t k = 0; k < count; ++k) {
    double length = 0;
    for (std::size_t c = 0; c < 4; ++c) length += static_cast<double>(values[4 * k + c] * values[4 * k + c]);
    for (std::size_t c = 0; c < 4; ++c) values[4 * k + c] /= static_cast<float>(std::sqrt(length));
  }
  return values;
}

struct Span {
  std::size_t key;
  double t, length;
  bool inside;
};

Span spanOf(double time) {
  Span span{0, 0.0, 0.0, false};
  for (std::size_t k = 0; k < kTimes.size(); ++k)
    if (static_cast<double>(kTimes[k]) <= time) span.key = k;
  span.inside = time > static_cast<double>(kTimes.front()) && span.key + 1 < kTimes.size();
  if (!span.inside) return span;
  span.length = static_cast<double>(kTimes[span.key + 1]) - static_cast<double>(kTimes[span.key]);
  span.t = (time - static_cast<double>(kTimes[span.key])) / span.length;
  return span;
}

Numbers pick(const std::vector<float>& values, std::size_t at, std::size_t width) {
  Numbers result;
  for (std::size_t c = 0; c < width; ++c) result.push_back(static_cast<double>(values[at * width + c]));
  return result;
}

// Hamilton's product of (x y z w).
Numbers times(const Numbers& a, const Numbers& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Numbers normalised(Numbers q) {
  double sum = 0;
  for (const double c : q) sum += c * c;
  for (double& c : q) c /= std::sqrt(sum);
  return q;
}

// from (from^-1 to)^t: what turns one into the other, by a part of its angle about its axis.
Numbers turned(const Numbers& from, const Numbers& to, double t) {
  Numbers between = times({-from[0], -from[1], -from[2], from[3]}, to);
  if (between[3] < 0)
    for (double& c : between) c = -c;
  const double sine = std::sqrt(between[0] * between[0] + between[1] * between[1] + between[2] * between[2]);
  const double half = std::atan2(sine, between[3]);
  const double scale = sine > 1e-12 ? std::sin(t * half) / sine : t;
  return times(from, {between[0] * scale, between[1] * scale, between[2] * scale, std::cos(t * half)});
}

// De Casteljau between the values, with handles at a third of the tangents.
Numbers splined(const Numbers& from, const Numbers& out, const Numbers& in, const Numbers& to, double t,
                double length) {
  Numbers result;
  for (std::size_t c = 0; c < from.size(); ++c) {
    double p[4] = {from[c], from[c] + out[c] * length / 3, to[c] - in[c] * length / 3, to[c]};
    for (int level = 3; level > 0; --level)
      for (int i = 0; i < level; ++i) p[i] = (1 - t) * p[i] + t * p[i + 1];
    result.push_back(p[0]);
  }
  return result;
}

Numbers expected(const std::string& interpolation, const std::vector<float>& values, std::size_t width, bool turns,
                 double time) {
  const Span span = spanOf(time);
  if (interpolation == "CUBICSPLINE") {
    Numbers result = pick(values, 3 * span.key + 1, width);
    if (span.inside)
      result = splined(result, pick(values, 3 * span.key + 2, width), pick(values, 3 * span.key + 3, width),
                       pick(values, 3 * span.key + 4, width), span.t, span.length);
    return turns ? normalised(result) : result;
  }
  const Numbers from = pick(values, span.key, width);
  if (!span.inside || interpolation == "STEP") return turns ? normalised(from) : from;
  const Numbers to = pick(values, span.key + 1, width);
  if (turns) return turned(normalised(from), normalised(to), span.t);
  Numbers result;
  for (std::size_t c = 0; c < width; ++c) result.push_back(from[c] + span.t * (to[c] - from[c]));
  return result;
}

void animate(Builder& builder, int node, const char* path, const std::string& interpolation, int input, int output) {
  Json& animations = builder.json["animations"];
  if (animations.empty()) animations.push_back({{"channels", Json::array()}, {"samplers", Json::array()}});
  Json& animation = animations.back();
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
}

SceneOptions at(double seconds) {
  SceneOptions options;
  options.seconds = seconds;
  options.secondsBy = "a test";
  return options;
}

glm::dmat4 placedBy(const Numbers& t, const Numbers& q, const Numbers& s) {
  glm::dmat4 m(1.0);
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c] * s[static_cast<std::size_t>(c)];
    m[3][r] = t[static_cast<std::size_t>(r)];
  }
  return m;
}

double distance(const glm::dmat4& a, const glm::dmat4& b) {
  double most = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) most = std::max(most, std::abs(a[c][r] - b[c][r]));
  return most;
}

struct Moving {
  std::string interpolation;
  std::size_t perKey = 1;
  std::vector<float> moves, turns, scales;
  explicit Moving(std::string name) : interpolation(std::move(name)), perKey(interpolation == "CUBICSPLINE" ? 3 : 1) {
    const std::size_t keys = kTimes.size() * perKey;
    moves = someNumbers(3 * keys, 1);
    turns = perKey == 3 ? someNumbers(4 * keys, 2) : someTurns(keys, 2);
    scales = someNumbers(3 * keys, 3);
    for (float& scale : scales) scale = 1.5f + 0.5f * scale;
  }
  void on(Builder& builder, int node) const {
    const int times = builder.floats(kTimes, "SCALAR", 1);
    animate(builder, node, "translation", interpolation, times, builder.floats(moves, "VEC3", 3));
    animate(builder, node, "rotation", interpolation, times, builder.floats(turns, "VEC4", 4));
    animate(builder, node, "scale", interpolation, times, builder.floats(scales, "VEC3", 3));
  }
  glm::dmat4 matrix(double time) const {
    return placedBy(expected(interpolation, moves, 3, false, time), expected(interpolation, turns, 4, true, time),
                    expected(interpolation, scales, 3, false, time));
  }
};

TEST(Animation, EveryInterpolationOfNodesAtAThousandTimes) {
  for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"}) {
    Builder builder;
    builder.triangle();
    const Moving moving(interpolation);
    moving.on(builder, 0);
    Scene scene;
    SceneFiles files({builder.writeGlb()}, at(0.0), scene);
    ASSERT_TRUE(files.moves());
    double worst = 0;
    for (int i = 0; i < kMoments; ++i) {
      files.pose(momentOf(i));
      ASSERT_EQ(scene.instances.size(), 1u);
      worst = std::max(worst, distance(scene.instances[0].worldFromObject, moving.matrix(momentOf(i))));
    }
    EXPECT_LT(worst, 1e-12) << interpolation << ": both are in double precision";
  }
}

TEST(Animation, WeightsAtAThousandTimes) {
  for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"}) {
    const std::size_t perKey = std::string(interpolation) == "CUBICSPLINE" ? 3 : 1;
    Builder builder;
    Json& primitive = builder.triangle();
    const std::vector<float> first = someNumbers(9, 7), second = someNumbers(9, 8);
    primitive["targets"] = {{{"POSITION", builder.floats(first, "VEC3", 3)}},
                            {{"POSITION", builder.floats(second, "VEC3", 3)}}};
    const std::vector<float> weights = someNumbers(2 * perKey * kTimes.size(), 9);
    animate(builder, 0, "weights", interpolation, builder.floats(kTimes, "SCALAR", 1),
            builder.floats(weights, "SCALAR", 1));
    const std::vector<float> rest = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    Scene scene;
    SceneFiles files({builder.writeGlb()}, at(0.0), scene);
    double worst = 0;
    for (int i = 0; i < kMoments; ++i) {
      files.pose(momentOf(i));
      const Numbers w = expected(interpolation, weights, 2, false, momentOf(i));
      const Primitive& posed = scene.primitives.at(static_cast<std::size_t>(scene.instances.at(0).primitive));
      for (std::size_t k = 0; k < 9; ++k) {
        const double right =
            static_cast<double>(rest[k]) + w[0] * static_cast<double>(first[k]) + w[1] * static_cast<double>(second[k]);
        const double found = static_cast<double>(posed.vertices[k / 3].position[static_cast<int>(k % 3)]);
        worst = std::max(worst, std::abs(found - right));
      }
    }
    EXPECT_EQ(scene.primitives.size(), 1u) << "poses take the place of each other";
    EXPECT_LT(worst, 1e-6) << interpolation << ": vertices are floats";
  }
}

TEST(Animation, ASkinAtAThousandTimes) {
  for (const bool streamed : {false, true}) {
    Builder builder;
    const std::vector<float> rest = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    builder.mesh(
        {{"POSITION", builder.floats(rest, "VEC3", 3)},
         {"JOINTS_0", builder.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4)},
         {"WEIGHTS_0", builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0}, "VEC4", 4)}});
    builder.json["nodes"][0]["skin"] = 0;
    builder.json["nodes"].push_back({{"children", {2}}});
    builder.json["nodes"].push_back(Json::object());
    std::vector<float> inverse(32, 0.0f);
    for (const std::size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) inverse[i] = 1.0f;
    inverse[16 + 12] = -1.0f;
    builder.json["skins"].push_back({{"joints", {1, 2}}, {"inverseBindMatrices", builder.floats(inverse, "MAT4", 16)}});
    const Moving parent("LINEAR"), child("CUBICSPLINE");
    parent.on(builder, 1);
    child.on(builder, 2);
    SceneOptions options = at(0.0);
    if (streamed) options.streamBytes = 1 << 20;
    Scene scene;
    SceneFiles files({builder.writeGlb()}, options, scene);
    double worst = 0;
    for (int i = 0; i < kMoments; ++i) {
      files.pose(momentOf(i));
      const Scene whole = decodedScene(scene);
      const Primitive& posed = whole.primitives.at(static_cast<std::size_t>(whole.instances.at(0).primitive));
      const glm::dmat4 a = parent.matrix(momentOf(i));
      glm::dmat4 bind(1.0);
      bind[3].x = -1.0;
      const glm::dmat4 b = a * child.matrix(momentOf(i)) * bind;
      const double part[3] = {1.0, 0.0, 0.25};
      for (std::size_t v = 0; v < 3; ++v) {
        const glm::dvec4 p(static_cast<double>(rest[3 * v]), static_cast<double>(rest[3 * v + 1]),
                           static_cast<double>(rest[3 * v + 2]), 1.0);
        const glm::dvec3 right(part[v] * (a * p) + (1.0 - part[v]) * (b * p));
        worst = std::max(worst, glm::length(glm::dvec3(posed.vertices[v].position) - right));
      }
    }
    EXPECT_LT(worst, 1e-6) << "vertices are floats, of magnitudes up to 5";
  }
}

TEST(Animation, PosingAgainIsLoadingAtThatTime) {
  Builder builder;
  builder.triangle();
  builder.json["nodes"][0]["children"] = {1};
  builder.json["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683.0}}};
  builder.json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Moving moving("LINEAR");
  moving.on(builder, 0);
  const std::string path = builder.writeGlb();
  Scene scene;
  SceneFiles files({path}, at(0.3), scene);
  files.pose(2.0);
  files.pose(0.7);
  const Scene fresh = loadScene({path}, at(0.7));
  EXPECT_EQ(scene.instances.at(0).worldFromObject, fresh.instances.at(0).worldFromObject);
  EXPECT_EQ(scene.instances.at(0).identity, fresh.instances.at(0).identity);
  EXPECT_EQ(scene.cameras.at(0).viewFromWorld, fresh.cameras.at(0).viewFromWorld);
  EXPECT_EQ(scene.lights.at(0).position, fresh.lights.at(0).position);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.primitives.size(), 1u);
  EXPECT_LT(glm::length(scene.lights[0].position - glm::dvec3(moving.matrix(0.7)[3])), 1e-12);
  EXPECT_TRUE(noted(fresh, "plays animation 0 (0.25 s to 3 s) at a test"));
  const Scene stored = loadScene({path}, {});
  EXPECT_EQ(stored.instances.at(0).worldFromObject, glm::dmat4(1.0));
  EXPECT_TRUE(noted(stored, "animations are not played"));
}

// Two animations that move the same node, by name.
TEST(Animation, SeveralByName) {
  Builder builder;
  builder.triangle();
  builder.triangle();
  const int times = builder.floats({0, 1}, "SCALAR", 1);
  const auto moving = [&](const char* name, int node, float x) {
    const int output = builder.floats({0, 0, 0, x, 0, 0}, "VEC3", 3);
    builder.json["animations"].push_back(
        {{"name", name},
         {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}})},
         {"samplers", Json::array({{{"input", times}, {"output", output}}})}});
  };
  moving("walk", 0, 2);
  moving("other", 1, 3);
  const std::string path = builder.writeGlb();
  const auto placesOf = [](const std::string& file, std::vector<std::string> names) {
    SceneOptions options = at(0.5);
    options.animations = std::move(names);
    const Scene scene = loadScene({file}, options);
    return std::array{scene.instances.at(0).worldFromObject[3].x, scene.instances.at(1).worldFromObject[3].x};
  };
  EXPECT_EQ(placesOf(path, {}), (std::array{1.0, 1.5})) << "they do not meet";
  EXPECT_EQ(placesOf(path, {"all"}), (std::array{1.0, 1.5}));
  EXPECT_EQ(placesOf(path, {"other"}), (std::array{0.0, 1.5}));
  EXPECT_EQ(placesOf(path, {"other", "walk"}), (std::array{1.0, 1.5}));
  moving("run", 0, 8);
  builder.json.erase("buffers");
  const std::string three = builder.writeGlb("three.glb");
  EXPECT_EQ(placesOf(three, {}), (std::array{1.0, 0.0})) << "the first alone";
  EXPECT_TRUE(noted(loadScene({three}, at(0.5)), "the first is played, walk"));
  EXPECT_EQ(placesOf(three, {"all"}), (std::array{4.0, 1.5})) << "the later one";
  EXPECT_EQ(placesOf(three, {"run"}), (std::array{4.0, 0.0}));
  expectRefusal(refusalOf([&] { placesOf(three, {"swim"}); }), 2, {"--animation", "swim", "walk, other, run"});
}

TEST(Animation, PointersMoveNumbersOfMaterialsCamerasAndLights) {
  Builder builder;
  builder.material(
      {{"name", "glass"}, {"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_transmission", Json::object()}}}});
  builder.json["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  builder.json["nodes"].push_back({{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  const int times = builder.floats({0, 1}, "SCALAR", 1);
  Json animation = {{"channels", Json::array()}, {"samplers", Json::array()}};
  const auto add = [&](const std::string& pointer, int output, const char* interpolation = "LINEAR") {
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()},
         {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    animation["samplers"].push_back({{"input", times}, {"output", output}, {"interpolation", interpolation}});
  };
  add("/materials/0/pbrMetallicRoughness/baseColorFactor", builder.floats({1, 1, 1, 0, 0.5f, 0, 0, 1}, "VEC4", 4));
  add("/materials/0/extensions/KHR_materials_transmission/transmissionFactor", builder.floats({0, 1}, "SCALAR", 1));
  add("/cameras/0/perspective/yfov", builder.floats({1, 0.5f}, "SCALAR", 1));
  add("/extensions/KHR_lights_punctual/lights/0/color", builder.floats({0, 0, 0, 1, 0.5f, 0.25f}, "VEC3", 3));
  add("/nodes/2/extensions/KHR_node_visibility/visible",
      builder.accessor(std::vector<std::uint8_t>{1, 0}, 5121, "SCALAR", 1), "STEP");
  add("/materials/0/extensions/KHR_materials_sheen/sheenRoughnessFactor", builder.floats({0, 1}, "SCALAR", 1));
  builder.json["animations"] = Json::array({animation});
  Scene scene;
  SceneFiles files({builder.writeGlb()}, at(0.0), scene);
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_TRUE(noted(scene, "sheenRoughnessFactor shows in no picture"));
  files.pose(0.5);
  EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(0.75f, 0.5f, 0.5f, 0.5f));
  EXPECT_EQ(scene.materials.at(0).transmission, 0.5f);
  EXPECT_DOUBLE_EQ(scene.cameras.at(0).yfov, 0.75);
  EXPECT_EQ(scene.lights.at(0).colour, glm::vec3(0.5f, 0.25f, 0.125f));
  files.pose(1.0);
  EXPECT_EQ(scene.instances.size(), 1u) << "hidden at the last key";
}

TEST(Animation, DamagedOnesAreRefused) {
  const auto refusal = [](const std::function<void(Builder&)>& damage) {
    Builder builder;
    builder.triangle();
    animate(builder, 0, "translation", "LINEAR", builder.floats({0, 1}, "SCALAR", 1),
            builder.floats({0, 0, 0, 1, 0, 0}, "VEC3", 3));
    damage(builder);
    return refusalOf([&] { loadScene({builder.writeGlb()}, at(0.5)); });
  };
  const auto sampler = [](Builder& b) -> Json& { return b.json["animations"][0]["samplers"][0]; };
  const auto target = [](Builder& b) -> Json& { return b.json["animations"][0]["channels"][0]["target"]; };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal([](Builder&) {}).code, 0);
  expectRefusal(refusal([&](Builder& b) {
                  sampler(b)["input"] = b.floats({1, 0}, "SCALAR", 1);
                }),
                3, {"samplers[0].input", "fall from 1 s to 0 s"});
  expectRefusal(refusal([&](Builder& b) {
                  sampler(b)["input"] = b.floats({0, nan}, "SCALAR", 1);
                }),
                3, {"samplers[0].input", "not finite"});
  expectRefusal(refusal([&](Builder& b) {
                  sampler(b)["output"] = b.floats({0, 0, 0, nan, 0, 0}, "VEC3", 3);
                }),
                3, {"samplers[0].output", "not finite"});
  expectRefusal(refusal([&](Builder& b) {
                  sampler(b)["output"] = b.floats({0, 0, 0}, "VEC3", 3);
                }),
                3, {"samplers[0].output", "1 elements for 2 keys"});
  expectRefusal(refusal([&](Builder& b) {
                  sampler(b)["output"] = b.floats({0, 0, 0, 0}, "VEC2", 2);
                }),
                3, {"samplers[0].output", "2 numbers a key", "expected 3"});
  expectRefusal(refusal([&](Builder& b) { sampler(b)["interpolation"] = "CUBICSPLINE"; }), 3,
                {"samplers[0].output", "2 elements for 2 keys"});
  expectRefusal(refusal([&](Builder& b) { sampler(b)["interpolation"] = "BOUNCE"; }), 3, {"BOUNCE", "CUBICSPLINE"});
  expectRefusal(refusal([&](Builder& b) { sampler(b)["input"] = 99; }), 3, {"input", "99"});
  expectRefusal(refusal([&](Builder& b) { target(b)["node"] = 5; }), 3, {"target.node", "5"});
  expectRefusal(refusal([&](Builder& b) { target(b)["path"] = "colour"; }), 3, {"target.path", "colour"});
  expectRefusal(refusal([&](Builder& b) { b.json["animations"][0]["channels"][0]["sampler"] = 3; }), 3,
                {"channels[0].sampler", "3"});
  expectRefusal(refusal([&](Builder& b) { b.json["nodes"][0]["matrix"] = Json::array(); }), 3, {"nodes[0]", "matrix"});
  expectRefusal(refusal([&](Builder& b) {
                  target(b)["path"] = "rotation";
                  sampler(b)["output"] = b.floats({0, 0, 0, 0, 0, 0, 0, 1}, "VEC4", 4);
                }),
                3, {"samplers[0].output", "no length"});
  expectRefusal(refusal([&](Builder& b) {
                  b.json["animations"][0]["channels"].push_back(b.json["animations"][0]["channels"][0]);
                }),
                3, {"a second time"});
  const auto pointer = [&](Builder& b, const char* where) {
    target(b) = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", where}}}}}};
  };
  expectRefusal(refusal([&](Builder& b) { pointer(b, "/nodes/7/translation"); }), 3, {"/nodes/7/translation"});
  expectRefusal(refusal([&](Builder& b) { pointer(b, "/nodes/99999999999999999999/translation"); }), 0, {});
  expectRefusal(refusal([&](Builder& b) { pointer(b, "/materials/0/emissiveFactor"); }), 3, {"not there"});
  EXPECT_EQ(refusal([&](Builder& b) { pointer(b, "/accessors/0/count"); }).code, 0) << "nothing that is played";
  EXPECT_EQ(refusal([&](Builder& b) { target(b).erase("node"); }).code, 0) << "glTF 2.0: ignored";
  EXPECT_EQ(refusal([&](Builder& b) { sampler(b)["input"] = b.floats({1, 1}, "SCALAR", 1); }).code, 0);
}

}  // namespace
}  // namespace pellucid::test
