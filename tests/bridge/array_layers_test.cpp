// Frames in layers of array textures, as stereo has them: by views of GL_TEXTURE_2D, and by framebuffers.
#include <gtest/gtest.h>

#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 40, kHeight = 24;
constexpr GLuint kLayers = 3;
constexpr float kUntouched = -7.0f;

// Glass that bends and spreads what is behind it.
const char* const kMain =
    "void main() {\n"
    "  vec2 p = gl_FragCoord.xy;\n"
    "  if (mod(p.x, 9.0) < 2.0) discard;\n"
    "  PldSurface s = pldSurface(vec3(0.1, 0.05, 0.2), 0.7, vec3(0.6, 0.3, 0.8), vec3(0.02 * p, -1.5));\n"
    "  s.normal = normalize(vec3(0.2 * sin(p.x), 0.1, 1.0));\n"
    "  s.eta = 1.0 / 1.4;\n"
    "  s.collimation = 0.7;\n"
    "  pldWriteFragment(s);\n"
    "}\n";

// An array with each of its layers as a 2D texture.
struct Array {
  explicit Array(GLenum format) {
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &texture);
    glTextureStorage3D(texture, 1, format, kWidth, kHeight, kLayers);
    glGenTextures(kLayers, views);
    for (GLuint i = 0; i < kLayers; ++i) glTextureView(views[i], GL_TEXTURE_2D, texture, format, 0, 1, i, 1);
  }
  ~Array() {
    glDeleteTextures(kLayers, views);
    glDeleteTextures(1, &texture);
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;

  GLuint texture = 0, views[kLayers] = {};
};

void draw(pld_pass* pass, const pld_frame& frame, const pld_target& target) {
  drawOverAll(pass, PLD_STAGE_LAYERS, frame, kMain);
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
}

TEST(BridgeArrayLayers, AFrameInALayerHasTheBitsOfOneInATexture) {
  GlContext context;
  Host host(kWidth, kHeight);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  Array colour(GL_RGBA32F), depth(GL_R32F), output(GL_RGBA32F);
  GLuint framebuffer = 0;
  glCreateFramebuffers(1, &framebuffer);
  for (GLuint eye = 0; eye < kLayers; ++eye) {
    std::vector<float> lit, far;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      for (int c = 0; c < 4; ++c)
        lit.push_back(c == 3 ? 1.0f : 0.01f * static_cast<float>((7 * i + 11 * c) % 31 + 9 * eye));
      far.push_back(3.0f + static_cast<float>(eye) + 0.01f * static_cast<float>(i % kWidth));
    }
    for (const GLuint one : {host.colour, colour.views[eye]}) fillTexture(one, kWidth, kHeight, GL_RGBA, lit.data());
    for (const GLuint one : {host.depth, depth.views[eye]}) fillTexture(one, kWidth, kHeight, GL_RED, far.data());
    draw(pass, host.frame(), host.target());
    const std::vector<float> expected = host.picture();
    EXPECT_NE(expected, lit);
    pld_frame frame = host.frame();
    frame.colour_texture = colour.views[eye];
    frame.depth_texture = depth.views[eye];
    glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT0, output.texture, 0, static_cast<GLint>(eye));
    for (const bool byView : {true, false}) {
      const std::vector<float> before(std::size_t{4} * kWidth * kHeight, kUntouched);
      for (const GLuint one : output.views) fillTexture(one, kWidth, kHeight, GL_RGBA, before.data());
      draw(pass, frame,
           byView ? pld_target_init(PLD_TARGET_TEXTURE, output.views[eye])
                  : pld_target_init(PLD_TARGET_FRAMEBUFFER, framebuffer));
      for (GLuint i = 0; i < kLayers; ++i)
        EXPECT_EQ(readTexture(output.views[i], kWidth, kHeight, GL_RGBA), i == eye ? expected : before)
            << "layer " << i << " of eye " << eye;
    }
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  glDeleteFramebuffers(1, &framebuffer);
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
