// The lookup of shadow maps on GL against the CPU: the same text, the same numbers.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/gl/shadow_textures.h"
#include "shaders/shader_source.h"
#include "tests/shadow/scenes.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;

// What GL looks up at points of one light.
std::vector<glm::vec4> lookedUp(const gl::ShadowTextures& maps, int light, const std::vector<glm::vec4>& points) {
  std::string source = shaderSource("gl/shadow_maps.glsl", {});
  source += R"(
layout(local_size_x = 64) in;
layout(std430, binding = 1) buffer Points { vec4 points[]; };
uniform int lightIndex;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < uint(points.length())) points[i] = vec4(shadowVisibility(lightIndex, points[i].xyz), 1.0f);
})";
  const char* text = source.c_str();
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  char log[4096] = "";
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  EXPECT_EQ(ok, GL_TRUE) << log;
  const gl::Buffer buffer = gl::Buffer::make();
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(points.size() * sizeof(glm::vec4)), points.data(),
                    GL_STATIC_DRAW);
  maps.bind();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffer.name());
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "lightIndex"), light);
  glDispatchCompute(static_cast<GLuint>((points.size() + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<glm::vec4> result(points.size());
  glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(points.size() * sizeof(glm::vec4)), result.data());
  glDeleteProgram(program);
  gl::checkGl("looking shadow maps up");
  return result;
}

TEST(ShadowLookup, GlAgreesWithTheCpu) {
  Camera camera;
  camera.viewFromWorld[3] = {0, -1, -4, 1};
  Scene scene;
  add(scene, sphere({0, 1, 0}, .5f), glass({.9f, .5f, .1f}, 1.3f, true));
  add(scene, quad(2, 1), glass(glm::vec3(.7f)));
  Material paint = glass(glm::vec3(.5f));
  paint.transmission = 0.0f;
  add(scene, quad(.2f, .4f), paint);
  Light dark = sun({0, -1, 0}), lamp = sun({0, -1, 0});
  dark.intensity = 0.0f;
  lamp.kind = LightKind::point;
  lamp.position = {.3, 3, .2};
  scene.lights = {dark, sun({.2, -1, .1}), lamp};
  GlContext context;
  Random random(1);
  std::vector<glm::vec4> points;
  for (int i = 0; i < 4000; ++i)
    points.push_back(glm::vec4(
        glm::vec3(camera.viewFromWorld *
                  glm::dvec4(random.between(-1.5, 1.5), random.between(-.5, 2.5), random.between(-1.5, 1.5), 1.0)),
        0.0f));
  for (const auto form : {ShadowMapSettings::Form::variance, ShadowMapSettings::Form::corrected}) {
    ShadowMapSettings settings;
    settings.form = form;
    settings.size = 512;
    settings.opaqueSize = 256;
    const ShadowMaps maps = renderShadowMaps(context, scene, camera, nullptr, settings);
    EXPECT_EQ(maps.lights[0].faces, glm::ivec4(0));
    const gl::ShadowTextures textures(maps, scene.lights);
    for (const std::size_t light : {1u, 2u}) {
      const std::vector<glm::vec4> found = lookedUp(textures, static_cast<int>(light) - 1, points);
      double worst = 0;
      int apart = 0, shadowed = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 v = maps.visibility(light, glm::vec3(points[i]));
        shadowed += v != glm::vec3(1.0f) ? 1 : 0;
        const double difference = static_cast<double>(glm::length(glm::vec3(found[i]) - v));
        apart += difference > 1e-4 ? 1 : 0;
        if (difference <= 1e-4) worst = std::max(worst, difference);
      }
      std::printf("light %zu: %d of 4000 points shadowed, %d further apart than 1e-4, the others at most %.2g\n", light,
                  shadowed, apart, worst);
      EXPECT_GT(shadowed, 400);
      // Where a point falls between two texels, stands at an opaque depth to the last bit, or within the thinnest of
      // slabs, rounding of the projection decides.
      EXPECT_LE(apart, 12);
    }
  }
}

}  // namespace
}  // namespace pellucid
