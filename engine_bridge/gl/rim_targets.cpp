#include "engine_bridge/gl/rim_targets.h"

#include <algorithm>

namespace pellucid::gl {
namespace {

template <class T>
void readInto(const Texture& texture, GLenum format, int width, int height, Image<T>& plane, int x, int y) {
  Image<T> texels(width, height);
  glGetTextureImage(texture.name(), 0, format, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(T)),
                    texels.data());
  checkGl("reading the planes of rims back");
  for (int row = 0; row < height; ++row) std::copy(texels.row(row), texels.row(row) + width, &plane.at(x, y + row));
}

}  // namespace

RimTargets::RimTargets(int width, int height)
    : width_(width),
      height_(height),
      averaged_(Texture::make()),
      added_(Texture::make()),
      gradient_(Texture::make()),
      frame_(Framebuffer::make()) {
  glTextureStorage2D(averaged_.name(), 1, GL_RGBA32F, width, height);
  glTextureStorage2D(added_.name(), 1, GL_RGBA32F, width, height);
  glTextureStorage2D(gradient_.name(), 1, GL_RG32F, width, height);
  const GLuint names[] = {averaged_.name(), added_.name(), gradient_.name()};
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  for (GLuint i = 0; i < 3; ++i) glNamedFramebufferTexture(frame_.name(), attachments[i], names[i], 0);
  glNamedFramebufferDrawBuffers(frame_.name(), 3, attachments);
  checkGl("making the targets of rims");
}

void RimTargets::begin() {
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_.name());
  const float zero[4] = {0, 0, 0, 0};
  for (GLint i = 0; i < 3; ++i) glClearNamedFramebufferfv(frame_.name(), GL_COLOR, i, zero);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  checkGl("beginning the pass of rims");
}

void RimTargets::read(RimPlanes& planes, int x, int y) const {
  readInto(averaged_, GL_RGBA, width_, height_, planes.averaged, x, y);
  readInto(added_, GL_RGBA, width_, height_, planes.added, x, y);
  readInto(gradient_, GL_RG, width_, height_, planes.gradient, x, y);
}

}  // namespace pellucid::gl
