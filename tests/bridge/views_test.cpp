// Debug views of rims, of layers at low resolution and of shadow maps, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 48, kHeight = 32;

// How far three channels are from what is expected, at most, over all pixels; alpha is 1.
template <class F>
double worstOf(const std::vector<float>& picture, int width, F expected) {
  double worst = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto pixel = static_cast<int>(i / 4);
    const double value = i % 4 == 3 ? 1.0 : expected(pixel % width, pixel / width, static_cast<int>(i % 4));
    worst = std::max(worst, std::abs(value - static_cast<double>(picture[i])));
  }
  return worst;
}

// A leaf of coverage 1/2 before a wall at its depth whose occlusion leaves half (in 8 bits): the rim's is the same.
TEST(BridgeViews, RimsShowTheirOcclusionAndWhatItTakes) {
  GlContext context;
  for (const uint32_t extra :
       {0u, uint32_t{PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION}}) {
    Host host(kWidth, kHeight);
    pld_create_info info = host.info();
    info.features = PLD_FEATURE_RIMS | extra;
    info.flags = PLD_FLAG_DEBUG_VIEWS;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    const pld_frame frame = host.frame();
    // On the left a rim, from x = 32 on a layer that is none.
    const std::string main =
        "void main() {\n"
        "  float z = -10.0;\n"
        "  vec3 around = vec3(0.1, 0.15, 0.2);\n"
        "  if (gl_FragCoord.x < 32.0) pldWriteRim(pldSurface(vec3(0.2), 0.5, vec3(0.0), vec3(0.0, 0.0, z)), around, "
        "vec2(0.0));\n"
        "  else pldWriteFragment(pldSurface(vec3(0.2), 0.5, vec3(0.0), vec3(0.0, 0.0, z)));\n"
        "}\n";
    for (const pld_stage stage : {PLD_STAGE_LAYERS, PLD_STAGE_RIMS}) drawOverAll(pass, stage, frame, main);
    constexpr double open = 128.0 / 255.0;
    const double around[3] = {.1, .15, .2}, background[3] = {.5, .4, .3};
    const double occlusion = worstOf(seen(host, pass, PLD_VIEW_RIM_OCCLUSION), kWidth, [&](int x, int, int c) {
      return x >= 32 || c == 2 ? 0.0 : c == 0 ? 1 - open : open;
    });
    const double loss = worstOf(seen(host, pass, PLD_VIEW_RIM_LOSS), kWidth,
                                [&](int x, int, int c) { return x >= 32 ? 0.0 : (1 - open) * around[c]; });
    // And the picture has lost just that.
    const double picture = worstOf(seen(host, pass, PLD_VIEW_PICTURE), kWidth, [&](int x, int, int c) {
      return .2 + .5 * background[c] - (x >= 32 ? 0.0 : (1 - open) * around[c]);
    });
    std::printf("views of rims: occlusion off by %.2g, loss by %.2g, the picture without it by %.2g\n", occlusion, loss,
                picture);
    EXPECT_LT(occlusion, 1e-6);
    EXPECT_LT(loss, 1e-6);
    EXPECT_LT(picture, 1e-6);
    pld_destroy(&pass);
  }
}

