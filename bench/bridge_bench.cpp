// What the engine bridge costs beside one alpha-blended pass with the same geometry and the same shading. Ratios of
// medians, taken in turns, so that a busy machine slows both.
//
//   bench_bridge [--processor-time] [flags of Google Benchmark]
//
// --processor-time measures what a CPU rasteriser takes of the processor, not what passes on the clock: for busy
// machines, with LP_NUM_THREADS=0 in the environment, so that no rasteriser thread waits for another.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 480, kHeight = 270, kLayers = 8, kCells = 24;

// Layers of a grid each, tilted: 8 x 1152 triangles. Layer 0 is cut out, and the one that can be solid.
const char* const kVertex = R"(#version 450 core
layout(location = 0) in vec3 position;
uniform mat4 clipFromView;
out vec3 viewPosition;
void main() {
  viewPosition = position;
  gl_Position = clipFromView * vec4(position, 1.0);
}
)";

// Three point lights by GGX, an environment, a base texture and a shadow map of four taps, or none of it.
const char* const kShading = R"(
in vec3 viewPosition;
layout(binding = 0) uniform sampler2D base;
layout(binding = 1) uniform sampler2D environment;
layout(binding = 2) uniform sampler2DShadow shadowMap;
uniform vec4 tint;
#ifdef LIT
vec3 shade(vec3 n, vec3 toEye, vec3 albedo, float f0) {
  vec3 sum = vec3(0.0);
  float cosEye = max(dot(n, toEye), 1e-4), a = 0.09, a2 = a * a;
  for (int i = 0; i < 3; ++i) {
    vec3 to = vec3(float(i) * 2.0 - 2.0, 3.0, -2.0) - viewPosition;
    float squared = dot(to, to);
    vec3 l = to * inversesqrt(squared), h = normalize(l + toEye);
    float cosLight = max(dot(n, l), 0.0), cosHalf = max(dot(n, h), 0.0), spread = cosHalf * cosHalf * (a2 - 1.0) + 1.0;
    float visible = 0.5 / (cosLight * sqrt(cosEye * cosEye * (1.0 - a2) + a2) + cosEye * sqrt(cosLight * cosLight * (1.0 - a2) + a2) + 1e-6);
    float f = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, l), 0.0), 5.0);
    sum += (albedo / 3.14159265 + vec3(f * visible * a2 / (3.14159265 * spread * spread))) * cosLight * (10.0 / squared);
  }
  vec3 r = reflect(-toEye, n);
  vec3 about = textureLod(environment, r.xy * 0.5 + 0.5, 2.0).rgb * f0 + textureLod(environment, n.xy * 0.5 + 0.5, 4.0).rgb * albedo;
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) lit += texture(shadowMap, vec3(viewPosition.xy * 0.1 + 0.5 + vec2(i & 1, i >> 1) * 0.001, 0.4));
  return sum * (lit * 0.25) + about;
}
#endif
void shaded(out vec3 radiance, out float coverage, out vec3 transmission, out vec3 normal) {
  normal = vec3(0.0, 0.0, 1.0);
  coverage = tint.a;
  transmission = vec3(0.0);
  radiance = tint.rgb;
#ifdef LIT
  vec4 texel = texture(base, viewPosition.xy);
  vec3 toEye = normalize(-viewPosition);
  normal = normalize(vec3(0.1 * texel.xy, 1.0));
  coverage *= texel.a;
  transmission = texel.rgb * 0.8;
  radiance = shade(normal, toEye, tint.rgb * texel.rgb, 0.04);
#endif
  radiance *= coverage;
}
)";
const char* const kBlendMain = R"(
layout(location = 0) out vec4 colour;
void main() {
  vec3 radiance, transmission, normal;
  float coverage;
  shaded(radiance, coverage, transmission, normal);
  colour = vec4(radiance, coverage);
}
)";
const char* const kSeamMain = R"(
void main() {
  vec3 radiance, transmission, normal;
  float coverage;
  shaded(radiance, coverage, transmission, normal);
  PldSurface surface = pldSurface(radiance, coverage, transmission, viewPosition);
#ifdef LIT
  surface.normal = normal;
  surface.eta = 1.0 / 1.5;
  surface.collimation = 0.9;
#endif
#ifdef PLD_MARKS
  surface.motion = 4.0 * viewPosition.xy;
  surface.identity = uint(gl_PrimitiveID);
#endif
  pldWriteFragment(surface);
}
)";

