// Shadow maps of transparent casters: the host draws what a light sees, this library filters it and keeps it for
// lookups.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine_bridge/c/glsl_text.h"
#include "engine_bridge/c/pass.h"
#include "engine_bridge/c/textures.h"
#include "shaders/shadow_layout.h"

using namespace pellucid::c;
namespace shading = pellucid::shading;

namespace {

constexpr int kMostLights = 16, kMostCloser = 16;
constexpr float kRigid = 1e-3f;  // that a turn may be off

bool isFinite(const float* matrix) {
  return std::all_of(matrix, matrix + 16, [](float x) { return std::isfinite(x); });
}

bool isRigid(const float* m) {
  if (m[3] != 0.0f || m[7] != 0.0f || m[11] != 0.0f || m[15] != 1.0f) return false;
  const glm::mat3 turn(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
  const glm::mat3 one = glm::transpose(turn) * turn;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::fabs(one[c][r] - (c == r ? 1.0f : 0.0f)) < kRigid)) return false;
  return true;
}

glm::dmat4 matrixOf(const float* m) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<double>(m[i]);
  return matrix;
}

bool upperLeft(const GlFunctions& gl) {
  GLint origin = GL_LOWER_LEFT;
  if (gl.clipControl) gl.GetIntegerv(GL_CLIP_ORIGIN, &origin);
  return origin == GL_UPPER_LEFT;
}

// depth = x * (planar z, or distance) + y
glm::dvec2 metricOf(const pld_shadow_view& view) {
  const auto near = static_cast<double>(view.near_depth), far = static_cast<double>(view.far_depth);
  if (view.kind == PLD_LIGHT_LOCAL) return {1.0 / far, 0.0};
  return {2.0 / (far - near), -(far + near) / (far - near)};
}

}  // namespace

bool pld_pass::shadowIsFiltered() const {
  return shadowInfo_.form == PLD_SHADOW_VARIANCE || shadowInfo_.form == PLD_SHADOW_PUBLISHED;
}

int pld_pass::shadowEdge() const {
  return shadowIsFiltered() ? shadowInfo_.size / shading::PLD_SHADOW_DIVIDE : shadowInfo_.size;
}

pld_status pld_pass::checkShadowInfo(const pld_shadow_info& info) {
  if (info.struct_size != sizeof(pld_shadow_info))
    return fail(PLD_ERROR_VERSION, "pld_shadow_resize: info.struct_size: found %u, expected %zu", info.struct_size,
                sizeof(pld_shadow_info));
  if (info.form < PLD_SHADOW_VARIANCE || info.form > PLD_SHADOW_CORRECTED)
    return fail(PLD_ERROR_ARGUMENT, "pld_shadow_resize: found form %d, which pld_shadow_form does not have",
                static_cast<int>(info.form));
  const struct {
    const char* name;
    int value, least, most;
  } ranges[] = {{"lights", info.lights, 1, kMostLights},
                {"faces", info.faces, 1, kMostFaces},
                {"closer_edge", info.closer_edge, 1, kMostCloser}};
  for (const auto& range : ranges)
    if (range.value < range.least || range.value > range.most)
      return fail(PLD_ERROR_ARGUMENT, "pld_shadow_resize: %s: found %d, expected %d to %d", range.name, range.value,
                  range.least, range.most);
  GLint most = 0, layers = 0, bindings = 0, units = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  gl.GetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &bindings);
  gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  most = std::min(most, 16384);
  if (info.size < 16 || info.size > most || info.size % shading::PLD_SHADOW_DIVIDE != 0)
    return fail(PLD_ERROR_SIZE, "pld_shadow_resize: size: found %d, expected a multiple of %d from 16 to %d", info.size,
                shading::PLD_SHADOW_DIVIDE, most);
  if (info.faces * (info.coloured ? 3 : 1) > layers)
    return fail(PLD_ERROR_SIZE, "pld_shadow_resize: %d faces: this device's textures have %d layers", info.faces,
                layers);
  if (info.uniform_binding >= static_cast<uint32_t>(bindings) || info.texture_unit >= static_cast<uint32_t>(units))
    return fail(PLD_ERROR_ARGUMENT,
                "pld_shadow_resize: uniform_binding %u, texture_unit %u: the device has %d bindings, %d units",
                info.uniform_binding, info.texture_unit, bindings, units);
  if (info.uniform_binding == info_.uniform_binding ||
      info.texture_unit - info_.texture_unit < static_cast<uint32_t>(permutation_.seamUnits()))
    return fail(
        PLD_ERROR_ARGUMENT,
        "pld_shadow_resize: uniform_binding %u, texture_unit %u: expected others than the seam's, %u and %u to %u",
        info.uniform_binding, info.texture_unit, info_.uniform_binding, info_.texture_unit,
        info_.texture_unit + static_cast<uint32_t>(permutation_.seamUnits()) - 1);
  const int edge = info.form <= PLD_SHADOW_PUBLISHED ? info.size / shading::PLD_SHADOW_DIVIDE : info.size;
  if (static_cast<int64_t>(edge) * edge * info.faces * (info.coloured ? 3 : 1) > INT32_MAX)
    return fail(PLD_ERROR_SIZE, "pld_shadow_resize: %d faces of %d x %d texels: more than 2^31 - 1 together",
                info.faces, edge, edge);
  return PLD_OK;
}

