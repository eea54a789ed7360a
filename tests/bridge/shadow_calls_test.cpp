// Shadow maps as an engine uses them: text, wrong calls, and a picture of a floor under coloured panes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/bridge/shadow_casters.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

// All texts side by side, in every GLSL, connected where the info says.
TEST(BridgeShadow, TheTextsCompileAsEveryVersion) {
  GlContext context;
  Host host(16, 16);
  pld_create_info create = host.info();
  create.features =
      PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION | PLD_FEATURE_SOLIDS;
  pld_pass* pass = host.create(create);
  ASSERT_NE(pass, nullptr);
  int compiled = 0;
  for (const bool coloured : {false, true}) {
    const pld_shadow_info info = shadowInfo(coloured ? PLD_SHADOW_VARIANCE : PLD_SHADOW_NAIVE, 64, 3, 8, coloured);
    ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
    for (const int version : {330, 400, 410, 420, 430, 440, 450}) {
      const char *caster = nullptr, *lookup = nullptr, *layers = nullptr;
      ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, version, &caster), PLD_OK);
      ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, version, &lookup), PLD_OK);
      ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, version, &layers), PLD_OK);
      const std::string first = "#version " + std::to_string(version) + " core\n";
      const GLuint one =
          makeProgram(kFullscreenVertex, first + caster + caster + "struct Surface { int steps; };\n" + kPlainCaster);
      const GLuint both = makeProgram(
          kFullscreenVertex,
          first + layers + lookup + lookup +
              "float hashOf(float x) { return x; }\nvoid main() {\n  vec3 p = vec3(gl_FragCoord.xy, -hashOf(3.0));\n"
              "  pldWriteFragment(pldSurface(pldShadow(1, p) + pldShadowOnOpaque(2, p), 0.5, vec3(0.5), p));\n}\n");
      ASSERT_NE(one, 0u) << version;
      ASSERT_NE(both, 0u) << version;
      EXPECT_EQ(pld_connect(pass, one), PLD_OK);
      EXPECT_EQ(pld_connect(pass, both), PLD_OK);
      const auto bindingOf = [](GLuint program, const char* block) {
        GLint binding = -1;
        glGetActiveUniformBlockiv(program, glGetUniformBlockIndex(program, block), GL_UNIFORM_BLOCK_BINDING, &binding);
        return binding;
      };
      EXPECT_EQ(bindingOf(one, "PldShadowFrame"), static_cast<GLint>(create.uniform_binding));
      EXPECT_EQ(bindingOf(both, "PldFrame"), static_cast<GLint>(create.uniform_binding));
      EXPECT_EQ(bindingOf(both, "PldShadows"), static_cast<GLint>(info.uniform_binding));
      GLint unit = -1;
      glGetUniformiv(both, glGetUniformLocation(both, "pldShadowMaps"), &unit);
      EXPECT_EQ(unit, static_cast<GLint>(info.texture_unit));
      glDeleteProgram(one);
      glDeleteProgram(both);
      compiled += 2;
    }
  }
  std::printf("shaders with texts for shadow maps compiled: %d\n", compiled);
  pld_destroy(&pass);
}