struct Kind {
  const char* what;
  bool lit;
  pld_method method;
  pld_tier tier;
  uint32_t features;
  uint32_t fixed;
  double aim;  // ratio to the alpha-blended pass; 0: for the table alone
};

class Frame {
 public:
  Frame() : host_(kWidth, kHeight) {
    depth_ = makeTexture(GL_DEPTH_COMPONENT32F, kWidth, kHeight);
    blended_ = makeTexture(GL_RGBA16F, kWidth, kHeight);
    const float far = 1.0f;
    glClearTexImage(depth_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &far);
    glCreateFramebuffers(1, &framebuffer_);
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, blended_, 0);
    glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_, 0);
    makeTextures();
    makeLayers();
  }

  GLuint shader(const char* seam, bool lit) {
    std::string text = std::string("#version 450 core\n") + (lit ? "#define LIT\n" : "") + (seam ? seam : "") +
                       kShading + (seam ? kSeamMain : kBlendMain);
    const GLuint name = makeProgram(kVertex, text);
    if (!name) std::exit(1);
    glProgramUniformMatrix4fv(name, glGetUniformLocation(name, "clipFromView"), 1, GL_FALSE, frame().projection);
    return name;
  }
  pld_frame frame() const {
    pld_frame frame = host_.frame();
    frame.depth_texture = depth_;
    frame.projection[10] = -1.002f;
    frame.projection[14] = -0.2002f;
    return frame;
  }
  Host& host() { return host_; }

  void draw(GLuint program, bool solidsOnly) {
    glUseProgram(program);
    glBindVertexArray(array_);
    for (GLuint i = 0; i < 3; ++i) glBindTextureUnit(i, textures_[i]);
    const GLint tint = glGetUniformLocation(program, "tint");
    for (int layer = 0; layer < (solidsOnly ? 1 : kLayers); ++layer) {
      glUniform4f(tint, 0.2f + 0.1f * static_cast<float>(layer), 0.5f, 0.4f, 0.4f);
      glDrawArrays(GL_TRIANGLES, layer * kCells * kCells * 6, kCells * kCells * 6);
    }
  }
  void drawBlended(GLuint program) {
    const float clear[4] = {0.5f, 0.4f, 0.3f, 1.0f};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, kWidth, kHeight);
    glClearNamedFramebufferfv(framebuffer_, GL_COLOR, 0, clear);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw(program, false);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
  }

 private:
  void makeTextures() {
    std::vector<float> noise(256 * 256 * 4);
    std::uint32_t state = 1;
    for (float& one : noise) state = state * 1664525u + 1013904223u, one = static_cast<float>(state >> 8) * 0x1p-24f;
    for (int i = 0; i < 2; ++i) {
      glCreateTextures(GL_TEXTURE_2D, 1, &textures_[i]);
      glTextureStorage2D(textures_[i], 6, i ? GL_RGBA16F : GL_RGBA8, 256, 256);
      fillTexture(textures_[i], 256, 256, GL_RGBA, noise.data());
      glGenerateTextureMipmap(textures_[i]);
    }
    textures_[2] = makeTexture(GL_DEPTH_COMPONENT32F, 512, 512);
    const float half = 0.5f;
    glClearTexImage(textures_[2], 0, GL_DEPTH_COMPONENT, GL_FLOAT, &half);
    glTextureParameteri(textures_[2], GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  }
  void makeLayers() {
    std::vector<float> corners;
    for (int layer = 0; layer < kLayers; ++layer)
      for (int cell = 0; cell < kCells * kCells; ++cell)
        for (const int corner : {0, 1, 3, 0, 3, 2}) {
          const float x = (static_cast<float>(cell % kCells) + static_cast<float>(corner & 1)) / kCells * 2 - 1;
          const float y = (static_cast<float>(cell / kCells) + static_cast<float>(corner >> 1)) / kCells * 2 - 1;
          const float z = 2.0f + static_cast<float>(layer) + 0.3f * x;
          corners.insert(corners.end(), {x * z * 0.9f, y * z * 0.51f, -z});
        }
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferData(buffer, static_cast<GLsizeiptr>(corners.size() * 4), corners.data(), GL_STATIC_DRAW);
    glCreateVertexArrays(1, &array_);
    glVertexArrayVertexBuffer(array_, 0, buffer, 0, 12);
    glEnableVertexArrayAttrib(array_, 0);
    glVertexArrayAttribFormat(array_, 0, 3, GL_FLOAT, GL_FALSE, 0);
  }

  Host host_;
  GLuint depth_ = 0, blended_ = 0, framebuffer_ = 0, textures_[3] = {}, array_ = 0;
};

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool processorTime = false;

