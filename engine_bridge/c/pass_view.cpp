// Where a resolve draws to, and the views that are not of a pixel's sums: rims, layers of low resolution, shadow maps.
#include "engine_bridge/c/pass.h"
#include "engine_bridge/c/textures.h"

using namespace pellucid::c;

bool pld_pass::isOfShadows(pld_view view) {
  return view >= PLD_VIEW_SHADOW_TRANSMISSION && view <= PLD_VIEW_SHADOW_DEPTH;
}

bool pld_pass::isOfRims(pld_view view) {
  return view == PLD_VIEW_RIM_OCCLUSION || view == PLD_VIEW_RIM_LOSS;
}

bool pld_pass::isOfLow(pld_view view) {
  return view >= PLD_VIEW_LOW_COLOUR && view <= PLD_VIEW_LOW_DEPTH;
}

bool pld_pass::isOfParts(pld_view view) {
  return isOfRims(view) || isOfLow(view);
}

std::string pld_pass::buildViewPrograms() {
  if (!(info_.flags & PLD_FLAG_DEBUG_VIEWS)) return {};
  std::string failure = view_.build(gl, "gl/view.frag", resolveDefines(permutation_));
  if (failure.empty() && permutation_.rimsApart()) {
    // What rims take is looked at where it is, not where it is seen.
    std::vector<std::string> defines = resolveDefines(permutation_);
    std::erase(defines, "SCATTER");
    std::erase(defines, "DISPERSION");
    failure = viewRims_.build(gl, "gl/view_rims.frag", defines);
  }
  if (failure.empty() && permutation_.low()) failure = viewLow_.build(gl, "gl/view_low.frag", {});
  return failure;
}

pld_status pld_pass::checkView(const pld_target& target) {
  if (target.view < PLD_VIEW_PICTURE || target.view > PLD_VIEW_SHADOW_DEPTH)
    return fail(PLD_ERROR_ARGUMENT, "pld_resolve: found view %d, which pld_view does not have",
                static_cast<int>(target.view));
  if (target.view != PLD_VIEW_PICTURE && !(info_.flags & PLD_FLAG_DEBUG_VIEWS))
    return fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: views need PLD_FLAG_DEBUG_VIEWS");
  const bool rims = isOfRims(target.view);
  if ((rims && !permutation_.rimsApart()) || (isOfLow(target.view) && !permutation_.low()))
    return fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: view %d needs %s", static_cast<int>(target.view),
                rims ? "PLD_FEATURE_RIMS and a stage of rims" : "PLD_FEATURE_LOW_RESOLUTION");
  TextureFacts open;
  if (rims &&
      (!factsOf(gl, frame_.occlusion_texture, open) || open.width < frame_.width || open.height < frame_.height))
    return fail(PLD_ERROR_TEXTURE, "pld_resolve: occlusion_texture %u is no longer what pld_begin saw",
                frame_.occlusion_texture);
  return PLD_OK;
}

//   source  a texture that is read meanwhile; 0 for none of the host's
pld_status pld_pass::checkTarget(const pld_target& target, int width, int height, GLuint source) {
  if (target.kind != PLD_TARGET_TEXTURE && target.kind != PLD_TARGET_FRAMEBUFFER)
    return fail(PLD_ERROR_ARGUMENT, "pld_resolve: found kind %d, which pld_target_kind does not have",
                static_cast<int>(target.kind));
  if (target.kind == PLD_TARGET_FRAMEBUFFER) {
    if (target.name != 0 && !gl.IsFramebuffer(target.name))
      return fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is no framebuffer of this context", target.name);
    return PLD_OK;
  }
  TextureFacts facts;
  if (!factsOf(gl, target.name, facts))
    return fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is no 2D texture of this context", target.name);
  if (source && target.name == source)
    return fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is the frame's colour_texture, which is read meanwhile",
                target.name);
  for (const Plane& plane : planes_)
    if (plane.texture == target.name)
      return fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is a plane of this pass", target.name);
  if (!isColour(facts.format))
    return fail(PLD_ERROR_FORMAT, "pld_resolve: target has format 0x%x, expected RGB or RGBA",
                static_cast<unsigned>(facts.format));
  if (facts.width < width || facts.height < height)
    return fail(PLD_ERROR_SIZE, "pld_resolve: target is %dx%d, expected at least %s %dx%d", facts.width, facts.height,
                isOfShadows(target.view) ? "a face's" : "the frame's", width, height);
  return PLD_OK;
}

