#include "engine_bridge/c/saved_state.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace pellucid::c {
namespace {

// Compatibility contexts only.
constexpr GLenum kAlphaTest = 0x0BC0, kPolygonStipple = 0x0B42;
// Switches, in the order of SavedState::enabled_.
constexpr GLenum kSwitches[] = {
    GL_DEPTH_TEST,      GL_STENCIL_TEST,   GL_COLOR_LOGIC_OP,     GL_SAMPLE_ALPHA_TO_COVERAGE,
    GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK,    GL_RASTERIZER_DISCARD, GL_CULL_FACE,
    GL_CLIP_DISTANCE0,  GL_CLIP_DISTANCE1, GL_CLIP_DISTANCE2,     GL_CLIP_DISTANCE3,
    GL_CLIP_DISTANCE4,  GL_CLIP_DISTANCE5, GL_CLIP_DISTANCE6,     GL_CLIP_DISTANCE7};
constexpr int kAccumulationSwitches = 7;  // the first of them; clearing obeys RASTERIZER_DISCARD too

void choose(const GlFunctions& gl, GLenum what, bool on) {
  on ? gl.Enable(what) : gl.Disable(what);
}

// Of the first viewport alone, where there are several.
void setScissor(const GlFunctions& gl, bool on) {
  if (!gl.ViewportIndexedf)
    choose(gl, GL_SCISSOR_TEST, on);
  else
    on ? gl.Enablei(GL_SCISSOR_TEST, 0) : gl.Disablei(GL_SCISSOR_TEST, 0);
}

void setViewport(const GlFunctions& gl, const GLfloat* v) {
  if (gl.ViewportIndexedf)
    gl.ViewportIndexedf(0, v[0], v[1], v[2], v[3]);
  else
    gl.Viewport(static_cast<GLint>(v[0]), static_cast<GLint>(v[1]), static_cast<GLsizei>(v[2]),
                static_cast<GLsizei>(v[3]));
}

GLint get(const GlFunctions& gl, GLenum what) {
  GLint value = 0;
  gl.GetIntegerv(what, &value);
  return value;
}

GLint get(const GlFunctions& gl, GLenum what, int index) {
  GLint value = 0;
  gl.GetIntegeri_v(what, static_cast<GLuint>(index), &value);
  return value;
}

GLuint livingBuffer(const GlFunctions& gl, GLint saved) {
  const auto name = static_cast<GLuint>(saved);
  return name && gl.IsBuffer(name) ? name : 0;
}

}  // namespace

SavedState::Bound SavedState::boundAt(const GlFunctions& gl, GLenum target, GLenum start, GLenum size, GLuint index) {
  Bound bound{};
  gl.GetIntegeri_v(target, index, &bound.buffer);
  gl.GetInteger64i_v(start, index, &bound.start);
  gl.GetInteger64i_v(size, index, &bound.size);
  return bound;
}

void SavedState::bindAgain(const GlFunctions& gl, GLenum target, GLuint index, const Bound& bound) {
  const GLuint name = livingBuffer(gl, bound.buffer);
  if (name && bound.size > 0)
    gl.BindBufferRange(target, index, name, static_cast<GLintptr>(bound.start), static_cast<GLsizeiptr>(bound.size));
  else
    gl.BindBufferBase(target, index, name);
}

