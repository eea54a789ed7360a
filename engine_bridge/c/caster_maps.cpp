#include "engine_bridge/c/caster_maps.h"

#include <algorithm>
#include <cstring>

#include "engine_bridge/c/caster_table.h"

namespace pellucid::c {
namespace {

constexpr GLenum kBuffers[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};

bool upperLeft(const GlFunctions& gl) {
  GLint origin = GL_LOWER_LEFT;
  if (gl.clipControl) gl.GetIntegerv(GL_CLIP_ORIGIN, &origin);
  return origin == GL_UPPER_LEFT;
}

}  // namespace

int CasterMaps::edge() const {
  return edgeOf(info_);
}

void CasterMaps::release() {
  for (GLuint& one : drawn_) device_.releaseTexture(one);
  for (GLuint& one : across_) device_.releaseTexture(one);
  device_.releaseTexture(maps_);
  for (GLuint* buffer : {&table_, &uniforms_}) {
    if (*buffer) device_.gl.DeleteBuffers(1, buffer);
    *buffer = 0;
  }
  for (GLuint* frame : {&drawnFrame_, &acrossFrame_, &mapFrame_}) device_.releaseFrame(*frame);
  for (Program* program : {&texels_, &down_, &view_}) program->destroy(device_.gl);
  std::fill(std::begin(faces_), std::end(faces_), FaceKind::empty);
  bytes_ = 0;
  info_ = {};
}

std::string CasterMaps::build() {
  const GlFunctions& gl = device_.gl;
  std::vector<std::string> defines;
  if (channelsOf(info_) == 1) defines.emplace_back("GREY");
  const auto make = [&](Program& program, const char* filter) {
    std::vector<std::string> all = defines;
    all.emplace_back(filter);
    return program.build(gl, "gl/shadow_filter.frag", all);
  };
  std::string failure = make(texels_, isFiltered(info_) ? "FILTER 1" : "FILTER 0");
  if (failure.empty() && isFiltered(info_)) failure = make(down_, "FILTER 2");
  if (failure.empty() && (device_.info.flags & PLD_FLAG_DEBUG_VIEWS))
    failure = view_.build(gl, "gl/view_shadow.frag", {});
  return failure;
}

bool CasterMaps::makeDrawn(GLuint& frame, GLuint* textures, int count, int width, int height) {
  device_.makeFrame(frame);
  for (int i = 0; i < count; ++i) {
    textures[i] = device_.makeTexture(GL_RGBA32F, width, height, 128, bytes_);
    device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, kBuffers[i], GL_TEXTURE_2D, textures[i], 0);
  }
  device_.gl.DrawBuffers(count, kBuffers);
  return device_.isComplete();
}

bool CasterMaps::makeMaps() {
  const GlFunctions& gl = device_.gl;
  const int edge = edgeOf(info_), channels = channelsOf(info_), layers = info_.faces * channels;
  GLint bound = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &bound);
  gl.GenTextures(1, &maps_);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, maps_);
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, edge, edge, layers, 0, GL_RGBA, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, static_cast<GLuint>(bound));
  bytes_ += 16 * static_cast<uint64_t>(edge) * static_cast<uint64_t>(edge) * static_cast<uint64_t>(layers);
  device_.makeFrame(mapFrame_);
  for (int c = 0; c < channels; ++c) gl.FramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, kBuffers[c], maps_, 0, c);
  gl.DrawBuffers(channels, kBuffers);
  return device_.isComplete();
}

// No light has a face yet.
void CasterMaps::makeTable() {
  const GlFunctions& gl = device_.gl;
  const std::vector<std::uint8_t> none(static_cast<std::size_t>(info_.lights) * sizeof(shading::ShadowLight) +
                                       static_cast<std::size_t>(info_.faces) * sizeof(shading::ShadowFace));
  gl.GenBuffers(1, &table_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, table_);
  gl.BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(none.size()), none.data(), GL_DYNAMIC_DRAW);
  gl.GenBuffers(1, &uniforms_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferData(GL_UNIFORM_BUFFER, 8 * sizeof(GLfloat), nullptr, GL_DYNAMIC_DRAW);
}

