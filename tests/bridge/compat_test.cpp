// Hosts that draw with the compatibility profile, and bind what they draw with before pld_begin(), not after it.
#include <gtest/gtest.h>

#include "tests/bridge/egl_context.h"
#include "tests/bridge/gl_state.h"
#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kAll = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                          PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;

// A triangle of generic attributes in vertex array 0, with a texture on unit 0.
const char* const kVertex = R"(#version 330 compatibility
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 0.5, 1.0); }
)";
const char* const kMain = R"(
uniform sampler2D tint;
void main() { pldWriteFragment(pldSurface(0.1 * texture(tint, vec2(0.5)).rgb, 0.5, vec3(0.5), vec3(0.0, 0.0, -3.0))); }
)";

TEST(BridgeCompatibility, DrawsWithWhatWasBoundBeforeBegin) {
  const EglContext context(false);  // as hosts have it that ask for no profile
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  ASSERT_EQ(profile & GL_CONTEXT_CORE_PROFILE_BIT, 0) << "this device has no compatibility profile";
  Host host(24, 16);
  pld_create_info info = host.info();
  info.features = kAll;
  GLuint tint = makeTexture(GL_RGBA32F, 1, 1), buffer = 0;
  const float green[4] = {0, 1, 0, 1}, corners[6] = {-1, -1, 3, -1, -1, 3};
  fillTexture(tint, 1, 1, GL_RGBA, green);
  glCreateBuffers(1, &buffer);
  glNamedBufferData(buffer, sizeof(corners), corners, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, tint);
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}) {
    const char* seam = nullptr;
    ASSERT_EQ(pld_glsl(pass, stage, 330, &seam), PLD_OK);
    const GLuint program = makeProgram(kVertex, std::string("#version 330 compatibility\n") + seam + kMain);
    ASSERT_NE(program, 0u);
    ASSERT_EQ(pld_connect(pass, program), PLD_OK);
    glUseProgram(program);
    const GlState before = glState();
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    for (const std::string& one : changes(before, glState())) ADD_FAILURE() << "stage " << stage << " leaves " << one;
  }
  pld_target target = host.target();
  const GlState before = glState();
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(changes(before, glState()).size(), 0u);
  // Two layers, one of low resolution, of light .1 green and net coverage .25 over the picture's .5, .4, .3: their mean
  // is .1 / .25.
  const std::vector<float> picture = host.picture();
  constexpr float left = 0.75f * 0.75f;
  EXPECT_NEAR(picture[0], 0.5f * left, 1e-6f);
  EXPECT_NEAR(picture[1], 0.4f * left + 0.4f * (1.0f - left), 1e-6f);
  EXPECT_NEAR(picture[2], 0.3f * left, 1e-6f);
  // And a shadow map.
  const pld_shadow_info room = shadowInfo(PLD_SHADOW_VARIANCE, 64, 1, 1, true);
  ASSERT_EQ(pld_shadow_resize(pass, &room), PLD_OK) << pld_message(pass);
  const char* caster = nullptr;
  ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 330, &caster), PLD_OK);
  const GLuint casters = makeProgram(kVertex, std::string("#version 330 compatibility\n") + caster + kPlainCaster);
  ASSERT_EQ(pld_connect(pass, casters), PLD_OK);
  glUseProgram(casters);
  const pld_shadow_view view = plainShadowView();
  const GlState bound = glState();
  ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  ASSERT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
  EXPECT_EQ(changes(bound, glState()).size(), 0u);
  const std::vector<float> under = askShadows(pass, room, 0, {0, 0, -5, 0}, true);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(under[static_cast<std::size_t>(c)], 1.0f - 0.5f * (0.75f - 0.25f * static_cast<float>(c)), 1e-3f);
  // A texture of another kind is refused here too, where the driver does not say of what kind a texture is.
  pld_frame wrong = frame;
  glCreateTextures(GL_TEXTURE_3D, 1, &wrong.depth_texture);
  while (glGetError() != GL_NO_ERROR) {
  }
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_SOLIDS, &wrong), PLD_ERROR_TEXTURE);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  glDeleteTextures(1, &tint);
}

}  // namespace
}  // namespace pellucid::test