// Two veils, 2 m and 3 m away, on the left third of the texels, before a wall at 10 m.
TEST(BridgeViews, LowLayersAreShownTexelByTexel) {
  GlContext context;
  for (const pld_tier tier : {PLD_TIER_FLOAT, PLD_TIER_HALF})
    for (const int factor : {2, 8}) {
      Host host(kWidth, kHeight);
      pld_create_info info = host.info();
      info.features = PLD_FEATURE_LOW_RESOLUTION | PLD_FEATURE_COLOURED;
      info.flags = PLD_FLAG_DEBUG_VIEWS;
      info.tier = tier;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      pld_frame frame = host.frame();
      frame.low_factor = factor;
      const int edge = kWidth / 3 / factor;  // texels
      drawOverAll(
          pass, PLD_STAGE_LAYERS, frame,
          "void main() { discard; pldWriteFragment(pldSurface(vec3(0.0), 0.5, vec3(0.0), vec3(0.0, 0.0, -3.0))); }\n");
      const std::string main = "void main() {\n  if (gl_FragCoord.x > " + std::to_string(edge) +
                               ".0) discard;\n  pldWriteFragment(pldSurface(vec3(0.2, 0.1, 0.05), 0.5, vec3(0.5, 0.25, "
                               "0.75), vec3(0.0, 0.0, -2.0)));\n}\n";
      drawOverAll(pass, PLD_STAGE_LOW, frame, main);
      const double o[3] = {.25, .375, .125}, light[3] = {.2, .1, .05};
      const bool half = tier == PLD_TIER_HALF;
      const auto inside = [&](int x) { return x / factor < edge; };
      const double colour = worstOf(seen(host, pass, PLD_VIEW_LOW_COLOUR), kWidth,
                                    [&](int x, int, int c) { return inside(x) ? light[c] : 0.0; });
      const double left = worstOf(seen(host, pass, PLD_VIEW_LOW_TRANSMISSION), kWidth,
                                  [&](int x, int, int c) { return inside(x) ? 1 - o[c] : 1.0; });
      const double depth = worstOf(seen(host, pass, PLD_VIEW_LOW_DEPTH), kWidth, [&](int x, int, int c) {
        return !inside(x) ? 0.0 : c == 2 ? 10.0 / 11.0 : 2.0 / 3.0;
      });
      std::printf("views of low resolution, 1/%d, %s: colour off by %.2g, transmission by %.2g, depths by %.2g\n",
                  factor, half ? "half" : "float", colour, left, depth);
      // Half floats round every sum to 2^-11.
      const double most = half ? std::ldexp(1.0, -10) : 1e-6;
      EXPECT_LT(colour, most);
      EXPECT_LT(left, most);
      EXPECT_LT(depth, most);
      // The picture has it upsampled: a ramp from texel to texel, where these have a step.
      const std::vector<float> picture = seen(host, pass, PLD_VIEW_PICTURE);
      const auto at = [&](int x) { return picture[static_cast<std::size_t>(4 * (16 * kWidth + x))]; };
      EXPECT_NEAR(at(2), .2f + .75f * .5f, 2e-3f);
      EXPECT_GT(std::abs(at(edge * factor - 1) - at(2)), 1e-3f);
      pld_destroy(&pass);
    }
}

