// A frame: begin, the host's draws, end, for every stage; then the resolve.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine_bridge/c/pass.h"
#include "engine_bridge/c/textures.h"

using namespace pellucid::c;

namespace {

bool isPositive(float x) {
  return x > 0.0f && std::isfinite(x);
}

constexpr uint32_t kEveryField = PLD_FIXED_UNITS | PLD_FIXED_EXPOSURE | PLD_FIXED_WEIGHT | PLD_FIXED_REFRACTION |
                                 PLD_FIXED_DIFFUSION | PLD_FIXED_PROJECTION | PLD_FIXED_LENS;
constexpr const char* kStageNames[] = {"pellucid solids", "pellucid front", "pellucid layers", "pellucid rims",
                                       "pellucid low resolution"};

}  // namespace

pld_status pld_pass::checkOrder(pld_stage stage) {
  if (shadowOpen_) return fail(PLD_ERROR_ORDER, "pld_begin: between pld_shadow_begin and pld_shadow_end");
  if (step_ == Step::sizeless) return fail(PLD_ERROR_ORDER, "pld_begin: before pld_resize");
  if (step_ == Step::open) return fail(PLD_ERROR_ORDER, "pld_begin: the last stage has not met its pld_end");
  if (stage < PLD_STAGE_SOLIDS || stage > PLD_STAGE_LOW)
    return fail(PLD_ERROR_ARGUMENT, "pld_begin: found stage %d, which pld_stage does not have",
                static_cast<int>(stage));
  const uint32_t needed = stagesNeeded(), bit = 1u << stage;
  if (!(needed & bit)) return fail(PLD_ERROR_ORDER, "pld_begin: this pass has no stage %d", static_cast<int>(stage));
  const uint32_t before = needed & (bit - 1);
  if (before != 0 && (stagesDone_ & before) != before)
    return fail(PLD_ERROR_ORDER, "pld_begin: stage %d comes after those before it", static_cast<int>(stage));
  if (before != 0 && (stagesDone_ & bit))
    return fail(PLD_ERROR_ORDER, "pld_begin: stage %d again in one frame", static_cast<int>(stage));
  return PLD_OK;
}

// The numbers of a frame; of those that `fields` (pld_fixed) names.
pld_status pld_pass::checkNumbers(const char* call, const pld_frame& frame, uint32_t fields) {
  const auto has = [&](pld_fixed field) { return (fields & static_cast<uint32_t>(field)) != 0; };
  if (has(PLD_FIXED_LENS) && (frame.width < 1 || frame.height < 1))
    return fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at least 1x1", call, frame.width, frame.height);
  if (has(PLD_FIXED_PROJECTION) || has(PLD_FIXED_LENS)) {
    for (const float x : frame.projection)
      if (!std::isfinite(x))
        return fail(PLD_ERROR_ARGUMENT, "%s: frame.projection holds a number that is not finite", call);
    if (!isPerspective(frame.projection) && !isOrthographic(frame.projection))
      return fail(PLD_ERROR_ARGUMENT,
                  "%s: frame.projection: expected perspective with w = -z, or orthographic, by columns", call);
    if (frame.projection[0] == 0.0f || frame.projection[5] == 0.0f)
      return fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length of 0", call);
  }
  // An orthographic lens is in pixels a metre.
  const bool units = has(PLD_FIXED_UNITS) || (has(PLD_FIXED_LENS) && isOrthographic(frame.projection));
  if ((units && !isPositive(frame.metres_per_unit)) || (has(PLD_FIXED_EXPOSURE) && !isPositive(frame.pre_exposure)))
    return fail(PLD_ERROR_ARGUMENT, "%s: metres_per_unit %g, pre_exposure %g: expected both > 0", call,
                static_cast<double>(frame.metres_per_unit), static_cast<double>(frame.pre_exposure));
  if (has(PLD_FIXED_LENS) && !(isPositive(focalOf(frame, 1).x) && isPositive(focalOf(frame, 1).y)))
    return fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length that is not finite in pixels", call);
  if (has(PLD_FIXED_WEIGHT) && (!isPositive(frame.weight_near) || !(frame.weight_far > frame.weight_near) ||
                                !std::isfinite(frame.weight_far) || !std::isfinite(frame.weight_exponent)))
    return fail(PLD_ERROR_ARGUMENT, "%s: weight range %g to %g, exponent %g: expected 0 < near < far and a number",
                call, static_cast<double>(frame.weight_near), static_cast<double>(frame.weight_far),
                static_cast<double>(frame.weight_exponent));
  if (has(PLD_FIXED_REFRACTION) && (frame.refract < PLD_REFRACT_NOTHING || frame.refract > PLD_REFRACT_THROUGH_SLAB))
    return fail(PLD_ERROR_ARGUMENT, "%s: found refract %d, which pld_refract does not have", call,
                static_cast<int>(frame.refract));
  if (!permutation_.scatters()) return PLD_OK;
  if ((has(PLD_FIXED_REFRACTION) && !isPositive(frame.refract_distance)) ||
      (has(PLD_FIXED_DIFFUSION) &&
       (!(frame.diffusion_k0 >= 0.0f) || !std::isfinite(frame.diffusion_k0) || !isPositive(frame.diffusion_k1))))
    return fail(PLD_ERROR_ARGUMENT,
                "%s: refract_distance %g, diffusion_k0 %g, diffusion_k1 %g: expected > 0, >= 0, > 0", call,
                static_cast<double>(frame.refract_distance), static_cast<double>(frame.diffusion_k0),
                static_cast<double>(frame.diffusion_k1));
  return PLD_OK;
}