void pld_pass::releaseShadows() {
  const auto release = [&](GLuint& name) {
    if (name) gl.DeleteTextures(1, &name);
    name = 0;
  };
  for (GLuint& one : shadowDrawn_) release(one);
  for (GLuint& one : shadowAcross_) release(one);
  release(shadowMaps_);
  for (GLuint* buffer : {&shadowTable_, &shadowUniforms_}) {
    if (*buffer) gl.DeleteBuffers(1, buffer);
    *buffer = 0;
  }
  for (GLuint* frame : {&casterFrame_, &acrossFrame_, &mapFrame_}) {
    if (*frame) gl.DeleteFramebuffers(1, frame);
    *frame = 0;
  }
  shadowTexels_.destroy(gl);
  shadowDown_.destroy(gl);
  viewShadow_.destroy(gl);
  std::fill(std::begin(shadowFaces_), std::end(shadowFaces_), FaceKind::empty);
  shadowBytes_ = 0;
  shadowInfo_ = {};
}

pld_status pld_pass::makeShadows() {
  const int size = shadowInfo_.size, edge = shadowEdge(), channels = shadowChannels();
  std::vector<std::string> defines;
  if (channels == 1) defines.emplace_back("GREY");
  const auto build = [&](Program& program, const char* filter) {
    std::vector<std::string> all = defines;
    all.emplace_back(filter);
    return program.build(gl, "gl/shadow_filter.frag", all);
  };
  std::string failure = build(shadowTexels_, shadowIsFiltered() ? "FILTER 1" : "FILTER 0");
  if (failure.empty() && shadowIsFiltered()) failure = build(shadowDown_, "FILTER 2");
  if (failure.empty() && (info_.flags & PLD_FLAG_DEBUG_VIEWS))
    failure = viewShadow_.build(gl, "gl/view_shadow.frag", {});
  if (!failure.empty()) return fail(PLD_ERROR_INTERNAL, "%s", failure.c_str());

  const uint64_t before = bytes_;
  const GLenum buffers[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  bool complete = true;
  const auto makeFrame = [&](GLuint& frame, GLuint* textures, int count, int width, int height) {
    gl.GenFramebuffers(1, &frame);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
    for (int i = 0; i < count; ++i) {
      textures[i] = makeTexture(GL_RGBA32F, width, height, 128);
      gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, textures[i], 0);
    }
    gl.DrawBuffers(count, buffers);
    complete = complete && gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  };
  makeFrame(casterFrame_, shadowDrawn_, channels == 1 ? 1 : 2, size, size);
  if (shadowIsFiltered()) makeFrame(acrossFrame_, shadowAcross_, channels, edge, size);

  GLint bound = 0;
  gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &bound);
  gl.GenTextures(1, &shadowMaps_);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, shadowMaps_);
  const int layers = shadowInfo_.faces * channels;
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, edge, edge, layers, 0, GL_RGBA, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, static_cast<GLuint>(bound));
  bytes_ += 16 * static_cast<uint64_t>(edge) * static_cast<uint64_t>(edge) * static_cast<uint64_t>(layers);
  gl.GenFramebuffers(1, &mapFrame_);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, mapFrame_);
  for (int c = 0; c < channels; ++c) gl.FramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, buffers[c], shadowMaps_, 0, c);
  gl.DrawBuffers(channels, buffers);
  complete = complete && gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  shadowBytes_ = bytes_ - before;
  bytes_ = before;

  // No light has a face yet.
  const std::vector<std::uint8_t> none(static_cast<std::size_t>(shadowInfo_.lights) * sizeof(shading::ShadowLight) +
                                       static_cast<std::size_t>(shadowInfo_.faces) * sizeof(shading::ShadowFace));
  gl.GenBuffers(1, &shadowTable_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, shadowTable_);
  gl.BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(none.size()), none.data(), GL_DYNAMIC_DRAW);
  gl.GenBuffers(1, &shadowUniforms_);
  gl.BindBuffer(GL_UNIFORM_BUFFER, shadowUniforms_);
  gl.BufferData(GL_UNIFORM_BUFFER, 8 * sizeof(GLfloat), nullptr, GL_DYNAMIC_DRAW);
  return complete ? PLD_OK : fail(PLD_ERROR_UNSUPPORTED, "pld_shadow_resize: this device cannot draw to RGBA32F");
}

