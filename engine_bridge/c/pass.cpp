#include "engine_bridge/c/pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "engine_bridge/c/glsl_text.h"

using namespace pellucid::c;

pld_status pld_pass::fail(pld_status status, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, sizeof(message), format, arguments);
  va_end(arguments);
  say(PLD_LOG_ERROR, message);
  return status;
}

void pld_pass::say(pld_log_level level, const char* text) const {
  if (info_.log) info_.log(info_.log_user, level, text);
}

// A framebuffer is never shared between contexts, and ours has a label that no other has.
bool pld_pass::isCurrent() const {
  if (!gl.GetObjectLabel) return gl.IsFramebuffer(targetFrame_) == GL_TRUE;
  char label[sizeof(label_)] = {};
  if (gl.IsFramebuffer(targetFrame_) != GL_TRUE) return false;
  gl.GetObjectLabel(GL_FRAMEBUFFER, targetFrame_, sizeof(label), nullptr, label);
  return std::strcmp(label, label_) == 0;
}

uint32_t pld_pass::stagesNeeded() const {
  return (permutation_.has(PLD_FEATURE_SOLIDS) ? 1u << PLD_STAGE_SOLIDS : 0u) |
         (permutation_.rimsApart() ? 1u << PLD_STAGE_RIMS : 0u) | (permutation_.low() ? 1u << PLD_STAGE_LOW : 0u) |
         (permutation_.frontStage() ? 1u << PLD_STAGE_FRONT : 0u) | 1u << PLD_STAGE_LAYERS;
}

Units pld_pass::unitsOf() const {
  const bool views = permutation_.rimsApart() && (info_.flags & PLD_FLAG_DEBUG_VIEWS);
  return {0, permutation_.scatters() || permutation_.lowOver() || views ? 16 : 11};
}

void pld_pass::pushGroup(const char* name) {
  if ((info_.flags & PLD_FLAG_DEBUG_GROUPS) && gl.PushDebugGroup)
    gl.PushDebugGroup(GL_DEBUG_SOURCE_THIRD_PARTY, 0, -1, name);
}

void pld_pass::popGroup() {
  if ((info_.flags & PLD_FLAG_DEBUG_GROUPS) && gl.PushDebugGroup) gl.PopDebugGroup();
}

void pld_pass::bind(GLuint unit, GLuint texture) {
  gl.ActiveTexture(GL_TEXTURE0 + unit);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.BindSampler(unit, sampler_);
}

pld_status pld_pass::makePrograms() {
  std::string failure;
  const auto build = [&](Program& program, const char* file, const std::vector<std::string>& defines) {
    if (failure.empty()) failure = program.build(gl, file, defines);
  };
  const std::vector<std::string> defines = resolveDefines(permutation_);
  build(picture_, "gl/picture.frag", defines);
  if (gl.onProcessor && permutation_.tier == PLD_TIER_FLOAT)
    build(emptyPlanes_, "gl/empty_planes.frag", emptyDefines(planesOf(permutation_)));
  if (permutation_.planarDepth())
    build(planarDepth_, "gl/planar_depth.frag", depthDefines(permutation_.depth, info_.clip));
  if (permutation_.has(PLD_FEATURE_DIFFUSION)) build(spreadLevel_, "gl/spread_level.frag", defines);
  if (permutation_.rimsApart()) build(rimsApply_, "gl/rims_apply.frag", defines);
  if (permutation_.low() && failure.empty()) failure = buildLowPrograms();
  if (failure.empty()) failure = buildViewPrograms();
  if (permutation_.exact() && failure.empty()) failure = buildFolds();
  return failure.empty() ? PLD_OK : fail(PLD_ERROR_INTERNAL, "%s", failure.c_str());
}

