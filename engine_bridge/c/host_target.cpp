#include "engine_bridge/c/host_target.h"

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {

bool isOfShadows(pld_view view) {
  return view >= PLD_VIEW_SHADOW_TRANSMISSION && view <= PLD_VIEW_SHADOW_DEPTH;
}

bool isOutput(pld_view view) {
  return view >= PLD_VIEW_REACTIVE && view <= PLD_VIEW_IDENTITY;
}

bool isOfRims(pld_view view) {
  return view == PLD_VIEW_RIM_OCCLUSION || view == PLD_VIEW_RIM_LOSS;
}

void HostTarget::create() {
  device_.makeFrame(frame_);
}

void HostTarget::destroy() {
  device_.releaseFrame(frame_);
}

pld_status HostTarget::check(const pld_target& target, int width, int height, GLuint source) {
  if (target.kind != PLD_TARGET_TEXTURE && target.kind != PLD_TARGET_FRAMEBUFFER)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_resolve: found kind %d, which pld_target_kind does not have",
                        static_cast<int>(target.kind));
  if (source && device_.trusts()) return PLD_OK;
  if (target.kind == PLD_TARGET_FRAMEBUFFER) {
    if (target.name != 0 && !device_.gl.IsFramebuffer(target.name))
      return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is no framebuffer of this context", target.name);
    return PLD_OK;
  }
  TextureFacts facts;
  if (!factsOf(device_.gl, target.name, facts)) return device_.failTexture("pld_resolve", "target", target.name);
  if (source && target.name == source)
    return device_.fail(PLD_ERROR_TEXTURE,
                        "pld_resolve: target %u is the frame's colour_texture, which is read meanwhile", target.name);
  if (textures_.holds(target.name))
    return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: target %u is a plane of this pass", target.name);
  const bool output = isOutput(target.view);
  if (!isColour(facts.format) && !(output && isLinearDepth(facts.format)))
    return device_.fail(PLD_ERROR_FORMAT, "pld_resolve: target has format 0x%x, expected RGB or RGBA%s",
                        static_cast<unsigned>(facts.format), output ? ", or R or RG of floats" : "");
  if (facts.width < width || facts.height < height)
    return device_.fail(PLD_ERROR_SIZE, "pld_resolve: target is %dx%d, expected at least %s %dx%d", facts.width,
                        facts.height, isOfShadows(target.view) ? "a face's" : "the frame's", width, height);
  return PLD_OK;
}

GLuint HostTarget::frameOf(const pld_target& target) const {
  return target.kind == PLD_TARGET_TEXTURE ? frame_ : target.name;
}

// Whether a framebuffer of the host's, which is bound, has the texture as its first colour.
bool HostTarget::drawsTo(const pld_target& target, GLuint texture) const {
  if (target.kind == PLD_TARGET_TEXTURE || target.name == 0) return false;
  GLint attached = 0, kind = 0;
  device_.gl.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                                                 GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &kind);
  if (kind == GL_TEXTURE)
    device_.gl.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &attached);
  return texture && static_cast<GLuint>(attached) == texture;
}

pld_status HostTarget::bind(const pld_target& target, GLuint source) {
  bindAgain(target);
  if (target.kind == PLD_TARGET_TEXTURE)
    device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name, 0);
  if (source && device_.trusts()) return PLD_OK;
  const bool own = drawsTo(target, source);
  if (!own && device_.isComplete()) return PLD_OK;
  unbind(target);
  return own ? device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: framebuffer %u draws to a texture that is read meanwhile",
                            target.name)
             : device_.fail(PLD_ERROR_FORMAT, "pld_resolve: this device cannot draw to target %u", target.name);
}

void HostTarget::bindAgain(const pld_target& target) const {
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frameOf(target));
}

void HostTarget::unbind(const pld_target& target) const {
  if (target.kind == PLD_TARGET_TEXTURE)
    device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
}

}  // namespace pellucid::c
