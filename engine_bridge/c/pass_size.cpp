// Room for the planes of one size: all that a pass allocates on the device.
#include <algorithm>
#include <cmath>

#include "engine_bridge/c/pass.h"
#include "shaders/spread_pyramid.h"

using namespace pellucid::c;

GLuint pld_pass::makeTexture(GLenum format, int width, int height, int bits) {
  const bool depth = format == GL_DEPTH_COMPONENT32F;
  GLuint name = 0;
  gl.GenTextures(1, &name);
  gl.BindTexture(GL_TEXTURE_2D, name);
  // Before the image: drivers make room for levels that they may expect.
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                GL_FLOAT, nullptr);
  bytes_ += static_cast<uint64_t>(bits) / 8 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  return name;
}

void pld_pass::releaseTextures() {
  const auto release = [&](GLuint& name) {
    if (name) gl.DeleteTextures(1, &name);
    name = 0;
  };
  for (Plane& plane : planes_) release(plane.texture);
  for (GLuint* one : {&planarZ_, &frontZ_, &solid_, &solidDepth_}) release(*one);
  for (GLuint& one : spread_) release(one);
  for (GLuint& one : rims_) release(one);
  for (Plane& plane : low_) release(plane.texture);
  for (GLuint& one : lowTexels_) release(one);
  for (GLuint& one : lowOver_) release(one);
  release(lowFarZ_);
  releaseLists();
  bytes_ = 0;
  width_ = height_ = 0;
}

// Where the levels of the spread pyramid lie in their atlas, for the largest picture.
void pld_pass::layOutPyramid(int width, int height) {
  constexpr int margins = 2 * pellucid::shading::PLD_SPREAD_MARGIN;
  const float diagonal = std::hypot(static_cast<float>(width), static_cast<float>(height));
  levelCount_ = permutation_.has(PLD_FEATURE_DIFFUSION) ? pellucid::shading::spreadLevel(diagonal) : 0;
  for (auto& level : levels_) level[0] = level[1] = 1, level[2] = level[3] = 0;
  int wide = 1, rows = 0;
  for (int k = 1; k <= levelCount_; ++k) {
    GLint* level = levels_[k];
    level[0] = ((width + (1 << k) - 1) >> k) + margins;
    level[1] = ((height + (1 << k) - 1) >> k) + margins;
    level[2] = rows;
    wide = std::max(wide, level[0]);
    rows += level[1];
  }
  atlasWidth_ = wide;
  atlasHeight_ = std::max(rows, 1);
}

pld_status pld_pass::makeTextures(int width, int height) {
  const auto attach = [&](GLuint frame, GLenum attachment, GLuint texture) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  };
  GLenum buffers[kDrawBuffers];
  std::fill(std::begin(buffers), std::end(buffers), GLenum{GL_NONE});
  for (Plane& plane : planes_) {
    plane.texture = makeTexture(plane.spec.format, width, height, plane.spec.bits);
    attach(layersFrame_, GL_COLOR_ATTACHMENT0 + plane.spec.attachment, plane.texture);
    buffers[plane.spec.attachment] = GL_COLOR_ATTACHMENT0 + plane.spec.attachment;
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, layersFrame_);
  gl.DrawBuffers(kDrawBuffers, buffers);
  bool complete = gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  const auto check = [&] {
    complete = complete && gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  };
  if (permutation_.planarDepth()) {
    planarZ_ = makeTexture(GL_R32F, width, height, 32);
    attach(planarFrame_, GL_COLOR_ATTACHMENT0, planarZ_);
    check();
  }
  if (permutation_.frontStage()) {
    frontZ_ = makeTexture(GL_R32F, width, height, 32);
    attach(frontFrame_, GL_COLOR_ATTACHMENT0, frontZ_);
    check();
  }
  if (permutation_.has(PLD_FEATURE_SOLIDS)) {
    solid_ = makeTexture(GL_RGBA32F, width, height, 128);
    attach(solidFrame_, GL_COLOR_ATTACHMENT0, solid_);
    if (!permutation_.exact()) {
      solidDepth_ = makeTexture(GL_DEPTH_COMPONENT32F, width, height, 32);
      attach(solidFrame_, GL_DEPTH_ATTACHMENT, solidDepth_);
    }
    check();
  }
  if (permutation_.low()) complete = makeLowTextures(width, height) && complete;
  if (permutation_.rimsApart()) {
    GLenum all[kRimPlanes];
    for (GLuint i = 0; i < kRimPlanes; ++i) {
      rims_[i] = makeTexture(i < 2 ? GL_RGBA32F : GL_RG32F, width, height, i < 2 ? 128 : 64);
      all[i] = GL_COLOR_ATTACHMENT0 + i;
      attach(rimsFrame_, all[i], rims_[i]);
    }
    gl.DrawBuffers(kRimPlanes, all);
    check();
  }
  if (permutation_.has(PLD_FEATURE_DIFFUSION)) {
    layOutPyramid(width, height);
    GLenum all[kSpreadPlanes];
    for (GLuint i = 0; i < kSpreadPlanes; ++i) {
      spread_[i] = makeTexture(GL_RGBA32F, atlasWidth_, atlasHeight_, 128);
      all[i] = GL_COLOR_ATTACHMENT0 + i;
      attach(spreadFrame_, all[i], spread_[i]);
    }
    gl.DrawBuffers(kSpreadPlanes, all);
    check();
  }
  if (!complete)
    return fail(PLD_ERROR_UNSUPPORTED, "pld_resize: this device cannot draw to the planes of this tier at once");
  return permutation_.exact() ? makeLists(width, height) : PLD_OK;
}

pld_status pld_pass::resize(int width, int height) {
  if (step_ == Step::open) return fail(PLD_ERROR_ORDER, "pld_resize: between pld_begin and pld_end");
  if (shadowOpen_) return fail(PLD_ERROR_ORDER, "pld_resize: between pld_shadow_begin and pld_shadow_end");
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (width < 1 || height < 1 || width > most || height > most)
    return fail(PLD_ERROR_SIZE, "pld_resize: found %dx%d, expected 1 to %d pixels on either side", width, height, most);
  if (width == width_ && height == height_) return PLD_OK;
  while (const GLenum pending = gl.GetError()) {
    char text[100];
    std::snprintf(text, sizeof(text), "pld_resize: a GL error of the host was pending: 0x%x", pending);
    say(PLD_LOG_WARNING, text);
  }
  SavedState state;
  state.save(gl, {0, 1}, -1, permutation_.exact() ? Storage{0, 0} : Storage{});
  GLint unpack = 0;
  gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.ActiveTexture(GL_TEXTURE0);
  releaseTextures();
  pld_status status = makeTextures(width, height);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack));
  state.restore(gl);
  bool outOfMemory = false;
  GLenum other = GL_NO_ERROR;
  while (const GLenum error = gl.GetError()) (error == GL_OUT_OF_MEMORY ? outOfMemory = true : (other = error, true));
  if (outOfMemory)
    status = fail(PLD_ERROR_MEMORY, "pld_resize: the GL device has no room for planes of %dx%d", width, height);
  else if (other && status == PLD_OK)
    status = fail(PLD_ERROR_INTERNAL, "pld_resize: GL error 0x%x", other);
  if (status != PLD_OK) {
    releaseTextures();
    step_ = Step::sizeless;
    return status;
  }
  width_ = width;
  height_ = height;
  step_ = Step::between;
  stagesDone_ = 0;
  return PLD_OK;
}