// The first field that a frame has otherwise than fixed; null for none.
const char* pld_pass::changedField(const pld_frame& frame) const {
  const pld_frame& fixed = permutation_.fixed;
  const auto has = [&](pld_fixed field) { return (permutation_.fixedFields & static_cast<uint32_t>(field)) != 0; };
  if (has(PLD_FIXED_UNITS) && frame.metres_per_unit != fixed.metres_per_unit) return "metres_per_unit";
  if (has(PLD_FIXED_EXPOSURE) && frame.pre_exposure != fixed.pre_exposure) return "pre_exposure";
  if (has(PLD_FIXED_WEIGHT) && frame.weight_near != fixed.weight_near) return "weight_near";
  if (has(PLD_FIXED_WEIGHT) && frame.weight_far != fixed.weight_far) return "weight_far";
  if (has(PLD_FIXED_WEIGHT) && frame.weight_exponent != fixed.weight_exponent) return "weight_exponent";
  if (has(PLD_FIXED_REFRACTION) && frame.refract != fixed.refract) return "refract";
  if (has(PLD_FIXED_REFRACTION) && frame.refract_distance != fixed.refract_distance) return "refract_distance";
  if (has(PLD_FIXED_DIFFUSION) && frame.diffusion_k0 != fixed.diffusion_k0) return "diffusion_k0";
  if (has(PLD_FIXED_DIFFUSION) && frame.diffusion_k1 != fixed.diffusion_k1) return "diffusion_k1";
  if (has(PLD_FIXED_PROJECTION) && isOrthographic(frame.projection) != isOrthographic(fixed.projection))
    return "projection";
  if (has(PLD_FIXED_LENS) && (focalOf(frame, 1).x != focalOf(fixed, 1).x || focalOf(frame, 1).y != focalOf(fixed, 1).y))
    return "projection or size";
  return nullptr;
}

pld_status pld_pass::fix(const pld_frame& frame, uint32_t fields) {
  if (fields & ~kEveryField)
    return fail(PLD_ERROR_ARGUMENT, "pld_fix: fields hold a bit that this version does not have: 0x%x", fields);
  for (const std::string& text : seams_)
    if (!text.empty()) return fail(PLD_ERROR_ORDER, "pld_fix: after pld_glsl, whose text it changes");
  if (const pld_status status = checkNumbers("pld_fix", frame, fields); status != PLD_OK) return status;
  permutation_.fixed = frame;
  permutation_.fixedFields = fields;
  return PLD_OK;
}