pld_status pld_pass::shadowResize(const pld_shadow_info* info) {
  if (step_ == Step::open || shadowOpen_)
    return fail(PLD_ERROR_ORDER, "pld_shadow_resize: between a begin and its end");
  if (!info) {
    releaseShadows();
    return PLD_OK;
  }
  if (const pld_status status = checkShadowInfo(*info); status != PLD_OK) return status;
  if (shadowMaps_ && std::memcmp(info, &shadowInfo_, sizeof(*info)) == 0) return PLD_OK;
  while (const GLenum pending = gl.GetError()) {
    char text[100];
    std::snprintf(text, sizeof(text), "pld_shadow_resize: a GL error of the host was pending: 0x%x", pending);
    say(PLD_LOG_WARNING, text);
  }
  SavedState state;
  state.save(gl, {0, 1}, -1);
  GLint unpack = 0;
  gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.ActiveTexture(GL_TEXTURE0);
  releaseShadows();
  shadowInfo_ = *info;
  pld_status status = makeShadows();
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack));
  state.restore(gl);
  while (const GLenum error = gl.GetError()) {
    if (error == GL_OUT_OF_MEMORY)
      status = fail(PLD_ERROR_MEMORY, "pld_shadow_resize: the GL device has no room for %d faces of %d texels",
                    info->faces, info->size);
    else if (status == PLD_OK)
      status = fail(PLD_ERROR_INTERNAL, "pld_shadow_resize: GL error 0x%x", error);
  }
  if (status != PLD_OK) releaseShadows();
  return status;
}