pld_status pld_pass::create(const pld_create_info& info) {
  info_ = info;
  const std::string missing = load(info.get_proc_address, info.get_proc_address_user, gl);
  if (!missing.empty())
    return fail(missing.find("no context") != std::string::npos ? PLD_ERROR_CONTEXT : PLD_ERROR_UNSUPPORTED,
                "pld_create: expected %s", missing.c_str());
  permutation_.method = info.method;
  permutation_.tier = info.tier;
  permutation_.features = info.features;
  constexpr uint32_t lightByItself = PLD_VERSION_MAJOR << 20 | 4 << 10;
  if (info.version < lightByItself && permutation_.scatters()) permutation_.features |= PLD_FEATURE_LIGHT;
  permutation_.weight = info.weight;
  permutation_.depth = info.depth;
  permutation_.rows = info.rows;
  const std::string conflict = conflictOf(permutation_);
  if (!conflict.empty()) return fail(PLD_ERROR_UNSUPPORTED, "pld_create: %s", conflict.c_str());
  if (permutation_.has(PLD_FEATURE_DIFFUSION) && !gl.TextureBarrier)
    return fail(PLD_ERROR_UNSUPPORTED, "pld_create: PLD_FEATURE_DIFFUSION needs OpenGL 4.5 or GL_ARB_texture_barrier");
  GLint bindings = 0, units = 0, drawBuffers = 0;
  gl.GetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &bindings);
  gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  gl.GetIntegerv(GL_MAX_DRAW_BUFFERS, &drawBuffers);
  const int lastUnit = std::min(units, kMostUnits) - permutation_.seamUnits();
  if (info.uniform_binding >= static_cast<uint32_t>(bindings) || lastUnit < 0 ||
      info.texture_unit > static_cast<uint32_t>(lastUnit))
    return fail(PLD_ERROR_ARGUMENT, "pld_create: uniform_binding %u, texture_unit %u: expected below %d and at most %d",
                info.uniform_binding, info.texture_unit, bindings, lastUnit);
  if (drawBuffers < kDrawBuffers)
    return fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d draw buffers, expected %d", drawBuffers, kDrawBuffers);
  if (permutation_.exact())
    if (const pld_status status = checkLists(info); status != PLD_OK) return status;
  while (const GLenum pending = gl.GetError()) {
    char text[100];
    std::snprintf(text, sizeof(text), "pld_create: a GL error of the host was pending: 0x%x", pending);
    say(PLD_LOG_WARNING, text);
  }
  SavedState state;
  state.save(gl, {0, 0}, -1);
  gl.GenVertexArrays(1, &vertexArray_);
  gl.GenBuffers(1, &uniforms_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferData(GL_UNIFORM_BUFFER, 16 * sizeof(GLfloat), nullptr, GL_DYNAMIC_DRAW);
  gl.GenSamplers(1, &sampler_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.SamplerParameteri(sampler_, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.SamplerParameteri(sampler_, wrap, GL_CLAMP_TO_EDGE);
  gl.SamplerParameteri(sampler_, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_, &spreadFrame_, &rimsFrame_,
                        &lowFrame_, &lowDepthFrame_, &lowTexelFrame_, &lowOverFrame_, &targetFrame_}) {
    gl.GenFramebuffers(1, frame);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, *frame);
  }
  if (gl.ObjectLabel) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    std::snprintf(label_, sizeof(label_), "pellucid %p %lld", static_cast<void*>(this), static_cast<long long>(now));
    gl.ObjectLabel(GL_FRAMEBUFFER, targetFrame_, -1, label_);
  }
  if (info.flags & PLD_FLAG_TIMERS) timers_.create(gl);
  for (const PlaneSpec& spec : planesOf(permutation_)) planes_.push_back({spec, 0});
  if (permutation_.low())
    for (const PlaneSpec& spec : lowPlanes()) low_.push_back({spec, 0});
  pld_status status = makePrograms();
  state.restore(gl);
  bool outOfMemory = false;
  while (const GLenum error = gl.GetError()) {
    outOfMemory = outOfMemory || error == GL_OUT_OF_MEMORY;
    if (status == PLD_OK && !outOfMemory) status = fail(PLD_ERROR_INTERNAL, "pld_create: GL error 0x%x", error);
  }
  if (outOfMemory) status = fail(PLD_ERROR_MEMORY, "pld_create: the GL device has no room");
  return status;
}

void pld_pass::destroyObjects() {
  releaseTextures();
  releaseShadows();
  timers_.destroy(gl);
  for (Program* program : {&emptyPlanes_, &planarDepth_, &picture_, &view_, &spreadLevel_, &rimsApply_, &lowDepth_,
                           &lowTexel_, &upsample_, &viewRims_, &viewLow_})
    program->destroy(gl);
  for (Program& program : folds_) program.destroy(gl);
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_, &spreadFrame_, &rimsFrame_,
                        &lowFrame_, &lowDepthFrame_, &lowTexelFrame_, &lowOverFrame_, &targetFrame_})
    if (*frame) gl.DeleteFramebuffers(1, frame);
  if (vertexArray_) gl.DeleteVertexArrays(1, &vertexArray_);
  if (sampler_) gl.DeleteSamplers(1, &sampler_);
  if (uniforms_) gl.DeleteBuffers(1, &uniforms_);
}

