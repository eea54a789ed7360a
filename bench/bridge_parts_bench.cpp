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

void run() {
  GlContext context;
  Host host(kWidth, kHeight);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_LIGHT | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
  pld_pass* pass = nullptr;
  need(pld_create(&info, &pass), pass);
  need(pld_resize(pass, kWidth, kHeight), pass);
  pld_shadow_info maps{};
  maps.struct_size = sizeof(maps);
  maps.size = kMap;
  maps.lights = maps.faces = maps.coloured = 1;
  maps.closer_edge = 4;
  maps.uniform_binding = 5;
  maps.texture_unit = 9;
  need(pld_shadow_resize(pass, &maps), pass);
  // Of these the seam darkens rims itself.
  info.method = PLD_METHOD_FRONT_TAIL;
  info.features = PLD_FEATURE_LIGHT | PLD_FEATURE_RIMS;
  pld_pass *dark = nullptr, *plain = nullptr;
  need(pld_create(&info, &dark), dark);
  info.features = PLD_FEATURE_LIGHT;
  need(pld_create(&info, &plain), plain);
  for (pld_pass* one : {dark, plain}) need(pld_resize(one, kWidth, kHeight), one);
  const auto layerFor = [&](pld_pass* of, pld_stage stage) {
    const char* seam = nullptr;
    need(pld_glsl(of, stage, 450, &seam), of);
    return programOf(seam, of == plain ? R"(
void main() {
  float density = smokeHere();
  pldWriteFragment(pldSurface(vec3(0.5 * density), density, vec3(0.0), vec3(0.0, 0.0, -3.0 - seed)));
}
)"
                                       : R"(
void main() {
  float density = smokeHere();
  pldWriteRim(pldSurface(vec3(0.5 * density), density, vec3(0.0), vec3(0.0, 0.0, -3.0 - seed)), vec3(0.3 * density), pldCoverageGradient(density));
}
)");
  };
  const auto layerOf = [&](pld_stage stage) { return layerFor(pass, stage); };
  const char* caster = nullptr;
  need(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &caster), pass);
  const GLuint layers = layerOf(PLD_STAGE_LAYERS), rims = layerOf(PLD_STAGE_RIMS), low = layerOf(PLD_STAGE_LOW),
               casters = programOf(caster, R"(
void main() {
  float density = smokeHere();
  PldCaster one = PldCaster(density, vec3(0.2, 0.4, 0.6), vec3(0.0, 0.0, -1.0 - 0.2 * seed), vec3(0.0, 0.0, 1.0), 1.0, pldCasterIdentity(uint(seed), 0u));
  pldWriteCaster(one);
}
)");
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  const auto draw = [&](GLuint program, int count, int width, int height) {
    glBindVertexArray(array);
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "size"), static_cast<float>(width), static_cast<float>(height));
    for (int i = 0; i < count; ++i) {
      glUniform1f(glGetUniformLocation(program, "seed"), static_cast<float>(i));
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  };
  pld_frame frame = host.frame();
  // One layer under front+tail; its nearest depth is drawn before.
  const GLuint programs[2][2] = {{layerFor(plain, PLD_STAGE_FRONT), layerFor(plain, PLD_STAGE_LAYERS)},
                                 {layerFor(dark, PLD_STAGE_FRONT), layerFor(dark, PLD_STAGE_LAYERS)}};
  const auto fronted = [&](bool rimmed, bool nearest) {
    pld_pass* const of = rimmed ? dark : plain;
    need(pld_begin(of, nearest ? PLD_STAGE_FRONT : PLD_STAGE_LAYERS, &frame), of);
    draw(programs[rimmed][nearest ? 0 : 1], 1, kWidth, kHeight);
    need(pld_end(of), of);
  };
  const auto stage = [&](pld_stage which, GLuint program, int count, int factor) {
    frame.low_factor = factor;
    need(pld_begin(pass, which, &frame), pass);
    draw(program, count, which == PLD_STAGE_LOW ? kWidth / factor : kWidth,
         which == PLD_STAGE_LOW ? kHeight / factor : kHeight);
    need(pld_end(pass), pass);
  };
  pld_shadow_view view{};
  view.struct_size = sizeof(view);
  view.faces = 1;
  for (const int i : {0, 5, 10, 15}) view.light_from_scene[i] = view.projection[i] = 1.0f;
  view.near_depth = 1.0f;
  view.far_depth = 3.0f;
  const auto face = [&](int count) {
    need(pld_shadow_begin(pass, &view), pass);
    draw(casters, count, kMap, kMap);
    need(pld_shadow_end(pass), pass);
  };
  struct Part {
    const char* what;
    std::function<void()> before, timed;
    std::vector<double> times;
  };
  const auto whole = [&] { stage(PLD_STAGE_LAYERS, layers, 0, 2), stage(PLD_STAGE_RIMS, rims, 0, 2); };
  const auto filled = [&] { stage(PLD_STAGE_LAYERS, layers, 1, 2); };
  std::vector<Part> parts{
      {"8 layers of smoke at full resolution", [] {}, [&] { stage(PLD_STAGE_LAYERS, layers, kLayers, 2); }, {}},
      {"the same at 1/2, upsampled", whole, [&] { stage(PLD_STAGE_LOW, low, kLayers, 2); }, {}},
      {"the same at 1/4", whole, [&] { stage(PLD_STAGE_LOW, low, kLayers, 4); }, {}},
      {"the same at 1/8", whole, [&] { stage(PLD_STAGE_LOW, low, kLayers, 8); }, {}},
      {"upsampling nothing", whole, [&] { stage(PLD_STAGE_LOW, low, 0, 4); }, {}},
      {"rims on every pixel, one layer of them, darkened", filled, [&] { stage(PLD_STAGE_RIMS, rims, 1, 2); }, {}},
      {"a layer under front+tail, without rims", [&] { fronted(false, true); }, [&] { fronted(false, false); }, {}},
      {"the same, rims on every pixel, which its seam darkens",
       [&] { fronted(true, true); },
       [&] { fronted(true, false); },
       {}},
      {"no rims", filled, [&] { stage(PLD_STAGE_RIMS, rims, 0, 2); }, {}},
      {"a coloured shadow map of 512 x 512, 8 casters that fill it", [] {}, [&] { face(kLayers); }, {}},
      {"the same map, nothing drawn: its filter", [] {}, [&] { face(0); }, {}}};
  for (int turn = 0; turn < kTurns; ++turn)
    for (Part& part : parts) {
      part.before();
      part.times.push_back(milliseconds(part.timed));
    }
  std::printf("%dx%d, medians of %d\n| what | ms | over 8 full layers |\n| --- | --- | --- |\n", kWidth, kHeight,
              kTurns);
  for (const Part& part : parts)
    std::printf("| %s | %.1f | %.2f |\n", part.what, median(part.times), median(part.times) / median(parts[0].times));
  for (pld_pass** one : {&pass, &dark, &plain}) pld_destroy(one);
}

}  // namespace
}  // namespace pellucid::test

int main() {
  pellucid::test::run();
}