pld_status CasterMaps::make() {
  const int size = info_.size, edge = edgeOf(info_), channels = channelsOf(info_);
  if (const std::string failure = build(); !failure.empty())
    return device_.fail(PLD_ERROR_INTERNAL, "%s", failure.c_str());
  bool complete = makeDrawn(drawnFrame_, drawn_, channels == 1 ? 1 : 2, size, size);
  if (isFiltered(info_)) complete = makeDrawn(acrossFrame_, across_, channels, edge, size) && complete;
  complete = makeMaps() && complete;
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
  if (exist() && std::memcmp(info, &info_, sizeof(*info)) == 0) return PLD_OK;
  device_.reportPendingErrors("pld_shadow_resize");
  pld_status status = PLD_OK;
  {
    const Room room(device_, {});
    release();
    info_ = *info;
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
  if (const pld_status status = checkView(device_, info_, view, attachment); status != PLD_OK) return status;
  device_.save({0, 3}, static_cast<int>(device_.info.uniform_binding));
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, drawnFrame_);
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
  const bool naive = info_.form == PLD_SHADOW_NAIVE || info_.form == PLD_SHADOW_PUBLISHED;
  const DepthMetric metric = metricOf(view);
  GLfloat block[8] = {static_cast<float>(metric.scale), static_cast<float>(metric.shift),
                      view.kind == PLD_LIGHT_LOCAL ? 1.0f : 0.0f, naive ? 1.0f : 0.0f};
  const uint32_t seed =
      shading::mapSeedOf(info_.seed, static_cast<uint32_t>(view.light), static_cast<uint32_t>(slotOf(view)));
  std::memcpy(&block[4], &seed, sizeof(seed));
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), block);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, device_.info.uniform_binding, uniforms_);
  setAccumulation(gl, info_.size, info_.size);
  const float far = shading::PLD_SHADOW_NOTHING;
  const GLfloat nothing[4] = {far, far, far, 0.0f}, none[4] = {0, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  if (drawn_[1]) gl.ClearBufferfv(GL_COLOR, 1, none);
  for (GLuint i = 0; i < (drawn_[1] ? 2u : 1u); ++i) {
    gl.Enablei(GL_BLEND, i);
    gl.BlendFuncSeparatei(i, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(i, i == 0 ? GL_MIN : GL_FUNC_ADD, GL_FUNC_ADD);
  }
  if (!tests) return;
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(device_.permutation.depth == PLD_DEPTH_REVERSED ? GL_GEQUAL : GL_LEQUAL);
}

// Where the open face's texels lie in the scene, for lookups.
void CasterMaps::setTable() const {
  const GlFunctions& gl = device_.gl;
  const shading::ShadowFace face = faceRow(info_, opened_, rows_);
  const shading::ShadowLight light = lightRow(info_, opened_);
  const auto lightBytes = static_cast<GLintptr>(sizeof(light)), faceBytes = static_cast<GLintptr>(sizeof(face));
  gl.BindBuffer(GL_UNIFORM_BUFFER, table_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, lightBytes * opened_.light, sizeof(light), &light);
  gl.BufferSubData(GL_UNIFORM_BUFFER, lightBytes * info_.lights + faceBytes * slotOf(opened_), sizeof(face), &face);
}

void CasterMaps::filter(int face) const {
  const GlFunctions& gl = device_.gl;
  const int size = info_.size, edge = edgeOf(info_), channels = channelsOf(info_);
  setPlainDrawing(gl, edge, size);
  device_.bind(0, drawn_[0]);
  if (drawn_[1]) device_.bind(1, drawn_[1]);
  if (isFiltered(info_)) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, acrossFrame_);
    device_.use(texels_);
    device_.drawEverywhere();
    for (int c = 0; c < channels; ++c) device_.bind(static_cast<GLuint>(c), across_[c]);
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, mapFrame_);
  for (int c = 0; c < channels; ++c)
    gl.FramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, kBuffers[c], maps_, 0, face * channels + c);
  setViewportTo(gl, 0, 0, edge, edge);
  device_.use(isFiltered(info_) ? down_ : texels_);
  device_.drawEverywhere();
}

void CasterMaps::end() {
  const GlFunctions& gl = device_.gl;
  device_.markDrawn();
  if (depthAttachment_) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, drawnFrame_);
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, depthAttachment_, GL_TEXTURE_2D, 0, 0);
  }
  const int face = slotOf(opened_);
  filter(face);
  setTable();
  faces_[face] = opened_.kind == PLD_LIGHT_LOCAL ? FaceKind::local : FaceKind::directional;
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
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, maps_);
  device_.bindSampler(0);
  device_.use(view_);
  gl.Uniform1i(view_.place(gl, "view"), static_cast<GLint>(view));
  gl.Uniform1i(view_.place(gl, "face"), face);
  gl.Uniform1i(view_.place(gl, "channels"), channelsOf(info_));
  gl.Uniform1i(view_.place(gl, "isLocal"), faces_[face] == FaceKind::local ? 1 : 0);
  device_.drawEverywhere();
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, device_.saves() ? static_cast<GLuint>(bound) : 0);
}

}  // namespace pellucid::c
