#include "engine_bridge/c/low_stage.h"

#include "engine_bridge/c/stage_plan.h"
#include "shaders/plane_defines.h"

namespace pellucid::c {

void LowStage::create() {
  for (GLuint* frame : {&frame_, &depthFrame_, &texelFrame_, &overFrame_}) device_.makeFrame(*frame);
  const Permutation& p = device_.permutation;
  if (!p.low()) return;
  sums_ = planesFrom(planesOf(lowPermutation(p)));
  over_ = planesFrom(pellucid::planesOf(modelOf(p), PlaneStage::over));
}

std::string LowStage::build() {
  const Permutation& p = device_.permutation;
  if (!p.low()) return {};
  std::vector<std::string> solids;
  if (!p.has(PLD_FEATURE_SOLIDS)) solids.emplace_back("NO_SOLIDS");
  const Permutation low = lowPermutation(p);
  std::string failure = depth_.build(device_.gl, "gl/low_depth.frag", solids);
  // A texel's own light: what it bends and spreads is taken from its sums.
  if (failure.empty()) failure = texel_.build(device_.gl, "gl/low_texel.frag", resolveDefines(low, false));
  if (failure.empty())
    failure = upsample_.build(device_.gl, "gl/upsample.frag", upsampleDefines(modelOf(p), modelOf(low)));
  return failure;
}

std::string LowStage::buildView() {
  return device_.permutation.low() ? view_.build(device_.gl, "gl/view_low.frag", {}) : std::string();
}

void LowStage::destroy() {
  release();
  for (Program* program : {&depth_, &texel_, &upsample_, &view_}) program->destroy(device_.gl);
  for (GLuint* frame : {&frame_, &depthFrame_, &texelFrame_, &overFrame_}) device_.releaseFrame(*frame);
}

void LowStage::release() {
  releasePlanes(device_, sums_);
  releasePlanes(device_, over_);
  for (GLuint& one : texels_) device_.releaseTexture(one);
  device_.releaseTexture(farZ_);
  bytes_ = 0;
}

bool LowStage::make(int width, int height) {
  if (!device_.permutation.low()) return true;
  const GlFunctions& gl = device_.gl;
  const int wide = (width + 1) / 2, high = (height + 1) / 2;
  farZ_ = device_.makeTexture(GL_R32F, wide, high, 32, bytes_);
  device_.attach(depthFrame_, GL_COLOR_ATTACHMENT0, farZ_);
  bool complete = device_.isComplete();
  complete = makePlanes(device_, frame_, sums_, wide, high, bytes_) && complete;
  GLenum all[kTexels];
  for (GLuint i = 0; i < kTexels; ++i) {
    texels_[i] = device_.makeTexture(GL_RGBA32F, wide, high, 128, bytes_);
    all[i] = GL_COLOR_ATTACHMENT0 + i;
    device_.attach(texelFrame_, all[i], texels_[i]);
  }
  gl.DrawBuffers(kTexels, all);
  complete = device_.isComplete() && complete;
  if (!device_.permutation.lowOver()) return complete;
  makeOver(width, height);
  return device_.isComplete() && complete;
}

// The sums of the layers, and in place of the nearest what lies before it.
void LowStage::makeOver(int width, int height) {
  makePlanes(device_, overFrame_, over_, width, height, bytes_);
  GLenum buffers[kDrawBuffers] = {};
  for (const Plane& plane : planes_.layers()) {
    const auto i = static_cast<GLuint>(plane.spec.target);
    buffers[i] = GL_COLOR_ATTACHMENT0 + i;
    if (!textureOf(over_, plane.spec.sum)) device_.attach(overFrame_, buffers[i], plane.texture);
  }
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, overFrame_);
  device_.gl.DrawBuffers(kDrawBuffers, buffers);
}

void LowStage::drawFarthestDepth(const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  setPlainDrawing(gl, frame.width / frame.low_factor, frame.height / frame.low_factor);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, depthFrame_);
  const GLuint seam = device_.info.texture_unit;  // bound again by the stage
  device_.bind(seam, planes_.planarZ());
  if (planes_.solid()) device_.bind(seam + 1, planes_.solid());
  device_.use(depth_);
  gl.Uniform1i(depth_.place(gl, "opaqueZ"), static_cast<GLint>(seam));
  gl.Uniform1i(depth_.place(gl, "solid"), static_cast<GLint>(seam + 1));
  gl.Uniform2i(depth_.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(depth_.place(gl, "factor"), frame.low_factor);
  device_.drawEverywhere();
}

void LowStage::resolveTexels(int wide, int high) const {
  const GlFunctions& gl = device_.gl;
  setPlainDrawing(gl, wide, high);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, texelFrame_);
  bindPlanes(device_, sums_);
  device_.bind(5, farZ_);
  device_.use(texel_);
  gl.Uniform2i(texel_.place(gl, "pictureSize"), wide, high);
  device_.drawEverywhere();
}

void LowStage::addToLayers(const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  const Permutation& p = device_.permutation;
  const int wide = frame.width / frame.low_factor, high = frame.height / frame.low_factor;
  resolveTexels(wide, high);
  setAccumulation(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, p.lowOver() ? overFrame_ : planes_.layersFrame());
  device_.allowColours(0, false);
  for (const Plane& plane : planes_.layers())
    gl.ColorMaski(static_cast<GLuint>(plane.spec.target), GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  setBlending(gl, planes_.layers());
  clearPlanes(gl, over_);
  if (p.scatters()) bindPlanes(device_, sums_);  // before the others: what the texels hold already gives way to them
  for (GLuint i = 0; i < kTexels; ++i) device_.bind(i, texels_[i]);
  device_.bind(3, planes_.planarZ());
  if (p.lowOver()) device_.bind(5, planes_.frontZ());
  if (planes_.solid()) device_.bind(4, planes_.solid());
  device_.use(upsample_);
  gl.Uniform1f(upsample_.place(gl, "factor"), static_cast<float>(frame.low_factor));
  gl.Uniform2i(upsample_.place(gl, "texelCount"), wide, high);
  gl.Uniform1f(upsample_.place(gl, "texelsAPixel"), 1.0f / static_cast<float>(frame.low_factor));
  device_.drawEverywhere();
}

void LowStage::bindOver() const {
  bindPlanes(device_, over_);
}

void LowStage::drawView(pld_view view, const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  device_.use(view_);
  for (GLuint i = 0; i < kTexels; ++i) device_.bind(i, texels_[i]);
  gl.Uniform1i(view_.place(gl, "factor"), frame.low_factor);
  gl.Uniform1i(view_.place(gl, "view"), static_cast<GLint>(view));
  device_.drawEverywhere();
}

}  // namespace pellucid::c