pld_status pld_pass::checkFrame(const pld_frame& frame, bool isFirst, GLenum& attachment) {
  if (frame.width < 1 || frame.height < 1 || frame.width > width_ || frame.height > height_)
    return fail(PLD_ERROR_SIZE, "pld_begin: frame: found %dx%d, expected at most pld_resize()'s %dx%d", frame.width,
                frame.height, width_, height_);
  if (const pld_status status = checkNumbers("pld_begin", frame, kEveryField); status != PLD_OK) return status;
  if (const char* field = changedField(frame))
    return fail(PLD_ERROR_ARGUMENT, "pld_begin: frame.%s: found another than pld_fix() fixed", field);
  if (frame.colour_texture == frame.depth_texture)
    return fail(PLD_ERROR_TEXTURE, "pld_begin: colour_texture and depth_texture are one texture, %u",
                frame.depth_texture);

  TextureFacts colour, depth;
  if (!factsOf(gl, frame.colour_texture, colour))
    return fail(PLD_ERROR_TEXTURE, "pld_begin: colour_texture %u is no 2D texture of this context",
                frame.colour_texture);
  if (!factsOf(gl, frame.depth_texture, depth))
    return fail(PLD_ERROR_TEXTURE, "pld_begin: depth_texture %u is no 2D texture of this context", frame.depth_texture);
  if (!isColour(colour.format))
    return fail(PLD_ERROR_FORMAT, "pld_begin: colour_texture has format 0x%x, expected RGB or RGBA",
                static_cast<unsigned>(colour.format));
  attachment = permutation_.depth == PLD_DEPTH_LINEAR ? 0 : depthAttachment(depth.format);
  if (permutation_.depth == PLD_DEPTH_LINEAR ? !isLinearDepth(depth.format) : attachment == 0)
    return fail(PLD_ERROR_FORMAT, "pld_begin: depth_texture has format 0x%x, expected %s",
                static_cast<unsigned>(depth.format),
                permutation_.depth == PLD_DEPTH_LINEAR ? "a float colour format" : "a depth format");
  if (permutation_.low() && frame.low_factor != 2 && frame.low_factor != 4 && frame.low_factor != 8)
    return fail(PLD_ERROR_ARGUMENT, "pld_begin: low_factor: found %d, expected 2, 4 or 8", frame.low_factor);
  if (permutation_.low() && (frame.width % frame.low_factor != 0 || frame.height % frame.low_factor != 0))
    return fail(PLD_ERROR_SIZE, "pld_begin: frame: found %dx%d, expected multiples of low_factor %d", frame.width,
                frame.height, frame.low_factor);
  if (permutation_.rims()) {
    TextureFacts open;
    if (!factsOf(gl, frame.occlusion_texture, open))
      return fail(PLD_ERROR_TEXTURE, "pld_begin: occlusion_texture %u is no 2D texture of this context",
                  frame.occlusion_texture);
    if (!isOcclusion(open.format))
      return fail(PLD_ERROR_FORMAT, "pld_begin: occlusion_texture has format 0x%x, expected numbers in red",
                  static_cast<unsigned>(open.format));
    if (open.width < frame.width || open.height < frame.height)
      return fail(PLD_ERROR_SIZE, "pld_begin: occlusion_texture is %dx%d, expected at least the frame's %dx%d",
                  open.width, open.height, frame.width, frame.height);
    if (frame.occlusion < PLD_OCCLUSION_RELATIVE || frame.occlusion > PLD_OCCLUSION_PUBLISHED)
      return fail(PLD_ERROR_ARGUMENT, "pld_begin: found occlusion %d, which pld_occlusion does not have",
                  static_cast<int>(frame.occlusion));
  }
  if (colour.width < frame.width || colour.height < frame.height || depth.width < frame.width ||
      depth.height < frame.height)
    return fail(PLD_ERROR_SIZE,
                "pld_begin: colour_texture %dx%d, depth_texture %dx%d: expected at least the frame's %dx%d",
                colour.width, colour.height, depth.width, depth.height, frame.width, frame.height);
  if (!isFirst && (frame.width != frame_.width || frame.height != frame_.height))
    return fail(PLD_ERROR_SIZE, "pld_begin: found %dx%d, expected the %dx%d of this frame's first stage", frame.width,
                frame.height, frame_.width, frame_.height);
  return PLD_OK;
}

void pld_pass::setFrame(const pld_frame& frame, int pixelsATexel) {
  const bool orthographic = isOrthographic(frame.projection);
  const Focal focal = focalOf(frame, pixelsATexel);
  const GLfloat block[16] = {frame.metres_per_unit,
                             frame.pre_exposure,
                             orthographic ? 1.0f : 0.0f,
                             static_cast<float>(frame.occlusion),
                             frame.weight_near,
                             frame.weight_far,
                             frame.weight_exponent,
                             static_cast<float>(width_),
                             static_cast<float>(frame.refract),
                             frame.refract_distance,
                             focal.x,
                             focal.y,
                             frame.diffusion_k0,
                             frame.diffusion_k1,
                             static_cast<float>(frame.width),
                             static_cast<float>(frame.height)};
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), block);
}

void pld_pass::useProgram(const Program& program) {
  gl.UseProgram(program.name);
  gl.BindVertexArray(vertexArray_);
}