TEST(BridgeShadow, WrongCallsAreRefused) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const auto expectRefused = [&](pld_status status, pld_status expected, const char* what) {
    EXPECT_STREQ(pld_status_name(status), pld_status_name(expected)) << what << ": " << pld_message(pass);
    EXPECT_GT(std::string(pld_message(pass)).size(), 10u) << what;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << what;
  };
  const pld_shadow_info good = shadowInfo(PLD_SHADOW_VARIANCE, 64, 2, 7, true);
  const char* text = nullptr;
  const pld_shadow_view sun = plainShadowView();
  EXPECT_EQ(pld_shadow_resize(nullptr, &good), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_begin(nullptr, &sun), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_end(nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_glsl(nullptr, PLD_SHADOW_TEXT_CASTER, 330, &text), PLD_ERROR_ARGUMENT);
  expectRefused(pld_shadow_begin(pass, &sun), PLD_ERROR_ORDER, "begin before resize");
  expectRefused(pld_shadow_end(pass), PLD_ERROR_ORDER, "end before begin");
  uint64_t time = 0;
  expectRefused(pld_query(pass, PLD_VALUE_NS_SHADOW, &time), PLD_ERROR_UNSUPPORTED, "no timers");
  expectRefused(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, 330, &text), PLD_ERROR_ORDER, "text before resize");
  const auto info = [&](auto change, pld_status expected, const char* what) {
    pld_shadow_info changed = good;
    change(changed);
    expectRefused(pld_shadow_resize(pass, &changed), expected, what);
  };
  info([](auto& i) { i.struct_size = 1; }, PLD_ERROR_VERSION, "info.struct_size");
  info([](auto& i) { i.form = static_cast<pld_shadow_form>(5); }, PLD_ERROR_ARGUMENT, "form");
  for (const int size : {-4, 0, 12, 66, 1 << 20}) info([&](auto& i) { i.size = size; }, PLD_ERROR_SIZE, "size");
  for (const int lights : {0, 17}) info([&](auto& i) { i.lights = lights; }, PLD_ERROR_ARGUMENT, "lights");
  for (const int faces : {0, 97}) info([&](auto& i) { i.faces = faces; }, PLD_ERROR_ARGUMENT, "faces");
  for (const int edge : {0, 17}) info([&](auto& i) { i.closer_edge = edge; }, PLD_ERROR_ARGUMENT, "closer_edge");
  info([](auto& i) { i.form = PLD_SHADOW_NAIVE, i.size = 4096, i.faces = 96; }, PLD_ERROR_SIZE, "too many texels");
  info([](auto& i) { i.uniform_binding = 1u << 20; }, PLD_ERROR_ARGUMENT, "binding");
  info([](auto& i) { i.uniform_binding = 3; }, PLD_ERROR_ARGUMENT, "the seam's binding");
  for (const uint32_t unit : {4u, 6u, 1u << 20})
    info([&](auto& i) { i.texture_unit = unit; }, PLD_ERROR_ARGUMENT, "the seam's unit");
  ASSERT_EQ(pld_shadow_resize(pass, &good), PLD_OK) << pld_message(pass);
  expectRefused(pld_shadow_glsl(pass, static_cast<pld_shadow_text>(2), 330, &text), PLD_ERROR_ARGUMENT, "no text");
  expectRefused(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 320, &text), PLD_ERROR_ARGUMENT, "no GLSL");
  expectRefused(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 330, nullptr), PLD_ERROR_ARGUMENT, "null text");
  expectRefused(pld_shadow_begin(pass, nullptr), PLD_ERROR_ARGUMENT, "null view");
  const auto view = [&](auto change, pld_status expected, const char* what) {
    pld_shadow_view changed = sun;
    change(changed);
    expectRefused(pld_shadow_begin(pass, &changed), expected, what);
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const GLuint byte = makeTexture(GL_R8, 64, 64), small = makeTexture(GL_DEPTH_COMPONENT32F, 63, 64);
  view([](auto& v) { v.struct_size -= 4; }, PLD_ERROR_VERSION, "view.struct_size");
  view([](auto& v) { v.kind = static_cast<pld_light>(2); }, PLD_ERROR_ARGUMENT, "kind");
  view([](auto& v) { v.light = 2; }, PLD_ERROR_ARGUMENT, "light");
  view([](auto& v) { v.light = -1; }, PLD_ERROR_ARGUMENT, "light");
  view([](auto& v) { v.faces = 6; }, PLD_ERROR_ARGUMENT, "six faces of a sun");
  view([](auto& v) { v.first_face = 7; }, PLD_ERROR_ARGUMENT, "no such face");
  view([](auto& v) { v.first_face = std::numeric_limits<int32_t>::max(); }, PLD_ERROR_ARGUMENT, "no such face");
  view([](auto& v) { v.face = 1; }, PLD_ERROR_ARGUMENT, "second face of one");
  view([](auto& v) { v.light_from_scene[0] = 2.0f; }, PLD_ERROR_ARGUMENT, "a scale");
  view([](auto& v) { v.light_from_scene[3] = nan; }, PLD_ERROR_ARGUMENT, "NaN");
  view([](auto& v) { v.projection[11] = -1.0f; }, PLD_ERROR_ARGUMENT, "a sun in perspective");
  view([](auto& v) { v.projection[0] = 0.0f; }, PLD_ERROR_ARGUMENT, "no focal length");
  view([](auto& v) { v.far_depth = v.near_depth; }, PLD_ERROR_ARGUMENT, "no depth");
  view([](auto& v) { v.kind = PLD_LIGHT_LOCAL; }, PLD_ERROR_ARGUMENT, "a spot without perspective");
  view(
      [](auto& v) {
        v.kind = PLD_LIGHT_LOCAL;
        v.faces = 6;
        v.projection[11] = -1.0f;
        v.projection[15] = 0.0f;
      },
      PLD_ERROR_ARGUMENT, "a cube's face of 90 degrees");
  view([](auto& v) { v.depth_texture = 4711; }, PLD_ERROR_TEXTURE, "no texture");
  view([&](auto& v) { v.depth_texture = byte; }, PLD_ERROR_FORMAT, "bytes");
  view([&](auto& v) { v.depth_texture = small; }, PLD_ERROR_SIZE, "small depth");
  const pld_frame frame = host.frame();
  const pld_target target = host.target();
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  expectRefused(pld_shadow_begin(pass, &sun), PLD_ERROR_ORDER, "within a stage");
  expectRefused(pld_shadow_resize(pass, &good), PLD_ERROR_ORDER, "resize within a stage");
  ASSERT_EQ(pld_end(pass), PLD_OK);
  // Between a frame's stages and its resolve a map may be drawn.
  ASSERT_EQ(pld_shadow_begin(pass, &sun), PLD_OK);
  expectRefused(pld_shadow_resize(pass, nullptr), PLD_ERROR_ORDER, "resize within a face");
  expectRefused(pld_resize(pass, 8, 8), PLD_ERROR_ORDER, "resize within a face");
  expectRefused(pld_resolve(pass, &target), PLD_ERROR_ORDER, "resolve within a face");
  expectRefused(pld_end(pass), PLD_ERROR_ORDER, "end of a stage within a face");
  ASSERT_EQ(pld_shadow_end(pass), PLD_OK);
  expectRefused(pld_shadow_end(pass), PLD_ERROR_ORDER, "end twice");
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(host.picture(), readTexture(host.colour, 16, 16, GL_RGBA));
  uint64_t value = 1;
  ASSERT_EQ(pld_shadow_resize(pass, nullptr), PLD_OK);
  ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &value), PLD_OK);
  EXPECT_EQ(value, 0u);
  expectRefused(pld_shadow_begin(pass, &sun), PLD_ERROR_ORDER, "begin without maps");
  pld_destroy(&pass);
}

