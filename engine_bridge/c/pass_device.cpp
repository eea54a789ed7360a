#include "engine_bridge/c/pass_device.h"

#include <chrono>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {

pld_status Device::load(const pld_create_info& create) {
  info = create;
  const std::string missing = c::load(info.get_proc_address, info.get_proc_address_user, gl);
  if (missing.empty()) return PLD_OK;
  const bool noContext = missing.find("no context") != std::string::npos;
  return fail(noContext ? PLD_ERROR_CONTEXT : PLD_ERROR_UNSUPPORTED, "pld_create: expected %s", missing.c_str());
}

pld_status Device::fail(pld_status status, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, sizeof(message), format, arguments);
  va_end(arguments);
  say(PLD_LOG_ERROR, message);
  return status;
}

void Device::say(pld_log_level level, const char* text) const {
  if (info.log) info.log(info.log_user, level, text);
}

pld_status Device::told(pld_status status) const {
  if (status != PLD_OK) say(PLD_LOG_ERROR, message);
  return status;
}

pld_status Device::failTexture(const char* call, const char* field, GLuint name) {
  return fail(PLD_ERROR_TEXTURE, "%s: %s %u is %s: expected a GL_TEXTURE_2D of this context", call, field, name,
              kindOf(gl, name));
}

void Device::reportPendingErrors(const char* call) const {
  while (const GLenum pending = gl.GetError()) {
    char text[100];
    std::snprintf(text, sizeof(text), "%s: a GL error of the host was pending: 0x%x", call, pending);
    say(PLD_LOG_WARNING, text);
  }
}

GLenum Device::takeErrors() const {
  GLenum taken = GL_NO_ERROR;
  while (const GLenum error = gl.GetError())
    if (taken == GL_NO_ERROR || error == GL_OUT_OF_MEMORY) taken = error;
  return taken;
}

void Device::create() {
  gl.GenVertexArrays(1, &vertexArray_);
  gl.GenSamplers(1, &sampler_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.SamplerParameteri(sampler_, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.SamplerParameteri(sampler_, wrap, GL_CLAMP_TO_EDGE);
  gl.SamplerParameteri(sampler_, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  gl.BindVertexArray(vertexArray_);  // a name alone is no object
  if (gl.ObjectLabel) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    std::snprintf(label_, sizeof(label_), "pellucid %p %lld", static_cast<void*>(this), static_cast<long long>(now));
    gl.ObjectLabel(GL_VERTEX_ARRAY, vertexArray_, -1, label_);
  }
  if (info.flags & PLD_FLAG_TIMERS) timers.create(gl);
  fences_.create(gl);
}

void Device::destroy() {
  fences_.destroy(gl);
  timers.destroy(gl);
  if (vertexArray_) gl.DeleteVertexArrays(1, &vertexArray_);
  if (sampler_) gl.DeleteSamplers(1, &sampler_);
}

// Vertex arrays are never shared between contexts - Mesa shares framebuffers -, and ours has a label that no other has.
bool Device::isCurrent() const {
  if (trusts()) return true;
  if (gl.IsVertexArray(vertexArray_) != GL_TRUE) return false;
  if (!gl.GetObjectLabel) return true;
  char label[sizeof(label_)] = {};
  gl.GetObjectLabel(GL_VERTEX_ARRAY, vertexArray_, sizeof(label), nullptr, label);
  return std::strcmp(label, label_) == 0;
}

void Device::save(Units units, int uniformBinding, Storage storage) {
  if (saves()) saved_.save(gl, units, uniformBinding, storage);
}

void Device::restore() const {
  if (saves()) saved_.restore(gl);
}

void Device::restoreForDraws() const {
  if (saves()) saved_.restoreForDraws(gl);
}

void Device::restoreActiveUnit() const {
  if (saves()) saved_.restoreActiveUnit(gl);
}

void Device::pushGroup(const char* name) const {
  if ((info.flags & PLD_FLAG_DEBUG_GROUPS) && gl.PushDebugGroup)
    gl.PushDebugGroup(GL_DEBUG_SOURCE_THIRD_PARTY, 0, -1, name);
}

void Device::popGroup() const {
  if ((info.flags & PLD_FLAG_DEBUG_GROUPS) && gl.PushDebugGroup) gl.PopDebugGroup();
}

void Device::bind(GLuint unit, GLuint texture) const {
  gl.ActiveTexture(GL_TEXTURE0 + unit);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  bindSampler(unit);
}

void Device::bindSampler(GLuint unit) const {
  gl.BindSampler(unit, sampler_);
}

void Device::use(const Program& program) const {
  gl.UseProgram(program.name);
  gl.BindVertexArray(vertexArray_);
}

void Device::drawEverywhere() {
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  fences_.mark(gl);
}

GLuint Device::makeTexture(GLenum format, int width, int height, int bits, uint64_t& bytes) const {
  const bool depth = format == GL_DEPTH_COMPONENT32F;
  GLuint name = 0;
  gl.GenTextures(1, &name);
  gl.BindTexture(GL_TEXTURE_2D, name);
  // Before the image: drivers make room for levels that they may expect.
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                GL_FLOAT, nullptr);
  bytes += static_cast<uint64_t>(bits) / 8 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  return name;
}

GLuint Device::makeArray(GLenum format, int width, int height, int layers, int bits, uint64_t& bytes) const {
  GLint bound = 0;
  GLuint name = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &bound);
  gl.GenTextures(1, &name);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, name);
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(format), width, height, layers, 0, GL_RGBA, GL_FLOAT,
                nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, static_cast<GLuint>(bound));
  bytes += static_cast<uint64_t>(bits) / 8 * static_cast<uint64_t>(width) * static_cast<uint64_t>(height) *
           static_cast<uint64_t>(layers);
  return name;
}

void Device::releaseTexture(GLuint& name) const {
  if (name) gl.DeleteTextures(1, &name);
  name = 0;
}

void Device::makeFrame(GLuint& frame) const {
  gl.GenFramebuffers(1, &frame);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
}

void Device::releaseFrame(GLuint& frame) const {
  if (frame) gl.DeleteFramebuffers(1, &frame);
  frame = 0;
}

void Device::attach(GLuint frame, GLenum attachment, GLuint texture) const {
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void Device::attachLayer(GLuint frame, GLenum attachment, GLuint array, int layer) const {
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  gl.FramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, attachment, array, 0, layer);
}

bool Device::isComplete() const {
  return gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void Device::allowColours(GLuint first, bool written) const {
  setColourMask(gl, first, written);
}

Room::Room(Device& device, Storage storage) : device_(device) {
  const GlFunctions& gl = device_.gl;
  state_.save(gl, {0, 1}, -1, storage);
  gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.ActiveTexture(GL_TEXTURE0);
}

Room::~Room() {
  device_.gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack_));
  state_.restore(device_.gl);
}

}  // namespace pellucid::c