pld_status pld_pass::checkShadowView(const pld_shadow_view& view, GLenum& attachment) {
  const char* const call = "pld_shadow_begin";
  if (view.struct_size != sizeof(pld_shadow_view))
    return fail(PLD_ERROR_VERSION, "%s: view.struct_size: found %u, expected %zu", call, view.struct_size,
                sizeof(pld_shadow_view));
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  if (!local && view.kind != PLD_LIGHT_DIRECTIONAL)
    return fail(PLD_ERROR_ARGUMENT, "%s: found kind %d, which pld_light does not have", call,
                static_cast<int>(view.kind));
  if (view.light < 0 || view.light >= shadowInfo_.lights)
    return fail(PLD_ERROR_ARGUMENT, "%s: light: found %d, expected 0 to %d", call, view.light, shadowInfo_.lights - 1);
  if (view.faces != 1 && !(view.faces == 6 && local))
    return fail(PLD_ERROR_ARGUMENT, "%s: faces: found %d, expected 1, or 6 of a local light", call, view.faces);
  if (view.first_face < 0 || view.first_face > shadowInfo_.faces - view.faces || view.face < 0 ||
      view.face >= view.faces)
    return fail(PLD_ERROR_ARGUMENT, "%s: face %d of %d from %d on: there is room for %d", call, view.face, view.faces,
                view.first_face, shadowInfo_.faces);
  if (!isFinite(view.light_from_scene) || !isRigid(view.light_from_scene))
    return fail(PLD_ERROR_ARGUMENT, "%s: light_from_scene: expected a turn and a shift, by columns", call);
  const float* p = view.projection;
  const bool perspective = p[3] == 0.0f && p[7] == 0.0f && p[11] == -1.0f && p[15] == 0.0f;
  const bool orthographic = p[3] == 0.0f && p[7] == 0.0f && p[11] == 0.0f && p[15] == 1.0f;
  if (!isFinite(p) || (local ? !perspective : !orthographic))
    return fail(PLD_ERROR_ARGUMENT, "%s: projection: expected %s, by columns", call,
                local ? "perspective with w = -z" : "orthographic");
  if (p[0] == 0.0f || p[5] == 0.0f) return fail(PLD_ERROR_ARGUMENT, "%s: projection: a focal length of 0", call);
  const float focal = std::fabs(p[0]);
  if (view.faces == 6 && (std::fabs(p[5]) != focal || p[8] != 0.0f || p[9] != 0.0f || !(focal > 0.5f && focal < 1.0f)))
    return fail(
        PLD_ERROR_ARGUMENT,
        "%s: projection of a cube's face: found focal lengths %g, %g, expected both the same, over .5 and below 1",
        call, static_cast<double>(p[0]), static_cast<double>(p[5]));
  if (!std::isfinite(view.near_depth) || !std::isfinite(view.far_depth) ||
      !(local ? view.far_depth > 0.0f : view.far_depth > view.near_depth))
    return fail(PLD_ERROR_ARGUMENT, "%s: near_depth %g, far_depth %g: expected near < far, of a local light far > 0",
                call, static_cast<double>(view.near_depth), static_cast<double>(view.far_depth));
  attachment = 0;
  if (view.depth_texture == 0) return PLD_OK;
  TextureFacts depth;
  if (!factsOf(gl, view.depth_texture, depth))
    return fail(PLD_ERROR_TEXTURE, "%s: depth_texture %u is no 2D texture of this context", call, view.depth_texture);
  attachment = depthAttachment(depth.format);
  if (attachment == 0)
    return fail(PLD_ERROR_FORMAT, "%s: depth_texture has format 0x%x, expected a depth format", call,
                static_cast<unsigned>(depth.format));
  if (depth.width < shadowInfo_.size || depth.height < shadowInfo_.size)
    return fail(PLD_ERROR_SIZE, "%s: depth_texture is %dx%d, expected at least %dx%d", call, depth.width, depth.height,
                shadowInfo_.size, shadowInfo_.size);
  return PLD_OK;
}