// Lights without a face, and numbers that no light has, shine undimmed; what stands behind the opaque casts nothing.
TEST(BridgeShadow, NothingDrawnIsNoShadow) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const pld_shadow_info info = shadowInfo(PLD_SHADOW_VARIANCE, 64, 2, 2, true);
  ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
  const char* seam = nullptr;
  ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &seam), PLD_OK);
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + kPlainCaster);
  const GLuint depth = makeTexture(GL_DEPTH_COMPONENT32F, 64, 64);
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  pld_shadow_view view = plainShadowView();
  const std::vector<float> below = {.1f, .2f, -5, 0}, above = {.1f, .2f, -1, 0}, beside = {1.5f, .2f, -5, 0};
  const auto red = [&](int light, const std::vector<float>& point) {
    return askShadows(pass, info, light, point, false)[0];
  };
  for (const int light : {-1, 0, 1, 2, 1000}) EXPECT_EQ(red(light, below), 1.0f);
  for (const float opaque : {1.0f, 0.0f}) {  // behind the casters, which are drawn at .75; before them
    glClearTexImage(depth, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &opaque);
    view.depth_texture = depth;
    ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
    glUseProgram(program);
    glBindVertexArray(array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    ASSERT_EQ(pld_shadow_end(pass), PLD_OK);
    // Half of it touched, .25 let through there: .625 is left, but for the rounding of optical depth to 1/4096.
    EXPECT_NEAR(red(0, below), opaque == 1.0f ? .625f : 1.0f, 1e-3f);
    EXPECT_EQ(red(0, above), 1.0f);
    EXPECT_EQ(red(0, beside), 1.0f);
    EXPECT_EQ(red(1, below), 1.0f);
  }
  pld_destroy(&pass);
}

// Panes between a slanted sun and a floor, all in view space.
struct Pane {
  float y, left, right, back, front;
  glm::vec3 colour;
};
const Pane kPanes[] = {{-.2f, -1.2f, .2f, -5, -3.6f, {.9f, .3f, .1f}}, {.3f, -.4f, 1, -5.2f, -3.4f, {.1f, .5f, .9f}}};
const glm::vec3 kSun(.45f, -1, -.25f);
constexpr float kFloor = -1.5f;
const char* const kRay = R"(
uniform vec2 focal;
vec3 rayHere(vec2 size) { return vec3((gl_FragCoord.xy / size * 2.0 - 1.0) / focal, -1.0); }
)";

