#include "engine_bridge/c/low_stage.h"

#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

void LowStage::create() {
  for (GLuint* frame : {&frame_, &depthFrame_, &texelFrame_, &overFrame_}) device_.makeFrame(*frame);
  if (device_.permutation.low())
    for (const PlaneSpec& spec : lowPlanes(device_.permutation)) sums_.push_back({spec, 0});
}

std::string LowStage::build() {
  const Permutation& p = device_.permutation;
  if (!p.low()) return {};
  std::vector<std::string> solids, upsample{"NORMALISATION 0"};
  if (!p.has(PLD_FEATURE_SOLIDS)) solids.emplace_back("NO_SOLIDS");
  upsample.insert(upsample.end(), solids.begin(), solids.end());
  if (p.grey()) upsample.emplace_back("GREY");
  if (p.scatters()) upsample.emplace_back("SCATTER");
  for (const std::string& place : scatterPlaces(p)) upsample.push_back(place);
  if (p.has(PLD_FEATURE_DISPERSION)) upsample.emplace_back("DISPERSION");
  if (p.tier == PLD_TIER_HALF) upsample.emplace_back("HALF");
  if (p.lowOver()) upsample.emplace_back("FRONT_TAIL");
  std::string failure = depth_.build(device_.gl, "gl/low_depth.frag", solids);
  // A texel's own light: what it bends and spreads is taken from its sums.
  std::vector<std::string> texel = resolveDefines(lowPermutation(p));
  std::erase(texel, "SCATTER");
  std::erase(texel, "DISPERSION");
  if (failure.empty()) failure = texel_.build(device_.gl, "gl/low_texel.frag", texel);
  if (failure.empty()) failure = upsample_.build(device_.gl, "gl/upsample.frag", upsample);
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
  for (Plane& plane : sums_) device_.releaseTexture(plane.texture);
  for (GLuint& one : texels_) device_.releaseTexture(one);
  for (GLuint& one : over_) device_.releaseTexture(one);
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
  GLenum buffers[kDrawBuffers] = {};
  for (Plane& plane : sums_) {
    plane.texture = device_.makeTexture(plane.spec.format, wide, high, plane.spec.bits, bytes_);
    buffers[plane.spec.attachment] = GL_COLOR_ATTACHMENT0 + plane.spec.attachment;
    device_.attach(frame_, buffers[plane.spec.attachment], plane.texture);
  }
  gl.DrawBuffers(kDrawBuffers, buffers);
  complete = device_.isComplete() && complete;
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
  GLenum buffers[kDrawBuffers] = {};
  for (const Plane& plane : planes_.layers()) {
    const GLuint i = plane.spec.attachment;
    buffers[i] = GL_COLOR_ATTACHMENT0 + i;
    const bool front = i == 6 || i == 7, one = i == 7 && device_.permutation.grey();
    if (front) over_[i - 6] = device_.makeTexture(one ? GL_R32F : GL_RGBA32F, width, height, one ? 32 : 128, bytes_);
    device_.attach(overFrame_, buffers[i], front ? over_[i - 6] : plane.texture);
  }
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
  for (const Plane& plane : sums_) device_.bind(plane.spec.unit, plane.texture);
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
  for (const Plane& plane : planes_.layers()) {
    const GLuint i = plane.spec.attachment;
    gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    setBlending(gl, i, plane.spec.blend);
  }
  const GLfloat none[4] = {0, 0, 0, 0};
  if (p.lowOver())
    for (GLint i = 6; i < kDrawBuffers; ++i) gl.ClearBufferfv(GL_COLOR, i, none);
  for (GLuint i = 0; i < kTexels; ++i) device_.bind(i, texels_[i]);
  device_.bind(3, planes_.planarZ());
  if (p.lowOver()) device_.bind(5, planes_.frontZ());
  if (planes_.solid()) device_.bind(4, planes_.solid());
  constexpr GLuint scatterUnits[] = {6, 7, 5, 8};  // of the planes of targets 4 to 7
  for (const Plane& plane : sums_)
    if (plane.spec.attachment >= 4 && p.scatters())
      device_.bind(scatterUnits[plane.spec.attachment - 4], plane.texture);
  device_.use(upsample_);
  gl.Uniform1f(upsample_.place(gl, "factor"), static_cast<float>(frame.low_factor));
  gl.Uniform2i(upsample_.place(gl, "texelCount"), wide, high);
  gl.Uniform1f(upsample_.place(gl, "texelsAPixel"), 1.0f / static_cast<float>(frame.low_factor));
  device_.drawEverywhere();
}

void LowStage::bindOver() const {
  if (!device_.permutation.lowOver()) return;
  for (GLuint i = 0; i < 2; ++i) device_.bind(11 + i, over_[i]);
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