pld_status pld_pass::shadowBegin(const pld_shadow_view& view) {
  if (!shadowMaps_) return fail(PLD_ERROR_ORDER, "pld_shadow_begin: before pld_shadow_resize");
  if (shadowOpen_) return fail(PLD_ERROR_ORDER, "pld_shadow_begin: the last face has not met its pld_shadow_end");
  if (step_ == Step::open) return fail(PLD_ERROR_ORDER, "pld_shadow_begin: between pld_begin and pld_end");
  GLenum attachment = 0;
  if (const pld_status status = checkShadowView(view, attachment); status != PLD_OK) return status;
  const bool saves = !(info_.flags & PLD_FLAG_HOST_RESTORES);
  if (saves) saved_.save(gl, {0, 3}, static_cast<int>(info_.uniform_binding));
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, casterFrame_);
  if (attachment) {
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, view.depth_texture, 0);
    if (gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, 0, 0);
      if (saves) saved_.restore(gl);
      return fail(PLD_ERROR_FORMAT, "pld_shadow_begin: this device cannot test against depth_texture %u",
                  view.depth_texture);
    }
  }
  pushGroup("pellucid shadow");
  timers_.beginFace(gl);
  const bool naive = shadowInfo_.form == PLD_SHADOW_NAIVE || shadowInfo_.form == PLD_SHADOW_PUBLISHED;
  const glm::dvec2 metric = metricOf(view);
  GLfloat block[8] = {static_cast<float>(metric.x), static_cast<float>(metric.y),
                      view.kind == PLD_LIGHT_LOCAL ? 1.0f : 0.0f, naive ? 1.0f : 0.0f};
  const uint32_t seed = shading::mapSeedOf(shadowInfo_.seed, static_cast<uint32_t>(view.light),
                                           static_cast<uint32_t>(view.first_face + view.face));
  std::memcpy(&block[4], &seed, sizeof(seed));
  gl.BindBuffer(GL_UNIFORM_BUFFER, shadowUniforms_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), block);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, info_.uniform_binding, shadowUniforms_);
  setAccumulation(gl, shadowInfo_.size, shadowInfo_.size);
  const float far = shading::PLD_SHADOW_NOTHING;
  const GLfloat nothing[4] = {far, far, far, 0.0f}, none[4] = {0, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
  if (shadowDrawn_[1]) gl.ClearBufferfv(GL_COLOR, 1, none);
  for (GLuint i = 0; i < (shadowDrawn_[1] ? 2u : 1u); ++i) {
    gl.Enablei(GL_BLEND, i);
    gl.BlendFuncSeparatei(i, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(i, i == 0 ? GL_MIN : GL_FUNC_ADD, GL_FUNC_ADD);
  }
  if (attachment) {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(permutation_.depth == PLD_DEPTH_REVERSED ? GL_GEQUAL : GL_LEQUAL);
  }
  shadowDepthAttachment_ = attachment;
  shadowView_ = view;
  shadowRows_ = upperLeft(gl) ? -1.0 : 1.0;
  shadowOpen_ = true;
  return PLD_OK;
}

// Where the face's texels lie in the scene, for lookups.
void pld_pass::setShadowTable(const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  const int edge = shadowEdge(), channels = shadowChannels(), slot = view.first_face + view.face;
  const glm::dmat4 lightFromScene = matrixOf(view.light_from_scene), projection = matrixOf(view.projection);
  const double focal = std::min(std::fabs(projection[0][0]), std::fabs(projection[1][1]));
  shading::ShadowFace face =
      shading::shadowFaceOf(projection * lightFromScene, shadowInfo_.size, shading::shadowGrid(shadowIsFiltered()),
                            shadowRows_, view.faces == 1 ? 0.0 : 0.5 * (1.0 - focal));
  face.extent.x = slot * edge * edge * channels;
  face.extent.z = channels;

  const glm::dvec2 metric = metricOf(view);
  shading::ShadowLight light{};
  if (local) {
    light.metric = glm::vec4(glm::dvec4(glm::dvec3(glm::inverse(lightFromScene)[3]), metric.x));
  } else {
    for (int c = 0; c < 4; ++c)
      light.metric[c] = static_cast<float>(-metric.x * lightFromScene[c][2] + (c == 3 ? metric.y : 0.0));
  }
  light.faces = {view.first_face, view.faces, 0, 0};
  light.lookup = {shadowInfo_.form == PLD_SHADOW_VARIANCE    ? shading::PLD_SHADOW_SLAB
                  : shadowInfo_.form == PLD_SHADOW_PUBLISHED ? shading::PLD_SHADOW_CHEBYSHEV
                                                             : shading::PLD_SHADOW_CLOSER,
                  shadowInfo_.form == PLD_SHADOW_VARIANCE || shadowInfo_.form == PLD_SHADOW_CORRECTED ? 1 : 0,
                  shadowInfo_.closer_edge, local ? 1 : 0};
  if (shadowInfo_.form != PLD_SHADOW_PUBLISHED) {
    const glm::vec2 bias = shading::shadowBias(local, focal, shadowInfo_.size, metric.x);
    light.bias.z = bias.x;
    light.bias.w = bias.y;
  }
  gl.BindBuffer(GL_UNIFORM_BUFFER, shadowTable_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, static_cast<GLintptr>(sizeof(light)) * view.light, sizeof(light), &light);
  gl.BufferSubData(
      GL_UNIFORM_BUFFER,
      static_cast<GLintptr>(sizeof(light)) * shadowInfo_.lights + static_cast<GLintptr>(sizeof(face)) * slot,
      sizeof(face), &face);
}

void pld_pass::filterShadow(int face) {
  const int size = shadowInfo_.size, edge = shadowEdge(), channels = shadowChannels();
  setPlainDrawing(gl, edge, size);
  bind(0, shadowDrawn_[0]);
  if (shadowDrawn_[1]) bind(1, shadowDrawn_[1]);
  if (shadowIsFiltered()) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, acrossFrame_);
    useProgram(shadowTexels_);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    for (int c = 0; c < channels; ++c) bind(static_cast<GLuint>(c), shadowAcross_[c]);
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, mapFrame_);
  for (int c = 0; c < channels; ++c)
    gl.FramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(c), shadowMaps_, 0,
                               face * channels + c);
  setViewportTo(gl, 0, 0, edge, edge);
  useProgram(shadowIsFiltered() ? shadowDown_ : shadowTexels_);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

