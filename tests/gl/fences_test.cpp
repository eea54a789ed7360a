// What the device has come past is let go of, and what it may still hold is not.
#include "engine_bridge/gl/fences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::test {
namespace {

// Work for the device that ends nowhere but in a fence.
void clearSomething(const gl::Framebuffer& frame, const gl::Texture& texture) {
  if (glCheckNamedFramebufferStatus(frame.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    glTextureStorage2D(texture.name(), 1, GL_RGBA32F, 256, 256);
    glNamedFramebufferTexture(frame.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  }
  const float black[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(frame.name(), GL_COLOR, 0, black);
}

TEST(Fences, TheLastIsKeptUntilALaterOneHasPassed) {
  GlContext context;
  const gl::Framebuffer frame = gl::Framebuffer::make();
  const gl::Texture texture = gl::Texture::make();
  gl::Fences& fences = gl::fences();
  clearSomething(frame, texture);
  const gl::Fences::Mark first = fences.mark();
  fences.wait(first);
  EXPECT_EQ(fences.held(), 1u);  // passed, and nothing after it
  clearSomething(frame, texture);
  const gl::Fences::Mark second = fences.mark();
  EXPECT_EQ(second, first + 1);
  fences.wait(second);
  EXPECT_EQ(fences.held(), 1u);
  fences.wait(first);  // let go of long ago
  fences.wait(0);
  EXPECT_EQ(fences.held(), 1u);
  gl::checkGl("waiting for fences");
}

// A stream whose chunks all stay on the device never waits.
TEST(Fences, WithoutWaitingTheyDoNotPileUp) {
  GlContext context;
  const gl::Framebuffer frame = gl::Framebuffer::make();
  const gl::Texture texture = gl::Texture::make();
  std::size_t most = 0;
  for (int i = 0; i < 1000; ++i) {
    clearSomething(frame, texture);
    gl::fences().mark();
    if (i % 100 == 99) glFinish();
    most = std::max(most, gl::fences().held());
  }
  glFinish();
  gl::fences().mark();
  std::printf("most fences held at once: %zu\n", most);
  EXPECT_LE(most, 101u);
  EXPECT_EQ(gl::fences().held(), 1u);
  gl::checkGl("marking");
}

TEST(Fences, BelongToTheirContext) {
  EXPECT_THROW(gl::fences(), std::logic_error);
  std::optional<GlContext> outer(std::in_place);
  const gl::Fences* const ofOuter = &gl::fences();
  gl::fences().mark();
  {
    GlContext inner;
    EXPECT_NE(&gl::fences(), ofOuter);
    gl::fences().mark();
    outer.reset();  // while another is current
    EXPECT_EQ(gl::fences().held(), 1u);
    gl::checkGl("marking");
  }
  EXPECT_THROW(gl::fences(), std::logic_error);
}

}  // namespace
}  // namespace pellucid::test