void pld_pass::drawPlanarDepth(const pld_frame& frame) {
  setPlainDrawing(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, planarFrame_);
  bind(0, frame.depth_texture);
  useProgram(planarDepth_);
  const float* p = frame.projection;
  gl.Uniform4f(planarDepth_.place(gl, "depthRows"), p[10], p[14], p[11], p[15]);
  gl.Uniform1f(planarDepth_.place(gl, "metresPerUnit"), frame.metres_per_unit);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

// Where clearing is slower, the layers' planes are filled as a picture is. See empty_planes.frag
void pld_pass::drawEmptyPlanes(const pld_frame& frame) {
  setPlainDrawing(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, layersFrame_);
  useProgram(emptyPlanes_);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

// The bound framebuffer's planes, empty.
void pld_pass::clearStage(pld_stage stage) {
  constexpr float far = std::numeric_limits<float>::infinity();
  const GLfloat nowhere[4] = {far, far, far, far}, noSolid[4] = {0, 0, 0, far}, infinitelyFar = 0.0f,
                none[4] = {0, 0, 0, 0};
  if ((stage == PLD_STAGE_LAYERS && !emptyPlanes_.name) || stage == PLD_STAGE_LOW)
    for (const Plane& plane : stage == PLD_STAGE_LOW ? low_ : planes_)
      gl.ClearBufferfv(GL_COLOR, static_cast<GLint>(plane.spec.attachment), plane.spec.clear);
  if (stage == PLD_STAGE_FRONT) gl.ClearBufferfv(GL_COLOR, 0, nowhere);
  for (GLint i = 0; stage == PLD_STAGE_RIMS && i < kRimPlanes; ++i) gl.ClearBufferfv(GL_COLOR, i, none);
  if (stage == PLD_STAGE_SOLIDS) {
    gl.DepthMask(GL_TRUE);
    gl.ClearBufferfv(GL_COLOR, 0, noSolid);
    gl.ClearBufferfv(GL_DEPTH, 0, &infinitelyFar);
  }
}

void pld_pass::blend(GLuint i, BlendKind kind) {
  gl.Enablei(GL_BLEND, i);
  const bool product = kind == BlendKind::product;
  gl.BlendFuncSeparatei(i, product ? GL_ZERO : GL_ONE, product ? GL_ONE_MINUS_SRC_COLOR : GL_ONE, GL_ONE, GL_ONE);
  gl.BlendEquationSeparatei(i, kind == BlendKind::minimum ? GL_MIN : GL_FUNC_ADD,
                            kind == BlendKind::minimum || kind == BlendKind::alphaMinimum ? GL_MIN : GL_FUNC_ADD);
}

void pld_pass::openStage(pld_stage stage, GLuint occlusion) {
  if (permutation_.exact())
    openLists();
  else if (stage == PLD_STAGE_LAYERS || stage == PLD_STAGE_LOW)
    for (const Plane& plane : stage == PLD_STAGE_LOW ? low_ : planes_) blend(plane.spec.attachment, plane.spec.blend);
  if (stage == PLD_STAGE_FRONT) blend(0, BlendKind::minimum);
  for (GLuint i = 0; stage == PLD_STAGE_RIMS && !permutation_.exact() && i < kRimPlanes; ++i) blend(i, BlendKind::add);
  if (stage == PLD_STAGE_SOLIDS && !permutation_.exact()) {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
  } else if (permutation_.depth != PLD_DEPTH_LINEAR && stage != PLD_STAGE_LOW && stage != PLD_STAGE_SOLIDS) {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(permutation_.depth == PLD_DEPTH_REVERSED ? GL_GEQUAL : GL_LEQUAL);
  }
  bind(info_.texture_unit, stage == PLD_STAGE_LOW ? lowFarZ_ : planarZ_);
  bind(info_.texture_unit + 1, solid_);
  bind(info_.texture_unit + 2, frontZ_);
  if (permutation_.rimsInSeam()) bind(info_.texture_unit + 3, occlusion);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, info_.uniform_binding, uniforms_);
}

pld_status pld_pass::begin(pld_stage stage, const pld_frame& frame) {
  if (const pld_status status = checkOrder(stage); status != PLD_OK) return status;
  GLenum attachment = 0;
  const bool first = (stagesNeeded() & ((1u << stage) - 1)) == 0;
  if (const pld_status status = checkFrame(frame, first, attachment); status != PLD_OK) return status;
  const bool saves = !(info_.flags & PLD_FLAG_HOST_RESTORES);
  // Unit 0 is used by the depth pass, the seam's units by the stage; rims are darkened from six, layers of low
  // resolution resolved from eleven.
  const auto seamUnit = static_cast<int>(info_.texture_unit);
  if (saves)
    saved_.save(gl,
                {0, std::max(seamUnit + permutation_.seamUnits(), stage == PLD_STAGE_RIMS  ? 6
                                                                  : stage == PLD_STAGE_LOW ? 11
                                                                                           : 0)},
                static_cast<int>(info_.uniform_binding), storageOf());
  const GLuint target = frameOf(stage);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  frameDepthAttachment_ = stage == PLD_STAGE_SOLIDS || stage == PLD_STAGE_LOW ? 0 : attachment;
  if (frameDepthAttachment_) {
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, frameDepthAttachment_, GL_TEXTURE_2D, frame.depth_texture, 0);
    if (gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, frameDepthAttachment_, GL_TEXTURE_2D, 0, 0);
      if (saves) saved_.restore(gl);
      return fail(PLD_ERROR_FORMAT, "pld_begin: this device cannot test against depth_texture %u", frame.depth_texture);
    }
  }
  pushGroup(kStageNames[stage]);
  if (first) {
    timers_.nextFrame();
    stagesDone_ = 0;
    fragments_ = 0;
  }
  timers_.mark(gl, Timers::markOf(stage, 0));
  const bool low = stage == PLD_STAGE_LOW, planar = first && permutation_.planarDepth(),
             empties = stage == PLD_STAGE_LAYERS && emptyPlanes_.name;
  setFrame(frame, low ? frame.low_factor : 1);
  if (planar) drawPlanarDepth(frame);
  if (low) drawLowDepth(frame);
  if (empties) drawEmptyPlanes(frame);
  if (planar || low || empties) {
    if (saves) saved_.restoreForDraws(gl);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  }
  setAccumulation(gl, frame.width / (low ? frame.low_factor : 1), frame.height / (low ? frame.low_factor : 1));
  if (!permutation_.exact()) clearStage(stage);
  openStage(stage, frame.occlusion_texture);
  if (saves) saved_.restoreActiveUnit(gl);
  timers_.mark(gl, Timers::markOf(stage, 1));
  frame_ = frame;
  stage_ = stage;
  step_ = Step::open;
  return PLD_OK;
}