// A caster 2 m away that hides half of 3/4, 1/2 and 1/4, on the left half of the map.
TEST(BridgeViews, FacesOfShadowMapsAreShownTexelByTexel) {
  GlContext context;
  const std::string half =
      std::string(kPlainCaster)
          .insert(std::string(kPlainCaster).find('{') + 1, "\n  if (gl_FragCoord.x > 32.0) discard;\n");
  for (const pld_shadow_form form : {PLD_SHADOW_VARIANCE, PLD_SHADOW_NAIVE, PLD_SHADOW_CORRECTED})
    for (const bool coloured : {true, false})
      for (const bool local : {false, true}) {
        Host host(64, 64);
        pld_create_info create = host.info();
        create.flags = PLD_FLAG_DEBUG_VIEWS;
        pld_pass* pass = host.create(create);
        ASSERT_NE(pass, nullptr);
        const pld_shadow_info info = shadowInfo(form, 64, 1, 2, coloured);
        ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
        const int edge = form == PLD_SHADOW_VARIANCE ? 16 : 64, channels = coloured ? 3 : 1;
        pld_shadow_view view = plainShadowView();
        view.first_face = 1;
        if (local) {
          view.kind = PLD_LIGHT_LOCAL;
          const float spot[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, -1, 0, 0, -.2f, 0};
          std::copy(spot, spot + 16, view.projection);
          view.far_depth = 4;
        }
        const char* seam = nullptr;
        ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 330, &seam), PLD_OK) << pld_message(pass);
        const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 330 core\n") + seam + half);
        ASSERT_EQ(pld_connect(pass, program), PLD_OK);
        GLuint array = 0;
        glCreateVertexArrays(1, &array);
        ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
        glUseProgram(program);
        glBindVertexArray(array);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        ASSERT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
        pld_target target = host.target();
        target.shadow_face = 1;
        const auto shown = [&](pld_view what) {
          target.view = what;
          EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
          return host.picture();
        };
        const std::vector<float> transmission = shown(PLD_VIEW_SHADOW_TRANSMISSION),
                                 coins = shown(PLD_VIEW_SHADOW_COINS), depth = shown(PLD_VIEW_SHADOW_DEPTH),
                                 texels = shadowTexels(pass, edge, 2 * channels);
        // Every texel of the face is what the map holds, and nothing beyond its edge is touched.
        std::size_t wrong = 0;
        double closed = 0, sum[3] = {}, hollow = 0;
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x)
            for (int c = 0; c < 3; ++c) {
              const auto pixel = static_cast<std::size_t>(4 * (y * 64 + x) + c);
              const float* texel =
                  &texels[static_cast<std::size_t>(4 * ((((coloured ? c : 0) + channels) * edge + y) * edge + x))];
              const float mean = texel[1] > 0 ? texel[2] / texel[1] : 0.0f;
              wrong += transmission[pixel] != 1.0f - texel[0];
              wrong += coins[pixel] != texel[1];
              wrong += !(texel[1] > 0) ? depth[pixel] != 0.0f
                                       : std::abs(depth[pixel] - (local ? mean : .5f + .5f * mean)) > 1e-6f;
              // The tent reaches two texels across the edge.
              const bool inside = x < edge / 2 - 2, outside = x >= edge / 2 + 2;
              const double rho = .5 * (.75 - .25 * (coloured ? c : 0));
              if (inside && x > 1 && y > 1 && y < edge - 2) {  // nor out of the map
                closed = std::max(closed, std::abs(static_cast<double>(transmission[pixel]) - (1 - rho)));
                if (texel[1] > 0) closed = std::max(closed, std::abs(static_cast<double>(depth[pixel]) - .5));
                sum[c] += static_cast<double>(coins[pixel]);
              }
              if (outside)
                hollow = std::max(
                    {hollow, 1.0 - static_cast<double>(transmission[pixel]), static_cast<double>(depth[pixel])});
            }
        const double count = (edge / 2 - 4) * (edge - 4);
        double share = 0;
        for (int c = 0; c < 3; ++c)
          share = std::max(share, std::abs(sum[c] / count - .5 * (.75 - .25 * (coloured ? c : 0))));
        std::printf(
            "views of shadow maps, form %d%s%s: transmission and depth off by %.2g at most, coins by %.2g on the "
            "average\n",
            static_cast<int>(form), coloured ? ", coloured" : "", local ? ", local" : "", closed, share);
        EXPECT_EQ(wrong, 0u);
        EXPECT_LT(closed, 1e-3);  // a step of optical depth is 1/4096, rounded up or down at random
        EXPECT_EQ(hollow, 0.0);
        // The deviation of so many plain coins is .012; those of the other forms are stratified.
        EXPECT_LT(share, form == PLD_SHADOW_NAIVE ? .05 : .02);
        if (edge < 64) {
          glClearTexImage(host.output, 0, GL_RGBA, GL_FLOAT, nullptr);
          EXPECT_EQ(shown(PLD_VIEW_SHADOW_TRANSMISSION)[4 * (20 * 64 + 20)], 0.0f);
        }
        pld_destroy(&pass);
        glDeleteProgram(program);
        glDeleteVertexArrays(1, &array);
      }
}