GLuint pld_pass::targetFrame(const pld_target& target) const {
  return target.kind == PLD_TARGET_TEXTURE ? targetFrame_ : target.name;
}

pld_status pld_pass::bindTarget(const pld_target& target, GLuint source) {
  const bool toTexture = target.kind == PLD_TARGET_TEXTURE;
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targetFrame(target));
  if (toTexture) gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name, 0);
  GLint attached = 0, kind = 0;
  if (!toTexture && target.name != 0) {
    gl.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                                           GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &kind);
    if (kind == GL_TEXTURE)
      gl.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                                             GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &attached);
  }
  const bool own = source && static_cast<GLuint>(attached) == source;
  if (!own && gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return PLD_OK;
  unbindTarget(target);
  return own ? fail(PLD_ERROR_TEXTURE, "pld_resolve: framebuffer %u draws to a texture that is read meanwhile",
                    target.name)
             : fail(PLD_ERROR_FORMAT, "pld_resolve: this device cannot draw to target %u", target.name);
}

void pld_pass::unbindTarget(const pld_target& target) {
  if (target.kind == PLD_TARGET_TEXTURE)
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
}

// Of what the last stages have left, beside the sums that are bound.
void pld_pass::drawPart(pld_view view) {
  const bool rims = isOfRims(view);
  const Program& program = rims ? viewRims_ : viewLow_;
  useProgram(program);
  if (rims) {
    for (GLuint i = 0; i < kRimPlanes; ++i) bind(11 + i, rims_[i]);
    bind(14, frame_.occlusion_texture);
    gl.Uniform2i(program.place(gl, "pictureSize"), frame_.width, frame_.height);
    gl.Uniform1i(program.place(gl, "form"), static_cast<GLint>(frame_.occlusion));
  } else {
    for (GLuint i = 0; i < kLowTexels; ++i) bind(i, lowTexels_[i]);
    gl.Uniform1i(program.place(gl, "factor"), frame_.low_factor);
  }
  gl.Uniform1i(program.place(gl, "view"), static_cast<GLint>(view));
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

pld_status pld_pass::resolveShadow(const pld_target& target) {
  if (const pld_status status = checkView(target); status != PLD_OK) return status;
  if (step_ == Step::open) return fail(PLD_ERROR_ORDER, "pld_resolve: between pld_begin and pld_end");
  if (!shadowMaps_) return fail(PLD_ERROR_ORDER, "pld_resolve: a view of shadow maps before pld_shadow_resize");
  const int face = target.shadow_face, edge = shadowEdge();
  if (face < 0 || face >= shadowInfo_.faces)
    return fail(PLD_ERROR_ARGUMENT, "pld_resolve: shadow_face: found %d, expected 0 to %d", face,
                shadowInfo_.faces - 1);
  if (shadowFaces_[face] == FaceKind::empty)
    return fail(PLD_ERROR_ORDER, "pld_resolve: shadow_face %d has not been drawn", face);
  if (const pld_status status = checkTarget(target, edge, edge, 0); status != PLD_OK) return status;
  const bool saves = !(info_.flags & PLD_FLAG_HOST_RESTORES);
  if (saves) saved_.save(gl, {0, 1}, -1);
  if (const pld_status status = bindTarget(target, shadowMaps_); status != PLD_OK) {
    if (saves) saved_.restore(gl);
    return status;
  }
  pushGroup("pellucid view");
  setPlainDrawing(gl, edge, edge);
  for (GLuint i = 1; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl.ActiveTexture(GL_TEXTURE0);
  GLint array = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, shadowMaps_);
  gl.BindSampler(0, sampler_);
  useProgram(viewShadow_);
  gl.Uniform1i(viewShadow_.place(gl, "view"), static_cast<GLint>(target.view));
  gl.Uniform1i(viewShadow_.place(gl, "face"), face);
  gl.Uniform1i(viewShadow_.place(gl, "channels"), shadowChannels());
  gl.Uniform1i(viewShadow_.place(gl, "isLocal"), shadowFaces_[face] == FaceKind::local ? 1 : 0);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, saves ? static_cast<GLuint>(array) : 0);
  unbindTarget(target);
  if (saves) saved_.restore(gl);
  popGroup();
  return PLD_OK;
}