double now() {
  timespec time{};
  clock_gettime(processorTime ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

template <class F>
double milliseconds(F f) {
  glFinish();
  const double start = now();
  f();
  glFinish();
  return now() - start;
}

void need(pld_status status, pld_pass* pass) {
  if (status == PLD_OK) return;
  std::fprintf(stderr, "%s: %s\n", pld_status_name(status), pld_message(pass));
  std::exit(1);
}

void measure(benchmark::State& state, const Kind& kind) {
  GlContext context;
  Frame scene;
  pld_create_info info = scene.host().info();
  info.method = kind.method;
  info.tier = kind.tier;
  info.features = kind.features;
  info.depth = PLD_DEPTH_DEVICE;
  info.fragments_per_pixel = kLayers;
  pld_pass* pass = nullptr;
  need(pld_create(&info, &pass), pass);
  const pld_frame frame = scene.frame();
  need(pld_fix(pass, &frame, kind.fixed), pass);
  need(pld_resize(pass, kWidth, kHeight), pass);
  std::vector<std::pair<pld_stage, GLuint>> stages;
  const auto add = [&](pld_stage stage) {
    const char* seam = nullptr;
    need(pld_glsl(pass, stage, 450, &seam), pass);
    stages.emplace_back(stage, scene.shader(seam, kind.lit));
  };
  if (kind.features & PLD_FEATURE_SOLIDS) add(PLD_STAGE_SOLIDS);
  const bool nearest = kind.method == PLD_METHOD_FRONT_TAIL || (kind.features & PLD_FEATURE_IDENTITY);
  if (nearest && kind.tier != PLD_TIER_EXACT) add(PLD_STAGE_FRONT);
  add(PLD_STAGE_LAYERS);
  const GLuint blend = scene.shader(nullptr, kind.lit);
  const pld_target target = scene.host().target();
  const auto layers = [&] {
    for (const auto& [stage, program] : stages) {
      need(pld_begin(pass, stage, &frame), pass);
      scene.draw(program, stage == PLD_STAGE_SOLIDS);
      need(pld_end(pass), pass);
    }
  };
  std::vector<double> ours, theirs, resolve;
  for (auto _ : state) {
    theirs.push_back(milliseconds([&] { scene.drawBlended(blend); }));
    ours.push_back(milliseconds(layers));
    resolve.push_back(milliseconds([&] { need(pld_resolve(pass, &target), pass); }));
    state.SetIterationTime(ours.back() * 1e-3);
  }
  uint64_t bits = 0, planes = 0, passes = 0, bytes = 0;
  need(pld_query(pass, PLD_VALUE_BITS_PER_PIXEL, &bits), pass);
  need(pld_query(pass, PLD_VALUE_PLANES, &planes), pass);
  need(pld_query(pass, PLD_VALUE_GEOMETRY_PASSES, &passes), pass);
  need(pld_query(pass, PLD_VALUE_BYTES, &bytes), pass);
  const double ratio = median(ours) / median(theirs);
  std::printf("| %s | %llu | %llu | %.0f | %llu | %.2f | %.2f |%s  %.1f / %.1f ms\n", kind.what,
              static_cast<unsigned long long>(planes), static_cast<unsigned long long>(bits),
              static_cast<double>(bytes) * 8 / (kWidth * kHeight), static_cast<unsigned long long>(passes), ratio,
              median(resolve) / median(theirs),
              kind.aim > 0 ? (ratio <= kind.aim ? "  holds" : "  MISSES its aim") : "", median(ours), median(theirs));
  std::fflush(stdout);
  pld_destroy(&pass);
}

constexpr uint32_t kColoured = PLD_FEATURE_COLOURED, kLight = PLD_FEATURE_LIGHT,
                   kScatter = PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION, kSolids = PLD_FEATURE_SOLIDS;
// All but the exposure, which engines adapt.
constexpr uint32_t kFixed = PLD_FIXED_UNITS | PLD_FIXED_WEIGHT | PLD_FIXED_REFRACTION | PLD_FIXED_DIFFUSION |
                            PLD_FIXED_PROJECTION | PLD_FIXED_LENS;
const Kind kKinds[] = {
    {"lit, float, full model", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kColoured | kScatter, kFixed, 1.3},
    {"lit, float, full model, all fixed", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kColoured | kScatter,
     kFixed | PLD_FIXED_EXPOSURE, 1.3},
    {"lit, float, full model, nothing fixed", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kColoured | kScatter,
     0, 0},
    {"lit, float, full model, light that adds", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | kLight, kFixed, 1.3},
    {"lit, float, full model, light that adds, all fixed", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | kLight, kFixed | PLD_FIXED_EXPOSURE, 1.3},
    {"lit, float, full model, solids", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | kSolids, kFixed, 0},
    {"lit, float, full model, light that adds, solids", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | kLight | kSolids, kFixed, 0},
    {"lit, half, full model, light that adds, solids", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF,
     kColoured | kScatter | kLight | kSolids, kFixed, 0},
    {"lit, half, full model, light that adds", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF,
     kColoured | kLight | kScatter, kFixed, 0},
    {"lit, half, refraction, light that adds", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF,
     kColoured | kLight | PLD_FEATURE_REFRACTION, kFixed, 0},
    {"lit, float, grey, full model, light that adds", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kLight | kScatter, kFixed, 0},
    {"lit, published, full model, solids", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, kScatter | kSolids,
     kFixed, 0},
    {"lit, float, refraction", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kColoured | PLD_FEATURE_REFRACTION,
     kFixed, 0},
    {"lit, float, diffusion", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kColoured | PLD_FEATURE_DIFFUSION,
     kFixed, 0},
    {"lit, float, coloured, light, solids", true, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, kColoured | kLight | kSolids,
     kFixed, 0},
    {"lit, float, full model, depths", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | PLD_FEATURE_DEPTHS, kFixed, 0},
    {"lit, float, full model, motion", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | PLD_FEATURE_MOTION, kFixed, 0},
    {"lit, float, full model, motion, identity", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
     kColoured | kScatter | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY, kFixed, 0},
    {"lit, float, coloured, light", true, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, kColoured | kLight, kFixed, 1.3},
    {"unlit, float, grey", false, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, 0, kFixed, 3},
    {"unlit, float, grey, light", false, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, kLight, kFixed, 3},
    {"unlit, float, coloured", false, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, kColoured, kFixed, 3},
    {"unlit, float, coloured, light", false, PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, kColoured | kLight, kFixed, 3},
    {"unlit, half, grey", false, PLD_METHOD_WEIGHTED, PLD_TIER_HALF, 0, kFixed, 0},
    {"unlit, half, grey, all fixed", false, PLD_METHOD_WEIGHTED, PLD_TIER_HALF, 0, kFixed | PLD_FIXED_EXPOSURE, 0},
    {"unlit, published", false, PLD_METHOD_WEIGHTED, PLD_TIER_PUBLISHED, 0, kFixed, 0},
    {"unlit, float, front+tail, grey", false, PLD_METHOD_FRONT_TAIL, PLD_TIER_FLOAT, 0, kFixed, 0},
    {"lit, exact, full model, light that adds", true, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT,
     kColoured | kLight | kScatter, kFixed, 0},
    {"unlit, exact, grey", false, PLD_METHOD_WEIGHTED, PLD_TIER_EXACT, 0, kFixed, 0},
    {"unlit, exact, coloured, light", false, PLD_METHOD_WEIGHTED, PLD_TIER_EXACT, kColoured | kLight, kFixed, 0},
    {"unlit, exact, front+tail, grey", false, PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, 0, kFixed, 0}};

}  // namespace
}  // namespace pellucid::test

int main(int count, char** arguments) {
  using namespace pellucid::test;
  for (int i = 1; i < count; ++i)
    if (std::strcmp(arguments[i], "--processor-time") == 0) processorTime = true;
  benchmark::Initialize(&count, arguments);
  std::printf("%dx%d, %d layers; medians over a blended RGBA16F pass with the same shading\n", kWidth, kHeight,
              kLayers);
  std::printf(
      "| what | planes | bits a pixel | bits with everything | geometry passes | begin, draws, end | resolve |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Kind& kind : kKinds)
    benchmark::RegisterBenchmark(kind.what, [&kind](benchmark::State& state) { measure(state, kind); })
        ->Iterations(9)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  class Quiet : public benchmark::BenchmarkReporter {  // the table is printed as it is made
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>&) override {}
  } quiet;
  benchmark::RunSpecifiedBenchmarks(&quiet);
}