// What is not there is refused, and so is what is asked for at the wrong time.
TEST(BridgeViews, WrongViewsAreRefused) {
  GlContext context;
  Host host(32, 32);
  pld_create_info info = host.info();
  info.flags = PLD_FLAG_DEBUG_VIEWS;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  pld_target target = host.target();
  const auto refused = [&](int view, pld_status expected) {
    target.view = static_cast<pld_view>(view);
    EXPECT_STREQ(pld_status_name(pld_resolve(pass, &target)), pld_status_name(expected))
        << view << ": " << pld_message(pass);
    EXPECT_GT(std::string(pld_message(pass)).size(), 10u);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  };
  refused(PLD_VIEW_SHADOW_DEPTH, PLD_ERROR_ORDER);  // no maps
  refused(PLD_VIEW_RIM_LOSS, PLD_ERROR_ORDER);      // no frame
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  refused(PLD_VIEW_SHADOW_DEPTH, PLD_ERROR_ORDER);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  refused(PLD_VIEW_RIM_OCCLUSION, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_RIM_LOSS, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_LOW_COLOUR, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_LOW_DEPTH, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_REACTIVE, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_IDENTITY, PLD_ERROR_UNSUPPORTED);
  refused(PLD_VIEW_IDENTITY + 1, PLD_ERROR_ARGUMENT);
  refused(-1, PLD_ERROR_ARGUMENT);
  const pld_shadow_info room = shadowInfo(PLD_SHADOW_NAIVE, 32, 1, 2, false);
  ASSERT_EQ(pld_shadow_resize(pass, &room), PLD_OK);
  refused(PLD_VIEW_SHADOW_DEPTH, PLD_ERROR_ORDER);  // face 0 has not been drawn
  const pld_shadow_view view = plainShadowView();
  ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK);
  refused(PLD_VIEW_SHADOW_DEPTH, PLD_ERROR_ORDER);
  ASSERT_EQ(pld_shadow_end(pass), PLD_OK);
  for (const int face : {-1, 2}) {
    target.shadow_face = face;
    refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_ARGUMENT);
  }
  target.shadow_face = 1;
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_ORDER);
  target.shadow_face = 0;
  const GLuint small = makeTexture(GL_RGBA16F, 32, 31), byte = makeTexture(GL_R8, 32, 32);
  target.name = small;
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_SIZE);
  target.name = byte;
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_FORMAT);
  uint64_t maps = 0;
  ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &maps), PLD_OK);
  target.name = static_cast<GLuint>(maps);
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_TEXTURE);  // of another kind, and one's own
  GLuint own = 0;
  glCreateFramebuffers(1, &own);
  glNamedFramebufferTextureLayer(own, GL_COLOR_ATTACHMENT0, static_cast<GLuint>(maps), 0, 0);
  target.kind = PLD_TARGET_FRAMEBUFFER;
  target.name = own;
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_TEXTURE);
  // A host of 0.3 has no shadow_face: it sees face 0.
  target = host.target();
  target.view = PLD_VIEW_SHADOW_COINS;
  target.struct_size = offsetof(pld_target, shadow_face);
  target.shadow_face = 0x7ead;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  target.view = PLD_VIEW_PICTURE;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(pld_shadow_resize(pass, nullptr), PLD_OK);
  target = host.target();
  refused(PLD_VIEW_SHADOW_COINS, PLD_ERROR_ORDER);
  pld_destroy(&pass);

  info.flags = 0;
  pass = host.create(info);
  ASSERT_EQ(pld_shadow_resize(pass, &room), PLD_OK);
  refused(PLD_VIEW_SHADOW_DEPTH, PLD_ERROR_UNSUPPORTED);
  pld_destroy(&pass);

  // The occlusion that a view of rims reads is gone.
  info.flags = PLD_FLAG_DEBUG_VIEWS;
  info.features = PLD_FEATURE_RIMS;
  pass = host.create(info);
  for (const pld_stage stage : {PLD_STAGE_LAYERS, PLD_STAGE_RIMS}) {
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    ASSERT_EQ(pld_end(pass), PLD_OK);
  }
  glDeleteTextures(1, &host.occlusion);
  refused(PLD_VIEW_RIM_OCCLUSION, PLD_ERROR_TEXTURE);
  target.view = PLD_VIEW_PICTURE;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
