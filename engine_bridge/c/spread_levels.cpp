#include "engine_bridge/c/spread_levels.h"

#include <cmath>

namespace pellucid::c {

void SpreadLevels::create() {
  device_.makeFrame(frame_);
}

std::string SpreadLevels::build() {
  if (!device_.permutation.has(PLD_FEATURE_DIFFUSION)) return {};
  return program_.build(device_.gl, "gl/spread_level.frag", resolveDefines(device_.permutation));
}

void SpreadLevels::destroy() {
  release();
  program_.destroy(device_.gl);
  device_.releaseFrame(frame_);
}

void SpreadLevels::release() {
  for (GLuint& one : planes_) device_.releaseTexture(one);
  bytes_ = 0;
}

void SpreadLevels::layOut(int width, int height) {
  if (device_.permutation.has(PLD_FEATURE_DIFFUSION)) layout_ = spreadLayout(width, height, 1);
}

bool SpreadLevels::make(int width, int height) {
  if (!device_.permutation.has(PLD_FEATURE_DIFFUSION)) return true;
  layOut(width, height);
  GLenum all[kPlanes];
  for (GLuint i = 0; i < kPlanes; ++i) {
    planes_[i] = device_.makeTexture(GL_RGBA32F, layout_.width, layout_.height, 128, bytes_);
    all[i] = GL_COLOR_ATTACHMENT0 + i;
    device_.attach(frame_, all[i], planes_[i]);
  }
  device_.gl.DrawBuffers(kPlanes, all);
  return device_.isComplete();
}

void SpreadLevels::draw(int width, int height) {
  const GlFunctions& gl = device_.gl;
  layOut(width, height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_);
  device_.use(program_);
  gl.Uniform4iv(program_.place(gl, "spreadLevels"), SpreadLayout::kLevels, &layout_.levels[0][0]);
  gl.Uniform2i(program_.place(gl, "pictureSize"), width, height);
  const GLint level = program_.place(gl, "level");
  for (int k = 1; k <= layout_.count; ++k) {
    setViewportTo(gl, 0, layout_.levels[k][2], layout_.levels[k][0], layout_.levels[k][1]);
    gl.Uniform1i(level, k);
    device_.drawEverywhere();
    gl.TextureBarrier();
  }
}

void SpreadLevels::bind() const {
  for (GLuint i = 0; i < kPlanes; ++i) device_.bind(11 + i, planes_[i]);
}

void SpreadLevels::setUniforms(const Program& program, int width, int height) const {
  const GlFunctions& gl = device_.gl;
  gl.Uniform3i(program.place(gl, "lookup"), 0, 0, layout_.count);
  gl.Uniform1f(program.place(gl, "largestSpread"), std::hypot(static_cast<float>(width), static_cast<float>(height)));
  if (layout_.count > 0) gl.Uniform4iv(program.place(gl, "spreadLevels"), SpreadLayout::kLevels, &layout_.levels[0][0]);
}

}  // namespace pellucid::c
