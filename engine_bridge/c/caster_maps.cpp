#include "engine_bridge/c/caster_maps.h"

#include <algorithm>
#include <cstring>

#include "engine_bridge/c/caster_plan.h"
#include "engine_bridge/c/caster_table.h"

namespace pellucid::c {
namespace {

bool upperLeft(const GlFunctions& gl) {
  GLint origin = GL_LOWER_LEFT;
  if (gl.clipControl) gl.GetIntegerv(GL_CLIP_ORIGIN, &origin);
  return origin == GL_UPPER_LEFT;
}

}  // namespace

int CasterMaps::edge() const {
  return edgeOf(info());
}

void CasterMaps::release() {
  textures_.destroy();
  runner_.destroy();
  for (GLuint* buffer : {&table_, &uniforms_}) {
    if (*buffer) device_.gl.DeleteBuffers(1, buffer);
    *buffer = 0;
  }
  view_.destroy(device_.gl);
  std::fill(std::begin(faces_), std::end(faces_), FaceKind::empty);
  plan_ = {};
}

// No light has a face yet.
void CasterMaps::makeTable() {
  const GlFunctions& gl = device_.gl;
  const std::vector<std::uint8_t> none(tableBytes(info()));
  gl.GenBuffers(1, &table_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, table_);
  gl.BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(none.size()), none.data(), GL_DYNAMIC_DRAW);
  gl.GenBuffers(1, &uniforms_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferData(GL_UNIFORM_BUFFER, sizeof(CasterBlock), nullptr, GL_DYNAMIC_DRAW);
}

pld_status CasterMaps::make() {
  textures_.create(plan_);
  std::string failure = runner_.build();
  if (failure.empty() && (device_.info.flags & PLD_FLAG_DEBUG_VIEWS))
    failure = view_.build(device_.gl, "gl/view_shadow.frag", {});
  if (!failure.empty()) return device_.fail(PLD_ERROR_INTERNAL, "%s", failure.c_str());
  const bool complete = textures_.make(0, 0);
  makeTable();
  if (complete) return PLD_OK;
  return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_shadow_resize: this device cannot draw to RGBA32F");
}

pld_status CasterMaps::resize(const pld_shadow_info* info) {
  if (!info) {
    release();
    return PLD_OK;
  }
  if (const pld_status status = checkMaps(device_, *info); status != PLD_OK) return status;
  if (exist() && std::memcmp(info, &plan_.maps, sizeof(*info)) == 0) return PLD_OK;
  device_.reportPendingErrors("pld_shadow_resize");
  pld_status status = PLD_OK;
  {
    const Room room(device_, {});
    release();
    plan_ = casterPlan(*info, device_.permutation.depth);
    status = make();
  }
  const GLenum error = device_.takeErrors();
  if (error == GL_OUT_OF_MEMORY)
    status = device_.fail(PLD_ERROR_MEMORY, "pld_shadow_resize: the GL device has no room for %d faces of %d texels",
                          info->faces, info->size);
  else if (error != GL_NO_ERROR && status == PLD_OK)
    status = device_.fail(PLD_ERROR_INTERNAL, "pld_shadow_resize: GL error 0x%x", error);
  if (status != PLD_OK) release();
  return status;
}

pld_status CasterMaps::begin(const pld_shadow_view& view) {
  const GlFunctions& gl = device_.gl;
  GLenum attachment = 0;
  if (const pld_status status = checkView(device_, info(), view, attachment); status != PLD_OK) return status;
  device_.save({0, 3}, static_cast<int>(device_.info.uniform_binding));
  runner_.beginFace(faceLayer(info(), view));
  runner_.bindFrame(draws());
  if (attachment) {
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, view.depth_texture, 0);
    if (!device_.isComplete()) {
      gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, 0, 0);
      device_.restore();
      return device_.fail(PLD_ERROR_FORMAT, "pld_shadow_begin: this device cannot test against depth_texture %u",
                          view.depth_texture);
    }
  }
  device_.pushGroup("pellucid shadow");
  device_.timers.beginFace(gl);
  openFace(view, attachment != 0);
  depthAttachment_ = attachment;
  opened_ = view;
  rows_ = upperLeft(gl) ? -1.0 : 1.0;
  open_ = true;
  return PLD_OK;
}

//   tests  against a depth of the host's
void CasterMaps::openFace(const pld_shadow_view& view, bool tests) {
  const GlFunctions& gl = device_.gl;
  const CasterBlock block = casterBlock(info(), view);
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), &block);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, device_.info.uniform_binding, uniforms_);
  setAccumulation(gl, info().size, info().size);
  runner_.clear(draws());
  runner_.setBlending(draws());
  if (tests) runner_.setTests(draws());
}

// Where the open face's texels lie in the scene, for lookups.
void CasterMaps::setTable() const {
  const GlFunctions& gl = device_.gl;
  const shading::ShadowFace face = faceRow(info(), opened_, rows_);
  const shading::ShadowLight light = lightRow(info(), opened_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, table_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, static_cast<GLintptr>(lightPlace(opened_.light)), sizeof(light), &light);
  gl.BufferSubData(GL_UNIFORM_BUFFER, static_cast<GLintptr>(facePlace(info(), slotOf(opened_))), sizeof(face), &face);
}

void CasterMaps::end() {
  const GlFunctions& gl = device_.gl;
  device_.markDrawn();
  if (depthAttachment_) device_.attach(textures_.frame(draws()), depthAttachment_, 0);
  runner_.beginFace(faceLayer(info(), opened_));
  for (const PlannedPass& pass : plan_.passes)
    if (pass.moment == Moment::end) runner_.run(pass);
  setTable();
  faces_[slotOf(opened_)] = opened_.kind == PLD_LIGHT_LOCAL ? FaceKind::local : FaceKind::directional;
  device_.timers.endFace(gl);
  device_.restore();
  device_.popGroup();
  open_ = false;
}

void CasterMaps::drawView(pld_view view, int face) const {
  const GlFunctions& gl = device_.gl;
  gl.ActiveTexture(GL_TEXTURE0);
  GLint bound = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &bound);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture());
  device_.bindSampler(0);
  device_.use(view_);
  gl.Uniform1i(view_.place(gl, "view"), static_cast<GLint>(view));
  gl.Uniform1i(view_.place(gl, "face"), face);
  gl.Uniform1i(view_.place(gl, "channels"), channelsOf(info()));
  gl.Uniform1i(view_.place(gl, "isLocal"), faces_[face] == FaceKind::local ? 1 : 0);
  device_.drawEverywhere();
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, device_.saves() ? static_cast<GLuint>(bound) : 0);
}

}  // namespace pellucid::c
