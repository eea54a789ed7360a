#include "engine_bridge/c/rim_stage.h"

#include "engine_bridge/c/host_textures.h"
#include "shaders/plane_defines.h"

namespace pellucid::c {
namespace {

constexpr int kFirstUnit = 0;  // of rims, where shaders/gl/rims_apply.frag reads them

}  // namespace

void RimStage::create() {
  device_.makeFrame(frame_);
  if (device_.permutation.rimsApart())
    rims_ = planesFrom(pellucid::planesOf(modelOf(device_.permutation), PlaneStage::rims));
}

std::string RimStage::build() {
  if (!device_.permutation.rimsApart()) return {};
  std::vector<std::string> defines = resolveDefines(device_.permutation, false);
  defines.push_back(rimSamplers(kFirstUnit));
  return apply_.build(device_.gl, "gl/rims_apply.frag", defines);
}

std::string RimStage::buildView() {
  if (!device_.permutation.rimsApart()) return {};
  // What rims take is looked at where it is, not where it is seen.
  std::vector<std::string> defines = resolveDefines(device_.permutation, false);
  defines.push_back(rimSamplers());
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
  return makePlanes(device_, frame_, rims_, width, height, bytes_);
}

void RimStage::release() {
  releasePlanes(device_, rims_);
  bytes_ = 0;
}

pld_status RimStage::darken(const pld_frame& frame) {
  const GlFunctions& gl = device_.gl;
  TextureFacts facts;
  if (!factsOf(gl, frame.occlusion_texture, facts) || facts.width < frame.width || facts.height < frame.height)
    return device_.fail(PLD_ERROR_TEXTURE, "pld_end: occlusion_texture %u is no longer what pld_begin saw",
                        frame.occlusion_texture);
  setPlainDrawing(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, planes_.layersFrame());
  device_.allowColours(0, false);
  for (const Plane& plane : planes_.layers()) {
    if (plane.spec.sum != PlaneSum::radiance && plane.spec.sum != PlaneSum::light) continue;
    const auto i = static_cast<GLuint>(plane.spec.target);
    gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    gl.Enablei(GL_BLEND, i);
    gl.BlendFuncSeparatei(i, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(i, GL_FUNC_REVERSE_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT);
  }
  for (const Plane& plane : rims_) device_.bind(static_cast<GLuint>(kFirstUnit + plane.spec.target), plane.texture);
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
  bindPlanes(device_, rims_);
  device_.bind(14, frame.occlusion_texture);
  gl.Uniform2i(view_.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(view_.place(gl, "form"), static_cast<GLint>(frame.occlusion));
  gl.Uniform1i(view_.place(gl, "view"), static_cast<GLint>(view));
  device_.drawEverywhere();
}

}  // namespace pellucid::c