TEST(BridgeShadow, AFloorUnderColouredPanesIsLitThroughThem) {
  GlContext context;
  constexpr int wide = 256, high = 192, size = 512;
  Host host(wide, high);
  pld_create_info create = host.info();
  create.features = PLD_FEATURE_COLOURED;
  create.rows = PLD_ROWS_UP;
  pld_pass* pass = host.create(create);
  ASSERT_NE(pass, nullptr);
  const pld_shadow_info info = shadowInfo(PLD_SHADOW_VARIANCE, size, 1, 1, true);
  ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
  GLuint array = 0, frame = 0;
  glCreateVertexArrays(1, &array);
  glCreateFramebuffers(1, &frame);
  glBindVertexArray(array);
  const std::string version = "#version 330 core\n";

  // The casters, by a plain vertex stage.
  const char *caster = nullptr, *lookup = nullptr, *layers = nullptr;
  ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 330, &caster), PLD_OK);
  const GLuint casters = makeProgram(version + R"(
uniform mat4 lightFromScene, projection;
uniform vec3 low, high;
out vec3 position;
void main() {
  vec3 corner = vec3((gl_VertexID & 1) != 0 ? high.x : low.x, low.y, (gl_VertexID & 2) != 0 ? high.z : low.z);
  position = vec3(lightFromScene * vec4(corner, 1.0));
  gl_Position = projection * vec4(position, 1.0);
}
)",
                                     version + caster + R"(
