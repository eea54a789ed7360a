// What the parts of the engine bridge cost beside its layers: low resolution, rims, shadow maps. Ratios of medians,
// taken in turns, so that a busy machine slows all of them.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 480, kHeight = 272, kLayers = 8, kTurns = 9, kMap = 512;

void need(pld_status status, pld_pass* pass) {
  if (status == PLD_OK) return;
  std::fprintf(stderr, "%s: %s\n", pld_status_name(status), pld_message(pass));
  std::exit(1);
}

// Smoke that fills the picture: noise of a few octaves, as an engine's particles would shade.
const char* const kSmoke = R"(
uniform float seed;
uniform vec2 size;
float noise(vec2 p) {
  vec2 cell = floor(p), f = p - cell;
  vec4 corners = fract(sin(vec4(0.0, 1.0, 57.0, 58.0) + dot(cell, vec2(1.0, 57.0)) + seed) * 43758.5);
  return mix(mix(corners.x, corners.y, f.x), mix(corners.z, corners.w, f.x), f.y);
}
float smokeHere() {
  vec2 p = gl_FragCoord.xy / size * 6.0;
  float sum = 0.0, share = 0.5;
  for (int i = 0; i < 6; ++i, p *= 2.03, share *= 0.5) sum += share * noise(p);
  return clamp(sum * sum, 0.05, 0.95);
}
)";

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double milliseconds(const std::function<void()>& f) {
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  f();
  glFinish();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

GLuint programOf(const char* seam, const char* main) {
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + kSmoke + main);
  if (program == 0) std::exit(1);
  return program;
}

const char* const kPlainMain = R"(
void main() {
  float density = smokeHere();
  pldWriteFragment(pldSurface(vec3(0.5 * density), density, vec3(0.0), vec3(0.0, 0.0, -3.0 - seed)));
}
)";
const char* const kRimMain = R"(
void main() {
  float density = smokeHere();
  pldWriteRim(pldSurface(vec3(0.5 * density), density, vec3(0.0), vec3(0.0, 0.0, -3.0 - seed)), vec3(0.3 * density), pldCoverageGradient(density));
}
)";
const char* const kCasterMain = R"(
void main() {
  float density = smokeHere();
  PldCaster one = PldCaster(density, vec3(0.2, 0.4, 0.6), vec3(0.0, 0.0, -1.0 - 0.2 * seed), vec3(0.0, 0.0, 1.0), 1.0, pldCasterIdentity(uint(seed), 0u));
  pldWriteCaster(one);
}
)";

