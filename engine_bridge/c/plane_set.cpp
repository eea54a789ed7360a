#include "engine_bridge/c/plane_set.h"

#include <algorithm>

namespace pellucid::c {

void setBlending(const GlFunctions& gl, GLuint i, BlendKind kind) {
  gl.Enablei(GL_BLEND, i);
  const bool product = kind == BlendKind::product;
  gl.BlendFuncSeparatei(i, product ? GL_ZERO : GL_ONE, product ? GL_ONE_MINUS_SRC_COLOR : GL_ONE, GL_ONE, GL_ONE);
  gl.BlendEquationSeparatei(i, kind == BlendKind::minimum ? GL_MIN : GL_FUNC_ADD,
                            kind == BlendKind::minimum || kind == BlendKind::alphaMinimum ? GL_MIN : GL_FUNC_ADD);
}

void PlaneSet::create() {
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_}) device_.makeFrame(*frame);
  for (const PlaneSpec& spec : planesOf(device_.permutation)) layers_.push_back({spec, 0});
}

void PlaneSet::destroy() {
  release();
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_}) device_.releaseFrame(*frame);
}

void PlaneSet::release() {
  for (Plane& plane : layers_) device_.releaseTexture(plane.texture);
  for (GLuint* one : {&planarZ_, &frontZ_, &solid_, &solidDepth_}) device_.releaseTexture(*one);
  bytes_ = 0;
}

bool PlaneSet::make(int width, int height) {
  const GlFunctions& gl = device_.gl;
  const Permutation& p = device_.permutation;
  const auto make = [&](GLenum format, int bits) { return device_.makeTexture(format, width, height, bits, bytes_); };
  GLenum buffers[kDrawBuffers];
  std::fill(std::begin(buffers), std::end(buffers), GLenum{GL_NONE});
  for (Plane& plane : layers_) {
    plane.texture = make(plane.spec.format, plane.spec.bits);
    buffers[plane.spec.attachment] = GL_COLOR_ATTACHMENT0 + plane.spec.attachment;
    device_.attach(layersFrame_, buffers[plane.spec.attachment], plane.texture);
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, layersFrame_);
  gl.DrawBuffers(kDrawBuffers, buffers);
  bool complete = device_.isComplete();
  if (p.planarDepth()) {
    planarZ_ = make(GL_R32F, 32);
    device_.attach(planarFrame_, GL_COLOR_ATTACHMENT0, planarZ_);
    complete = device_.isComplete() && complete;
  }
  if (p.frontStage()) {
    frontZ_ = make(GL_R32F, 32);
    device_.attach(frontFrame_, GL_COLOR_ATTACHMENT0, frontZ_);
    complete = device_.isComplete() && complete;
  }
  if (p.has(PLD_FEATURE_SOLIDS)) {
    solid_ = make(GL_RGBA32F, 128);
    device_.attach(solidFrame_, GL_COLOR_ATTACHMENT0, solid_);
    if (!p.exact()) {
      solidDepth_ = make(GL_DEPTH_COMPONENT32F, 32);
      device_.attach(solidFrame_, GL_DEPTH_ATTACHMENT, solidDepth_);
    }
    complete = device_.isComplete() && complete;
  }
  return complete;
}

}  // namespace pellucid::c