pld_status pld_pass::query(pld_value what, uint64_t& value) {
  switch (what) {
    case PLD_VALUE_BITS_PER_PIXEL:
      value = 0;
      for (const Plane& plane : planes_) value += static_cast<uint64_t>(plane.spec.bits);
      return PLD_OK;
    case PLD_VALUE_BYTES:
      value = bytes_;
      return PLD_OK;
    case PLD_VALUE_PLANES:
      value = planes_.size();
      return PLD_OK;
    case PLD_VALUE_GEOMETRY_PASSES:
      value = 1u + (permutation_.frontStage() ? 1u : 0u) + (permutation_.has(PLD_FEATURE_SOLIDS) ? 1u : 0u) +
              (permutation_.rimsApart() ? 1u : 0u);
      return PLD_OK;
    case PLD_VALUE_NS_BEGIN:
    case PLD_VALUE_NS_DRAWS:
    case PLD_VALUE_NS_RESOLVE:
      if (!timers_.on()) return fail(PLD_ERROR_UNSUPPORTED, "pld_query: times need PLD_FLAG_TIMERS");
      if (!timers_.read(gl, what, value)) return fail(PLD_ERROR_ORDER, "pld_query: no frame's times are known yet");
      return PLD_OK;
    case PLD_VALUE_NS_SHADOW:
      if (!timers_.on()) return fail(PLD_ERROR_UNSUPPORTED, "pld_query: times need PLD_FLAG_TIMERS");
      if (!timers_.readFace(gl, value)) return fail(PLD_ERROR_ORDER, "pld_query: no face's time is known yet");
      return PLD_OK;
    case PLD_VALUE_FRAGMENTS:
    case PLD_VALUE_FRAGMENT_ROOM:
      if (!permutation_.exact())
        return fail(PLD_ERROR_UNSUPPORTED, "pld_query: fragments are counted in PLD_TIER_EXACT alone");
      value = what == PLD_VALUE_FRAGMENTS ? fragments_ : room_;
      return PLD_OK;
    case PLD_VALUE_SHADOW_TEXTURE:
      value = shadowMaps_;
      return PLD_OK;
    case PLD_VALUE_SHADOW_BUFFER:
      value = shadowTable_;
      return PLD_OK;
    case PLD_VALUE_SHADOW_BYTES:
      value = shadowBytes_;
      return PLD_OK;
    default:
      break;
  }
  const int plane = static_cast<int>(what) - static_cast<int>(PLD_VALUE_FIRST_PLANE);
  if (plane < 0 || plane >= kDrawBuffers)
    return fail(PLD_ERROR_ARGUMENT, "pld_query: found value %d, which pld_value does not have", static_cast<int>(what));
  value = 0;
  for (const Plane& one : planes_)
    if (one.spec.attachment == static_cast<GLuint>(plane)) value = one.texture;
  return PLD_OK;
}

pld_status pld_pass::checkGlsl(const char* call, int version) {
  static constexpr int versions[] = {330, 400, 410, 420, 430, 440, 450, 460};
  for (const int one : versions)
    if (one == version) return PLD_OK;
  return fail(PLD_ERROR_ARGUMENT, "%s: found version %d, expected 330 to 460 as GLSL has them", call, version);
}

pld_status pld_pass::seam(pld_stage stage, int version, const char*& text) {
  if (stage < PLD_STAGE_SOLIDS || stage > PLD_STAGE_LOW || !(stagesNeeded() & (1u << stage)))
    return fail(PLD_ERROR_ARGUMENT, "pld_glsl: this pass has no stage %d", static_cast<int>(stage));
  if (const pld_status status = checkGlsl("pld_glsl", version); status != PLD_OK) return status;
  if (permutation_.exact() && version < 430)
    return fail(PLD_ERROR_UNSUPPORTED,
                "pld_glsl: found version %d, expected 430 or later: the exact tier writes to storage buffers", version);
  std::string& kept = seams_[stage];
  kept = seamText(permutation_, stage, version,
                  {static_cast<int>(info_.uniform_binding), static_cast<int>(info_.texture_unit),
                   static_cast<int>(info_.storage_binding)});
  text = kept.c_str();
  return PLD_OK;
}

pld_status pld_pass::connect(GLuint program) {
  GLint linked = GL_FALSE;
  if (gl.IsProgram(program)) gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked)
    return fail(PLD_ERROR_ARGUMENT, "pld_connect: found %u, expected a linked program of this context", program);
  const std::pair<const char*, GLuint> blocks[] = {{"PldFrame", info_.uniform_binding},
                                                   {"PldShadowFrame", info_.uniform_binding},
                                                   {"PldShadows", shadowInfo_.uniform_binding}};
  for (const auto& [name, binding] : blocks) {
    const GLuint block = gl.GetUniformBlockIndex(program, name);
    if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program, block, binding);
  }
  GLint current = 0;
  gl.GetIntegerv(GL_CURRENT_PROGRAM, &current);
  gl.UseProgram(program);
  const char* names[] = {"pldOpaqueZ", "pldSolid", "pldFrontZ", "pldOpaqueOpen"};
  for (GLint i = 0; i < permutation_.seamUnits(); ++i) {
    const GLint place = gl.GetUniformLocation(program, names[i]);
    if (place >= 0) gl.Uniform1i(place, static_cast<GLint>(info_.texture_unit) + i);
  }
  const GLint maps = gl.GetUniformLocation(program, "pldShadowMaps");
  if (maps >= 0) gl.Uniform1i(maps, static_cast<GLint>(shadowInfo_.texture_unit));
  // One that the host has deleted while it was current is gone now.
  gl.UseProgram(current && gl.IsProgram(static_cast<GLuint>(current)) ? static_cast<GLuint>(current) : 0);
  return PLD_OK;
}