pld_status pld_pass::shadowEnd() {
  if (!shadowOpen_) return fail(PLD_ERROR_ORDER, "pld_shadow_end: without a pld_shadow_begin");
  if (shadowDepthAttachment_) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, casterFrame_);
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, shadowDepthAttachment_, GL_TEXTURE_2D, 0, 0);
  }
  filterShadow(shadowView_.first_face + shadowView_.face);
  setShadowTable(shadowView_);
  shadowFaces_[shadowView_.first_face + shadowView_.face] =
      shadowView_.kind == PLD_LIGHT_LOCAL ? FaceKind::local : FaceKind::directional;
  timers_.endFace(gl);
  if (!(info_.flags & PLD_FLAG_HOST_RESTORES)) saved_.restore(gl);
  popGroup();
  shadowOpen_ = false;
  return PLD_OK;
}

pld_status pld_pass::shadowText(pld_shadow_text which, int version, const char*& text) {
  if (which != PLD_SHADOW_TEXT_CASTER && which != PLD_SHADOW_TEXT_LOOKUP)
    return fail(PLD_ERROR_ARGUMENT, "pld_shadow_glsl: found text %d, which pld_shadow_text does not have",
                static_cast<int>(which));
  if (!shadowMaps_) return fail(PLD_ERROR_ORDER, "pld_shadow_glsl: before pld_shadow_resize");
  if (const pld_status status = checkGlsl("pld_shadow_glsl", version); status != PLD_OK) return status;
  std::string& kept = shadowTexts_[which];
  kept = which == PLD_SHADOW_TEXT_CASTER
             ? casterText(shadowInfo_.coloured != 0, version, {static_cast<int>(info_.uniform_binding), 0})
             : pellucid::c::shadowText(
                   {shadowInfo_.lights, shadowInfo_.faces, shadowEdge(), shadowChannels()}, version,
                   {static_cast<int>(shadowInfo_.uniform_binding), static_cast<int>(shadowInfo_.texture_unit)});
  text = kept.c_str();
  return PLD_OK;
}