GLuint pld_pass::frameOf(pld_stage stage) const {
  switch (stage) {
    case PLD_STAGE_SOLIDS:
      return solidFrame_;
    case PLD_STAGE_FRONT:
      return frontFrame_;
    case PLD_STAGE_RIMS:
      return rimsFrame_;
    case PLD_STAGE_LOW:
      return lowFrame_;
    default:
      return layersFrame_;
  }
}

// From the sums that the layers have left.
pld_status pld_pass::darkenRims() {
  TextureFacts facts;
  if (!factsOf(gl, frame_.occlusion_texture, facts) || facts.width < frame_.width || facts.height < frame_.height)
    return fail(PLD_ERROR_TEXTURE, "pld_end: occlusion_texture %u is no longer what pld_begin saw",
                frame_.occlusion_texture);
  setPlainDrawing(gl, frame_.width, frame_.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, layersFrame_);
  for (GLuint i = 0; i < kDrawBuffers; ++i) {
    const bool holds = i == 0 || (i == 4 && permutation_.light());
    gl.ColorMaski(i, holds, holds, holds, GL_FALSE);
    if (!holds) continue;
    gl.Enablei(GL_BLEND, i);
    gl.BlendFuncSeparatei(i, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(i, GL_FUNC_REVERSE_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT);
  }
  for (GLuint i = 0; i < kRimPlanes; ++i) bind(i, rims_[i]);
  bind(3, planarZ_);
  bind(4, frame_.occlusion_texture);
  if (solid_) bind(5, solid_);
  useProgram(rimsApply_);
  gl.Uniform2i(rimsApply_.place(gl, "pictureSize"), frame_.width, frame_.height);
  gl.Uniform1i(rimsApply_.place(gl, "form"), static_cast<GLint>(frame_.occlusion));
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  return PLD_OK;
}

pld_status pld_pass::end() {
  if (step_ != Step::open) return fail(PLD_ERROR_ORDER, "pld_end: without a pld_begin");
  if (frameDepthAttachment_) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frameOf(stage_));
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, frameDepthAttachment_, GL_TEXTURE_2D, 0, 0);
  }
  pld_status status = permutation_.exact() ? foldLists() : PLD_OK;
  const bool whole = status == PLD_OK;
  if (whole && stage_ == PLD_STAGE_RIMS) status = darkenRims();
  if (whole && stage_ == PLD_STAGE_LOW) addLow();
  timers_.mark(gl, Timers::markOf(stage_, 2));
  if (!(info_.flags & PLD_FLAG_HOST_RESTORES)) saved_.restore(gl);
  popGroup();
  if (whole) stagesDone_ |= 1u << stage_;
  step_ = Step::drawn;
  return status;
}