void SavedState::save(const GlFunctions& gl, Units units, int uniformBinding, Storage storage) {
  units_ = units;
  storage_ = storage;
  uniformBinding_ = uniformBinding;
  program_ = get(gl, GL_CURRENT_PROGRAM);
  vertexArray_ = get(gl, GL_VERTEX_ARRAY_BINDING);
  drawFramebuffer_ = get(gl, GL_DRAW_FRAMEBUFFER_BINDING);
  activeTexture_ = get(gl, GL_ACTIVE_TEXTURE);
  if (gl.GetFloati_v) {
    gl.GetFloati_v(GL_VIEWPORT, 0, viewport_);
    scissor_ = gl.IsEnabledi(GL_SCISSOR_TEST, 0);
  } else {
    GLint whole[4];
    gl.GetIntegerv(GL_VIEWPORT, whole);
    for (int i = 0; i < 4; ++i) viewport_[i] = static_cast<GLfloat>(whole[i]);
    scissor_ = gl.IsEnabled(GL_SCISSOR_TEST);
  }
  for (int i = 0; i < kDrawBuffers; ++i) {
    Blend& blend = blend_[i];
    blend.enabled = gl.IsEnabledi(GL_BLEND, static_cast<GLuint>(i));
    gl.GetBooleani_v(GL_COLOR_WRITEMASK, static_cast<GLuint>(i), blend.mask);
    blend.sourceRgb = get(gl, GL_BLEND_SRC_RGB, i);
    blend.targetRgb = get(gl, GL_BLEND_DST_RGB, i);
    blend.sourceAlpha = get(gl, GL_BLEND_SRC_ALPHA, i);
    blend.targetAlpha = get(gl, GL_BLEND_DST_ALPHA, i);
    blend.equationRgb = get(gl, GL_BLEND_EQUATION_RGB, i);
    blend.equationAlpha = get(gl, GL_BLEND_EQUATION_ALPHA, i);
  }
  gl.GetBooleanv(GL_DEPTH_WRITEMASK, &depthMask_);
  depthFunction_ = get(gl, GL_DEPTH_FUNC);
  gl.GetIntegerv(GL_POLYGON_MODE, polygonMode_);
  for (std::size_t i = 0; i < std::size(kSwitches); ++i) enabled_[i] = gl.IsEnabled(kSwitches[i]);
  if (!gl.core) enabled_[std::size(kSwitches)] = gl.IsEnabled(kAlphaTest);
  if (!gl.core) enabled_[std::size(kSwitches) + 1] = gl.IsEnabled(kPolygonStipple);
  for (int i = 0; i < units.count; ++i) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(units.first + i));
    textures_[i] = get(gl, GL_TEXTURE_BINDING_2D);
    samplers_[i] = get(gl, GL_SAMPLER_BINDING);
  }
  gl.ActiveTexture(static_cast<GLenum>(activeTexture_));
  uniformBuffer_ = get(gl, GL_UNIFORM_BUFFER_BINDING);
  if (uniformBinding >= 0)
    uniforms_ = boundAt(gl, GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE,
                        static_cast<GLuint>(uniformBinding));
  if (storage.first < 0) return;
  storageBuffer_ = get(gl, GL_SHADER_STORAGE_BUFFER_BINDING);
  for (int i = 0; i < storage.count; ++i)
    listed_[i] = boundAt(gl, GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                         GL_SHADER_STORAGE_BUFFER_SIZE, static_cast<GLuint>(storage.first + i));
}

void SavedState::restore(const GlFunctions& gl) const {
  const auto name = [](GLint saved) { return static_cast<GLuint>(saved); };
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, name(drawFramebuffer_));
  setViewport(gl, viewport_);
  setScissor(gl, scissor_ != GL_FALSE);
  for (int i = 0; i < kDrawBuffers; ++i) {
    const Blend& blend = blend_[i];
    const auto index = static_cast<GLuint>(i);
    blend.enabled ? gl.Enablei(GL_BLEND, index) : gl.Disablei(GL_BLEND, index);
    gl.ColorMaski(index, blend.mask[0], blend.mask[1], blend.mask[2], blend.mask[3]);
    gl.BlendFuncSeparatei(index, name(blend.sourceRgb), name(blend.targetRgb), name(blend.sourceAlpha),
                          name(blend.targetAlpha));
    gl.BlendEquationSeparatei(index, name(blend.equationRgb), name(blend.equationAlpha));
  }
  gl.DepthMask(depthMask_);
  gl.DepthFunc(name(depthFunction_));
  restoreShape(gl);
  for (int i = 0; i < kAccumulationSwitches; ++i) choose(gl, kSwitches[i], enabled_[i] != GL_FALSE);
  if (!gl.core) choose(gl, kAlphaTest, enabled_[std::size(kSwitches)] != GL_FALSE);
  for (int i = 0; i < units_.count; ++i) restoreUnit(gl, i);
  restoreActiveUnit(gl);
  restoreObjects(gl);
  if (uniformBinding_ >= 0) bindAgain(gl, GL_UNIFORM_BUFFER, name(uniformBinding_), uniforms_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, livingBuffer(gl, uniformBuffer_));
  if (storage_.first < 0) return;
  for (int i = 0; i < storage_.count; ++i)
    bindAgain(gl, GL_SHADER_STORAGE_BUFFER, name(storage_.first + i), listed_[i]);
  gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, livingBuffer(gl, storageBuffer_));
}

void SavedState::restoreUnit(const GlFunctions& gl, int i) const {
  const auto name = static_cast<GLuint>(textures_[i]), unit = static_cast<GLuint>(units_.first + i);
  gl.ActiveTexture(GL_TEXTURE0 + unit);
  gl.BindTexture(GL_TEXTURE_2D, name && gl.IsTexture(name) ? name : 0);
  gl.BindSampler(unit, static_cast<GLuint>(samplers_[i]));
}

void SavedState::restoreActiveUnit(const GlFunctions& gl) const {
  gl.ActiveTexture(static_cast<GLenum>(activeTexture_));
}

void SavedState::restoreObjects(const GlFunctions& gl) const {
  const auto program = static_cast<GLuint>(program_);
  gl.BindVertexArray(static_cast<GLuint>(vertexArray_));
  gl.UseProgram(program && gl.IsProgram(program) ? program : 0);
}

void SavedState::restoreForDraws(const GlFunctions& gl) const {
  restoreShape(gl);
  restoreObjects(gl);
}

