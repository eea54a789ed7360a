#include "engine_bridge/gl/published_targets.h"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "gbuffer/errors.h"
#include "gbuffer/published.h"

namespace pellucid::gl {
namespace {

template <class T>
std::vector<T> readTexels(const Texture& texture, GLenum format, GLenum type, int width, int height, int components) {
  std::vector<T> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(components));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture.name(), 0, format, type, static_cast<GLsizei>(texels.size() * sizeof(T)), texels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return texels;
}

}  // namespace

PublishedTargets::PublishedTargets(int width, int height)
    : width_(width),
      height_(height),
      radiance_(Texture::make()),
      beta_(Texture::make()),
      delta_(Texture::make()),
      clamped_(Buffer::make()),
      frame_(Framebuffer::make()) {
  glTextureStorage2D(radiance_.name(), 1, GL_RGBA16F, width, height);
  glTextureStorage2D(beta_.name(), 1, GL_RGBA8, width, height);
  glTextureStorage2D(delta_.name(), 1, GL_RG8_SNORM, width, height);
  const GLuint names[] = {radiance_.name(), beta_.name(), delta_.name()};
  for (GLuint i = 0; i < 3; ++i) glNamedFramebufferTexture(frame_.name(), GL_COLOR_ATTACHMENT0 + i, names[i], 0);
  const GLuint none = 0;
  glNamedBufferData(clamped_.name(), sizeof none, &none, GL_DYNAMIC_READ);
  checkGl("making the targets of the published tier");
  if (glCheckNamedFramebufferStatus(frame_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw ResourceError(
        "GL: the device cannot draw to RGBA16F, RGBA8 and RG8_SNORM at once, which --precision published needs");
}

void PublishedTargets::begin(bool scatter) {
  glDisable(GL_SCISSOR_TEST);
  const GLuint frame = frame_.name();
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  glNamedFramebufferDrawBuffers(frame, 3, attachments);
  const float zero[4] = {0, 0, 0, 0}, clear[4] = {1, 1, 1, 0};
  glClearNamedFramebufferfv(frame, GL_COLOR, 0, zero);
  glClearNamedFramebufferfv(frame, GL_COLOR, 1, clear);
  glClearNamedFramebufferfv(frame, GL_COLOR, 2, zero);
  if (!scatter) glNamedFramebufferDrawBuffers(frame, 2, attachments);
  const GLuint none = 0;
  glNamedBufferSubData(clamped_.name(), 0, sizeof none, &none);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, clamped_.name());
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendFuncSeparatei(1, GL_ZERO, GL_ONE_MINUS_SRC_COLOR, GL_ONE, GL_ONE);
  checkGl("beginning the published tier");
}

void PublishedTargets::read(OitPlanes& planes, int x, int y, PublishedClamps& clamps) const {
  const auto radiance = readTexels<float>(radiance_, GL_RGBA, GL_FLOAT, width_, height_, 4);
  const auto beta = readTexels<std::uint8_t>(beta_, GL_RGBA, GL_UNSIGNED_BYTE, width_, height_, 4);
  const auto delta = readTexels<std::int8_t>(delta_, GL_RG, GL_BYTE, width_, height_, 2);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  GLuint written = 0;
  glGetNamedBufferSubData(clamped_.name(), 0, sizeof written, &written);
  checkGl("reading the planes of the published tier back");
  clamps.written += written;
  for (int row = 0; row < height_; ++row)
    for (int column = 0; column < width_; ++column) {
      const auto i =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
      PublishedPixel pixel;
      for (std::size_t c = 0; c < 4; ++c) {
        pixel.radiance[static_cast<int>(c)] = radiance[4 * i + c];
        pixel.beta[c] = beta[4 * i + c];
      }
      for (std::size_t c = 0; c < 2; ++c) pixel.delta[c] = delta[2 * i + c];
      storePublished(pixel, planes, x + column, y + row, clamps);
    }
}

}  // namespace pellucid::gl