// A texel of one level reads those of the one below it, of the same textures: a barrier lies between the draws.
void pld_pass::drawPyramid() {
  layOutPyramid(frame_.width, frame_.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, spreadFrame_);
  useProgram(spreadLevel_);
  gl.Uniform4iv(spreadLevel_.place(gl, "spreadLevels"), kLevels, &levels_[0][0]);
  gl.Uniform2i(spreadLevel_.place(gl, "pictureSize"), frame_.width, frame_.height);
  const GLint level = spreadLevel_.place(gl, "level");
  for (int k = 1; k <= levelCount_; ++k) {
    setViewportTo(gl, 0, levels_[k][2], levels_[k][0], levels_[k][1]);
    gl.Uniform1i(level, k);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.TextureBarrier();
  }
}

pld_status pld_pass::resolve(const pld_target& target) {
  if (shadowOpen_) return fail(PLD_ERROR_ORDER, "pld_resolve: between pld_shadow_begin and pld_shadow_end");
  if (isOfShadows(target.view)) return resolveShadow(target);
  if (step_ != Step::drawn || stagesDone_ != stagesNeeded())
    return fail(PLD_ERROR_ORDER, "pld_resolve: before all stages of a frame have met their pld_end");
  if (const pld_status status = checkView(target); status != PLD_OK) return status;
  TextureFacts colour;
  if (!factsOf(gl, frame_.colour_texture, colour) || colour.width < frame_.width || colour.height < frame_.height)
    return fail(PLD_ERROR_TEXTURE, "pld_resolve: colour_texture %u is no longer what pld_begin saw",
                frame_.colour_texture);
  if (const pld_status status = checkTarget(target, frame_.width, frame_.height, frame_.colour_texture);
      status != PLD_OK)
    return status;

  const bool saves = !(info_.flags & PLD_FLAG_HOST_RESTORES);
  if (saves) saved_.save(gl, unitsOf(), -1);
  if (const pld_status status = bindTarget(target, frame_.colour_texture); status != PLD_OK) {
    if (saves) saved_.restore(gl);
    return status;
  }
  pushGroup("pellucid resolve");
  timers_.mark(gl, Timers::kResolve);
  setPlainDrawing(gl, frame_.width, frame_.height);
  for (GLuint i = 1; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  bind(0, frame_.colour_texture);
  for (const Plane& plane : planes_) bind(plane.spec.unit, plane.texture);
  if (planarZ_) bind(5, planarZ_);
  if (solid_) bind(6, solid_);
  if (permutation_.lowOver())
    for (GLuint i = 0; i < 2; ++i) bind(11 + i, lowOver_[i]);
  if (levelCount_ > 0 && !isOfParts(target.view)) {
    for (GLuint i = 0; i < kSpreadPlanes; ++i) bind(11 + i, spread_[i]);
    for (GLuint i = 1; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    drawPyramid();
    setPlainDrawing(gl, frame_.width, frame_.height);
    for (GLuint i = 1; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targetFrame(target));
  }
  if (isOfParts(target.view)) {
    drawPart(target.view);
  } else {
    const Program& program = target.view == PLD_VIEW_PICTURE ? picture_ : view_;
    useProgram(program);
    gl.Uniform2i(program.place(gl, "pictureSize"), frame_.width, frame_.height);
    gl.Uniform1i(program.place(gl, "view"), static_cast<GLint>(target.view));
    gl.Uniform3i(program.place(gl, "lookup"), 0, 0, levelCount_);
    gl.Uniform1f(program.place(gl, "largestSpread"),
                 std::hypot(static_cast<float>(frame_.width), static_cast<float>(frame_.height)));
    if (levelCount_ > 0) gl.Uniform4iv(program.place(gl, "spreadLevels"), kLevels, &levels_[0][0]);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  unbindTarget(target);
  if (saves) saved_.restore(gl);
  popGroup();
  timers_.mark(gl, Timers::kResolved);
  // Views of the same planes may follow; the next frame begins with its first stage.
  return PLD_OK;
}