void SavedState::restoreShape(const GlFunctions& gl) const {
  const auto name = [](GLint saved) { return static_cast<GLuint>(saved); };
  if (gl.core || polygonMode_[0] == polygonMode_[1]) {
    gl.PolygonMode(GL_FRONT_AND_BACK, name(polygonMode_[0]));
  } else {
    gl.PolygonMode(GL_FRONT, name(polygonMode_[0]));
    gl.PolygonMode(GL_BACK, name(polygonMode_[1]));
  }
  for (std::size_t i = kAccumulationSwitches; i < std::size(kSwitches); ++i)
    choose(gl, kSwitches[i], enabled_[i] != GL_FALSE);
  if (!gl.core) choose(gl, kPolygonStipple, enabled_[std::size(kSwitches) + 1] != GL_FALSE);
}

bool SavedState::Blend::blendsAs(const Blend& other) const {
  if (enabled != other.enabled) return false;
  return !enabled ||
         (sourceRgb == other.sourceRgb && targetRgb == other.targetRgb && sourceAlpha == other.sourceAlpha &&
          targetAlpha == other.targetAlpha && equationRgb == other.equationRgb && equationAlpha == other.equationAlpha);
}

const char* SavedState::differentDrawing(const SavedState& before) const {
  if (drawFramebuffer_ != before.drawFramebuffer_) return "the draw framebuffer";
  if (!std::equal(viewport_, viewport_ + 4, before.viewport_)) return "the viewport";
  if (depthMask_ != before.depthMask_) return "the depth mask";
  if (enabled_[0] != before.enabled_[0]) return "the depth test";
  if (enabled_[0] && depthFunction_ != before.depthFunction_) return "the depth function";
  return nullptr;
}

const char* SavedState::differentPlace(const SavedState& before, int& place) const {
  for (place = 0; place < kDrawBuffers; ++place) {
    if (!blend_[place].blendsAs(before.blend_[place])) return "blending of draw buffer";
    if (!std::equal(blend_[place].mask, blend_[place].mask + 4, before.blend_[place].mask))
      return "the colour mask of draw buffer";
  }
  for (int i = 0; i < units_.count; ++i) {
    place = units_.first + i;
    if (before.textures_[i] == 0) continue;  // which the seam does not read
    if (textures_[i] != before.textures_[i]) return "the texture of the seam's unit";
    if (samplers_[i] != before.samplers_[i]) return "the sampler of the seam's unit";
  }
  place = uniformBinding_;
  if (place >= 0 && uniforms_.buffer != before.uniforms_.buffer) return "the uniform buffer at binding";
  for (int i = 0; i < storage_.count; ++i) {
    place = storage_.first + i;
    if (listed_[i].buffer != before.listed_[i].buffer) return "the storage buffer at binding";
  }
  return nullptr;
}

bool SavedState::differs(const SavedState& before, char* what, std::size_t size) const {
  if (const char* drawing = differentDrawing(before)) {
    std::snprintf(what, size, "%s", drawing);
    return true;
  }
  int place = 0;
  const char* thing = differentPlace(before, place);
  if (thing) std::snprintf(what, size, "%s %d", thing, place);
  return thing != nullptr;
}

void setViewportTo(const GlFunctions& gl, int x, int y, int width, int height) {
  const GLfloat v[4] = {static_cast<GLfloat>(x), static_cast<GLfloat>(y), static_cast<GLfloat>(width),
                        static_cast<GLfloat>(height)};
  setViewport(gl, v);
}

void setColourMask(const GlFunctions& gl, GLuint first, bool written) {
  const GLboolean allowed = written ? GL_TRUE : GL_FALSE;
  if (first == 0 && gl.fewBuffers) {
    gl.ColorMask(allowed, allowed, allowed, allowed);
    return;
  }
  for (GLuint i = first; i < kDrawBuffers; ++i) gl.ColorMaski(i, allowed, allowed, allowed, allowed);
}

void setAccumulation(const GlFunctions& gl, int width, int height) {
  setViewportTo(gl, 0, 0, width, height);
  setScissor(gl, false);
  for (int i = 0; i < kAccumulationSwitches; ++i) gl.Disable(kSwitches[i]);
  if (!gl.core) gl.Disable(kAlphaTest);
  gl.DepthMask(GL_FALSE);
  setColourMask(gl, 0, true);
  if (gl.fewBuffers)
    gl.Disable(GL_BLEND);
  else
    for (GLuint i = 0; i < kDrawBuffers; ++i) gl.Disablei(GL_BLEND, i);
}

void setPlainDrawing(const GlFunctions& gl, int width, int height) {
  setAccumulation(gl, width, height);
  for (std::size_t i = kAccumulationSwitches; i < std::size(kSwitches); ++i) gl.Disable(kSwitches[i]);
  if (!gl.core) gl.Disable(kPolygonStipple);
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace pellucid::c