uniform mat4 lightFromScene;
uniform vec3 colour;
uniform uint instance;
in vec3 position;
void main() {
  PldCaster caster;
  caster.coverage = 1.0;
  caster.transmission = colour;
  caster.position = position;
  caster.normal = mat3(lightFromScene) * vec3(0.0, 1.0, 0.0);
  caster.eta = 1.0;
  caster.identity = pldCasterIdentity(instance, uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)");
  ASSERT_NE(casters, 0u);
  ASSERT_EQ(pld_connect(pass, casters), PLD_OK);
  pld_shadow_view view = plainShadowView();
  const glm::vec3 middle(0, 0, -4.4f);
  const glm::mat4 lightFromScene = glm::lookAt(middle - 4.0f * glm::normalize(kSun), middle, glm::vec3(0, 0, -1)),
                  projection = glm::ortho(-2.0f, 2.0f, -2.0f, 2.0f, 0.0f, 10.0f);
  std::memcpy(view.light_from_scene, &lightFromScene[0][0], sizeof(lightFromScene));
  std::memcpy(view.projection, &projection[0][0], sizeof(projection));
  view.near_depth = 2;
  view.far_depth = 6;
  ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
  glUseProgram(casters);
  glUniformMatrix4fv(glGetUniformLocation(casters, "lightFromScene"), 1, GL_FALSE, &lightFromScene[0][0]);
  glUniformMatrix4fv(glGetUniformLocation(casters, "projection"), 1, GL_FALSE, &projection[0][0]);
  for (GLuint i = 0; i < 2; ++i) {
    const Pane& pane = kPanes[i];
    glUniform3f(glGetUniformLocation(casters, "low"), pane.left, pane.y, pane.back);
    glUniform3f(glGetUniformLocation(casters, "high"), pane.right, pane.y, pane.front);
    glUniform3fv(glGetUniformLocation(casters, "colour"), 1, &pane.colour.x);
    glUniform1ui(glGetUniformLocation(casters, "instance"), i);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  ASSERT_EQ(pld_shadow_end(pass), PLD_OK);

  // The host's light pass: a floor.
  uint64_t maps = 0, table = 0;
  ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &maps), PLD_OK);
  ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_BUFFER, &table), PLD_OK);
  glBindTextureUnit(info.texture_unit, static_cast<GLuint>(maps));
  glBindBufferBase(GL_UNIFORM_BUFFER, info.uniform_binding, static_cast<GLuint>(table));
  const pld_frame drawn = host.frame();
  const auto use = [&](GLuint program) {
    ASSERT_NE(program, 0u);
    ASSERT_EQ(pld_connect(pass, program), PLD_OK);
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "focal"), drawn.projection[0], drawn.projection[5]);
  };
  const char* const kSize = "const vec2 size = vec2(256.0, 192.0);\n";
  ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, 330, &lookup), PLD_OK);
  const GLuint floorProgram = makeProgram(kFullscreenVertex, version + lookup + kRay + kSize + R"(
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
void main() {
  vec3 ray = rayHere(size);
  float t = -1.5 / ray.y;
  depth = ray.y < 0.0 ? t : 100.0;
  colour = vec4(ray.y < 0.0 && t < 20.0 ? 0.8 * pldShadowOnOpaque(0, ray * t) : vec3(0.25, 0.3, 0.35), 1.0);
}
)");
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, host.colour, 0);
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT1, host.depth, 0);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(frame, 2, both);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  glViewport(0, 0, wide, high);
  use(floorProgram);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  // The panes themselves; a part of what they show is lit through each other.
  ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 330, &layers), PLD_OK);
  const GLuint paneProgram = makeProgram(kFullscreenVertex, version + layers + lookup + kRay + kSize + R"(
uniform float y;
uniform vec4 box;
uniform vec3 paneColour;
void main() {
  vec3 ray = rayHere(size), p = ray * (y / ray.y);
  if (p.z >= 0.0 || p.x < box.x || p.x > box.y || p.z < box.z || p.z > box.w) discard;
  pldWriteFragment(pldSurface(0.15 * pldShadow(0, p), 1.0, paneColour, p));
}
)");
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &drawn), PLD_OK) << pld_message(pass);
  use(paneProgram);
  for (const Pane& pane : kPanes) {
    glUniform1f(glGetUniformLocation(paneProgram, "y"), pane.y);
    glUniform4f(glGetUniformLocation(paneProgram, "box"), pane.left, pane.right, pane.back, pane.front);
    glUniform3fv(glGetUniformLocation(paneProgram, "paneColour"), 1, &pane.colour.x);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  ASSERT_EQ(pld_end(pass), PLD_OK);
  const pld_target target = host.target();
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);

  // On the floor: the panes' colours, multiplied where both stand in the way; beside an edge of a shadow not looked at.
  const std::vector<float> lit = readTexture(host.colour, wide, high, GL_RGBA), picture = host.picture();
  const float texel = 4.0f / size, soft = 16 * texel;
  double worst = 0;
  int counts[4] = {};
  for (int i = 0; i < wide * high; ++i) {
    const glm::vec2 at((static_cast<float>(i % wide) + .5f) / wide * 2 - 1,
                       (static_cast<float>(i / wide) + .5f) / high * 2 - 1);
    const glm::vec3 ray(at.x / drawn.projection[0], at.y / drawn.projection[5], -1);
    const float t = kFloor / ray.y;
    if (!(ray.y < 0) || t >= 20) continue;
    glm::vec3 expected(1);
    int which = 0;
    bool atEdge = false;
    for (int k = 0; k < 2; ++k) {
      const Pane& pane = kPanes[k];
      const glm::vec3 p = ray * t - kSun * (pane.y - kFloor) / -kSun.y;
      const float inside =
          std::min(std::min(p.x - pane.left, pane.right - p.x), std::min(p.z - pane.back, pane.front - p.z));
      atEdge = atEdge || std::abs(inside) < soft;
      if (inside > 0) expected *= pane.colour, which |= 1 << k;
    }
    if (atEdge) continue;
    ++counts[which];
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(lit[static_cast<std::size_t>(4 * i + c)]) -
                                       .8 * static_cast<double>(expected[c])));
  }
  std::printf("floor: %d pixels lit freely, %d and %d through one pane, %d through both, off by at most %.2g\n",
              counts[0], counts[1], counts[2], counts[3], worst);
  for (const int count : counts) EXPECT_GT(count, 50);
  EXPECT_LT(worst, 4e-4);  // optical depth in steps of 1/4096

  std::ofstream file(freshFolder("bridge-shadow") + "/panes.ppm", std::ios::binary);
  file << "P6\n" << wide << " " << high << "\n255\n";
  for (int y = high - 1; y >= 0; --y)
    for (int x = 0; x < wide; ++x)
      for (int c = 0; c < 3; ++c)
        file.put(static_cast<char>(std::lround(
            255 * std::pow(std::min(1.0f, picture[static_cast<std::size_t>(4 * (y * wide + x) + c)]), 1 / 2.2f))));
  const GLuint programs[] = {casters, floorProgram, paneProgram};
  for (const GLuint program : programs) glDeleteProgram(program);
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
