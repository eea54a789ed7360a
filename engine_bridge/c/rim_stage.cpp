#include "engine_bridge/c/rim_stage.h"

#include "engine_bridge/c/textures.h"

namespace pellucid::c {

void RimStage::create() {
  device_.makeFrame(frame_);
}

std::string RimStage::build() {
  if (!device_.permutation.rimsApart()) return {};
  return apply_.build(device_.gl, "gl/rims_apply.frag", resolveDefines(device_.permutation));
}

std::string RimStage::buildView() {
  if (!device_.permutation.rimsApart()) return {};
  // What rims take is looked at where it is, not where it is seen.
  std::vector<std::string> defines = resolveDefines(device_.permutation);
  std::erase(defines, "SCATTER");
  std::erase(defines, "DISPERSION");
  return view_.build(device_.gl, "gl/view_rims.frag", defines);
}

void RimStage::destroy() {
  release();
  apply_.destroy(device_.gl);
  view_.destroy(device_.gl);
  device_.releaseFrame(frame_);
}

bool RimStage::make(int width, int height) {
  if (!device_.permutation.rimsApart()) return true;
  GLenum all[kPlanes];
  for (GLuint i = 0; i < kPlanes; ++i) {
    rims_[i] = device_.makeTexture(i < 2 ? GL_RGBA32F : GL_RG32F, width, height, i < 2 ? 128 : 64, bytes_);
    all[i] = GL_COLOR_ATTACHMENT0 + i;
    device_.attach(frame_, all[i], rims_[i]);
  }
  device_.gl.DrawBuffers(kPlanes, all);
  return device_.isComplete();
}

void RimStage::release() {
  for (GLuint& one : rims_) device_.releaseTexture(one);
  bytes_ = 0;
}

void RimStage::clear() const {
  const GLfloat none[4] = {0, 0, 0, 0};
  for (GLint i = 0; i < kPlanes; ++i) device_.gl.ClearBufferfv(GL_COLOR, i, none);
}

void RimStage::setBlend() const {
  for (GLuint i = 0; i < kPlanes; ++i) setBlending(device_.gl, i, BlendKind::add);
}

pld_status RimStage::darken(const pld_frame& frame) {
  const GlFunctions& gl = device_.gl;
  TextureFacts facts;
  if (!factsOf(gl, frame.occlusion_texture, facts) || facts.width < frame.width || facts.height < frame.height)
    return device_.fail(PLD_ERROR_TEXTURE, "pld_end: occlusion_texture %u is no longer what pld_begin saw",
                        frame.occlusion_texture);
  setPlainDrawing(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, planes_.layersFrame());
  for (GLuint i = 0; i < kDrawBuffers; ++i) {
    const bool holds = i == 0 || (i == 4 && device_.permutation.light());
    gl.ColorMaski(i, holds, holds, holds, GL_FALSE);
    if (!holds) continue;
    gl.Enablei(GL_BLEND, i);
    gl.BlendFuncSeparatei(i, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(i, GL_FUNC_REVERSE_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT);
  }
  for (GLuint i = 0; i < kPlanes; ++i) device_.bind(i, rims_[i]);
  device_.bind(3, planes_.planarZ());
  device_.bind(4, frame.occlusion_texture);
  if (planes_.solid()) device_.bind(5, planes_.solid());
  device_.use(apply_);
  gl.Uniform2i(apply_.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(apply_.place(gl, "form"), static_cast<GLint>(frame.occlusion));
  device_.drawEverywhere();
  return PLD_OK;
}

void RimStage::drawView(pld_view view, const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  device_.use(view_);
  for (GLuint i = 0; i < kPlanes; ++i) device_.bind(11 + i, rims_[i]);
  device_.bind(14, frame.occlusion_texture);
  gl.Uniform2i(view_.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(view_.place(gl, "form"), static_cast<GLint>(frame.occlusion));
  gl.Uniform1i(view_.place(gl, "view"), static_cast<GLint>(view));
  device_.drawEverywhere();
}

}  // namespace pellucid::c
