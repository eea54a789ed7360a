#include "engine_bridge/gl/targets.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "gbuffer/camera.h"

namespace pellucid::gl {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
void requireComplete(const Framebuffer& framebuffer) {
  if (glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error("a framebuffer of the transparent pass is incomplete");
}

void readInto(const Texture& texture, GLenum format, const Window& part, void* first, int rowLength) {
  const std::size_t texel = (format == GL_RGBA ? 4 : format == GL_RG ? 2 : 1) * sizeof(float);
  const std::size_t bytes = (static_cast<std::size_t>(part.height() - 1) * static_cast<std::size_t>(rowLength) +
                             static_cast<std::size_t>(part.width())) *
                            texel;
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max();
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, rowLength);
  glGetTextureSubImage(texture.name(), 0, part.x0, part.y0, 0, part.width(), part.height(), 1, format, GL_FLOAT,
                       static_cast<GLsizei>(std::min(bytes, most)), first);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

}  // namespace

Texture Targets::add(GLenum format) const {
  Texture texture = Texture::make();
  glTextureStorage2D(texture.name(), 1, format, width_, height_);
  return texture;
}

// What clearing obeys.
void Targets::scissorPart() const {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part_.x0, part_.y0, part_.width(), part_.height());
}

void Targets::beginCount() {
  if (!count_) {
    count_ = add(GL_R32F);
    countFrame_ = Framebuffer::make();
    glNamedFramebufferTexture(countFrame_.name(), GL_COLOR_ATTACHMENT0, count_.name(), 0);
    checkGl("making the fragment count");
    requireComplete(countFrame_);
  }
  scissorPart();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, countFrame_.name());
  const float zero[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(countFrame_.name(), GL_COLOR, 0, zero);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquation(GL_FUNC_ADD);
}

void Targets::beginSolidDepth() {
  if (!solidFrame_) {
    solid_ = add(GL_RGBA32F);
    solidDepth_ = add(GL_DEPTH_COMPONENT32F);
    solidFrame_ = Framebuffer::make();
    glNamedFramebufferTexture(solidFrame_.name(), GL_COLOR_ATTACHMENT0, solid_.name(), 0);
    glNamedFramebufferTexture(solidFrame_.name(), GL_DEPTH_ATTACHMENT, solidDepth_.name(), 0);
    checkGl("making the targets of the solid pass");
    requireComplete(solidFrame_);
  }
  const float none[4] = {0, 0, 0, kInfinity};
  scissorPart();
  glClearNamedFramebufferfv(solidFrame_.name(), GL_COLOR, 0, none);
  const float infinitelyFar = 0;  // reversed depth
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(solidFrame_.name(), GL_DEPTH, 0, &infinitelyFar);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, solidFrame_.name());
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
}

void Targets::beginSolidTies() {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquationSeparate(GL_MAX, GL_MIN);
}

void Targets::beginNothing() {
  if (!emptyFrame_) {
    emptyFrame_ = Framebuffer::make();
    glNamedFramebufferParameteri(emptyFrame_.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, width_);
    glNamedFramebufferParameteri(emptyFrame_.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, height_);
    glNamedFramebufferDrawBuffer(emptyFrame_.name(), GL_NONE);
    requireComplete(emptyFrame_);
  }
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, emptyFrame_.name());
  glDisable(GL_BLEND);
}

void Targets::bindSolid() const {
  glBindTextureUnit(6, solid_.name());
}

void Targets::readSolid(Image<glm::vec4>& solid, int x, int y) const {
  readInto(solid_, GL_RGBA, part_, &solid.at(x, y), solid.width());
  checkGl("reading the solid plane back");
}

void Targets::readSolidDepth(Image<float>& z, int x, int y) const {
  readInto(solidDepth_, GL_DEPTH_COMPONENT, {0, 0, width_, height_}, &z.at(x, y), z.width());
  checkGl("reading the depth of solids back");
  for (int row = y; row < y + height_; ++row)
    for (int column = x; column < x + width_; ++column) {
      float& depth = z.at(column, row);
      depth = depth > 0.0f ? static_cast<float>(kClipNear) / depth : kInfinity;
    }
}

Image<float> Targets::readCount() const {
  Image<float> count(width_, height_);
  readInto(count_, GL_RED, part_, &count.at(part_.x0, part_.y0), width_);
  checkGl("reading the fragment count back");
  return count;
}

namespace {

void putTexels(const Texture& texture, const float* texels, GLenum format, int width, int height, int rowLength) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, rowLength);
  glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, format, GL_FLOAT, texels);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  checkGl("uploading a plane of the opaque picture");
}

Texture uploadTexels(const float* texels, GLenum stored, GLenum format, int width, int height, int rowLength) {
  Texture texture = Texture::make();
  glTextureStorage2D(texture.name(), 1, stored, width, height);
  putTexels(texture, texels, format, width, height, rowLength);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

}  // namespace

Texture uploadPlane(const Image<float>& plane, const Window& part) {
  return uploadTexels(&plane.at(part.x0, part.y0), GL_R32F, GL_RED, part.width(), part.height(), plane.width());
}

void updatePlane(const Texture& texture, const Image<float>& plane, const Window& part) {
  putTexels(texture, &plane.at(part.x0, part.y0), GL_RED, part.width(), part.height(), plane.width());
}

Texture uploadPlanes(const Image<float>& red, const Image<float>& green, const Window& part) {
  Image<glm::vec2> both(part.width(), part.height());
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x)
      both.at(x, y) = {red.at(part.x0 + x, part.y0 + y), green.at(part.x0 + x, part.y0 + y)};
  return uploadTexels(&both.at(0, 0).x, GL_RG32F, GL_RG, part.width(), part.height(), part.width());
}

}  // namespace pellucid::gl