// The passes of the library, and the programs of an engine that draws into them.
class Bench {
 public:
  Bench();
  ~Bench() {
    for (pld_pass** one : {&pass_, &dark_, &plain_}) pld_destroy(one);
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  void layers(int count) { stage(PLD_STAGE_LAYERS, layers_, count, 2); }
  void rims(int count) { stage(PLD_STAGE_RIMS, rims_, count, 2); }
  void low(int count, int factor) { stage(PLD_STAGE_LOW, low_, count, factor); }
  // One layer under front+tail; its nearest depth is drawn before.
  void fronted(bool rimmed, bool nearest);
  void face(int count);  // of the shadow map

 private:
  void makeMaps();
  GLuint layerOf(pld_pass* of, pld_stage stage, const char* main) const;
  void draw(GLuint program, int count, int width, int height) const;
  void stage(pld_stage which, GLuint program, int count, int factor);

  GlContext context_;
  Host host_{kWidth, kHeight};
  pld_pass *pass_ = nullptr, *dark_ = nullptr, *plain_ = nullptr;  // of `dark` the seam darkens rims itself
  GLuint layers_ = 0, rims_ = 0, low_ = 0, casters_ = 0, array_ = 0;
  GLuint fronts_[2][2] = {};  // plain or dark; nearest depth, then the layer
  pld_frame frame_{};
  pld_shadow_view view_{};
};

Bench::Bench() {
  pld_create_info info = host_.info();
  info.features = PLD_FEATURE_LIGHT | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
  need(pld_create(&info, &pass_), pass_);
  need(pld_resize(pass_, kWidth, kHeight), pass_);
  makeMaps();
  info.method = PLD_METHOD_FRONT_TAIL;
  info.features = PLD_FEATURE_LIGHT | PLD_FEATURE_RIMS;
  need(pld_create(&info, &dark_), dark_);
  info.features = PLD_FEATURE_LIGHT;
  need(pld_create(&info, &plain_), plain_);
  for (pld_pass* one : {dark_, plain_}) need(pld_resize(one, kWidth, kHeight), one);
  layers_ = layerOf(pass_, PLD_STAGE_LAYERS, kRimMain);
  rims_ = layerOf(pass_, PLD_STAGE_RIMS, kRimMain);
  low_ = layerOf(pass_, PLD_STAGE_LOW, kRimMain);
  for (const bool rimmed : {false, true})
    for (const bool nearest : {true, false})
      fronts_[rimmed][nearest ? 0 : 1] = layerOf(rimmed ? dark_ : plain_, nearest ? PLD_STAGE_FRONT : PLD_STAGE_LAYERS,
                                                 rimmed ? kRimMain : kPlainMain);
  glCreateVertexArrays(1, &array_);
  frame_ = host_.frame();
}

void Bench::makeMaps() {
  pld_shadow_info maps{};
  maps.struct_size = sizeof(maps);
  maps.size = kMap;
  maps.lights = maps.faces = maps.coloured = 1;
  maps.closer_edge = 4;
  maps.uniform_binding = 5;
  maps.texture_unit = 9;
  need(pld_shadow_resize(pass_, &maps), pass_);
  const char* caster = nullptr;
  need(pld_shadow_glsl(pass_, PLD_SHADOW_TEXT_CASTER, 450, &caster), pass_);
  casters_ = programOf(caster, kCasterMain);
  view_.struct_size = sizeof(view_);
  view_.faces = 1;
  for (const int i : {0, 5, 10, 15}) view_.light_from_scene[i] = view_.projection[i] = 1.0f;
  view_.near_depth = 1.0f;
  view_.far_depth = 3.0f;
}

GLuint Bench::layerOf(pld_pass* of, pld_stage stage, const char* main) const {
  const char* seam = nullptr;
  need(pld_glsl(of, stage, 450, &seam), of);
  return programOf(seam, main);
}

void Bench::draw(GLuint program, int count, int width, int height) const {
  glBindVertexArray(array_);
  glUseProgram(program);
  glUniform2f(glGetUniformLocation(program, "size"), static_cast<float>(width), static_cast<float>(height));
  for (int i = 0; i < count; ++i) {
    glUniform1f(glGetUniformLocation(program, "seed"), static_cast<float>(i));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

void Bench::stage(pld_stage which, GLuint program, int count, int factor) {
  frame_.low_factor = factor;
  need(pld_begin(pass_, which, &frame_), pass_);
  draw(program, count, which == PLD_STAGE_LOW ? kWidth / factor : kWidth,
       which == PLD_STAGE_LOW ? kHeight / factor : kHeight);
  need(pld_end(pass_), pass_);
}

void Bench::fronted(bool rimmed, bool nearest) {
  pld_pass* const of = rimmed ? dark_ : plain_;
  need(pld_begin(of, nearest ? PLD_STAGE_FRONT : PLD_STAGE_LAYERS, &frame_), of);
  draw(fronts_[rimmed][nearest ? 0 : 1], 1, kWidth, kHeight);
  need(pld_end(of), of);
}

void Bench::face(int count) {
  need(pld_shadow_begin(pass_, &view_), pass_);
  draw(casters_, count, kMap, kMap);
  need(pld_shadow_end(pass_), pass_);
}

struct Part {
  const char* what;
  std::function<void()> before, timed;
  std::vector<double> times;
};

std::vector<Part> partsOf(Bench& bench) {
  const auto whole = [&] { bench.layers(0), bench.rims(0); };
  const auto filled = [&] { bench.layers(1); };
  return {{"8 layers of smoke at full resolution", [] {}, [&] { bench.layers(kLayers); }, {}},
          {"the same at 1/2, upsampled", whole, [&] { bench.low(kLayers, 2); }, {}},
          {"the same at 1/4", whole, [&] { bench.low(kLayers, 4); }, {}},
          {"the same at 1/8", whole, [&] { bench.low(kLayers, 8); }, {}},
          {"upsampling nothing", whole, [&] { bench.low(0, 4); }, {}},
          {"rims on every pixel, one layer of them, darkened", filled, [&] { bench.rims(1); }, {}},
          {"a layer under front+tail, without rims",
           [&] { bench.fronted(false, true); },
           [&] { bench.fronted(false, false); },
           {}},
          {"the same, rims on every pixel, which its seam darkens",
           [&] { bench.fronted(true, true); },
           [&] { bench.fronted(true, false); },
           {}},
          {"no rims", filled, [&] { bench.rims(0); }, {}},
          {"a coloured shadow map of 512 x 512, 8 casters that fill it", [] {}, [&] { bench.face(kLayers); }, {}},
          {"the same map, nothing drawn: its filter", [] {}, [&] { bench.face(0); }, {}}};
}

void run() {
  Bench bench;
  std::vector<Part> parts = partsOf(bench);
  for (int turn = 0; turn < kTurns; ++turn)
    for (Part& part : parts) {
      part.before();
      part.times.push_back(milliseconds(part.timed));
    }
  std::printf("%dx%d, medians of %d\n| what | ms | over 8 full layers |\n| --- | --- | --- |\n", kWidth, kHeight,
              kTurns);
  for (const Part& part : parts)
    std::printf("| %s | %.1f | %.2f |\n", part.what, median(part.times), median(part.times) / median(parts[0].times));
}

}  // namespace
}  // namespace pellucid::test

int main() {
  pellucid::test::run();
}
