#include "engine_bridge/c/stages.h"

#include <algorithm>

#include "engine_bridge/c/recipe_numbers.h"
#include "shaders/plane_defines.h"

namespace pellucid::c {
namespace {

constexpr const char* kNames[] = {"pellucid solids", "pellucid front", "pellucid layers", "pellucid rims",
                                  "pellucid low resolution"};

}  // namespace

void Stages::create() {
  device_.gl.GenBuffers(1, &uniforms_);
  device_.gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  device_.gl.BufferData(GL_UNIFORM_BUFFER, kSeamFloats * sizeof(GLfloat), nullptr, GL_DYNAMIC_DRAW);
}

std::string Stages::build() {
  const Permutation& p = device_.permutation;
  std::string failure;
  if (device_.gl.onProcessor && p.tier == PLD_TIER_FLOAT)
    failure = emptyPlanes_.build(device_.gl, "gl/empty_planes.frag", emptyDefines(modelOf(p)));
  if (failure.empty() && p.planarDepth())
    failure = planarDepth_.build(device_.gl, "gl/planar_depth.frag", depthDefines(p.depth, device_.info.clip));
  return failure;
}

void Stages::destroy() {
  emptyPlanes_.destroy(device_.gl);
  planarDepth_.destroy(device_.gl);
  if (uniforms_) device_.gl.DeleteBuffers(1, &uniforms_);
}

GLuint Stages::frameOf(pld_stage stage) const {
  switch (stage) {
    case PLD_STAGE_SOLIDS:
      return planes_.solidFrame();
    case PLD_STAGE_FRONT:
      return planes_.frontFrame();
    case PLD_STAGE_RIMS:
      return rims_.frame();
    case PLD_STAGE_LOW:
      return low_.frame();
    default:
      return planes_.layersFrame();
  }
}

const std::vector<Plane>& Stages::planesOf(pld_stage stage) const {
  switch (stage) {
    case PLD_STAGE_SOLIDS:
      return planes_.solids();
    case PLD_STAGE_FRONT:
      return planes_.front();
    case PLD_STAGE_RIMS:
      return rims_.planes();
    case PLD_STAGE_LOW:
      return low_.planes();
    default:
      return planes_.layers();
  }
}

// Unit 0 is used by the depth pass, the seam's units by the stage; rims are darkened from six, layers of low resolution
// resolved from eleven.
Units Stages::unitsOf(pld_stage stage) const {
  const int ends = stage == PLD_STAGE_RIMS ? 6 : stage == PLD_STAGE_LOW ? 11 : 0;
  return {0, std::max(static_cast<int>(device_.info.texture_unit) + device_.permutation.seamUnits(), ends)};
}

void Stages::setFrame(const pld_frame& frame, int width, int pixelsATexel) const {
  float block[kSeamFloats];
  fillSeam({device_.permutation, frame, width, 1}, pixelsATexel, block);
  device_.gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  device_.gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), block);
}

void Stages::drawPlanarDepth(const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  setPlainDrawing(gl, frame.width, frame.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, planes_.planarFrame());
  device_.bind(0, frame.depth_texture);
  device_.use(planarDepth_);
  const float* p = frame.projection;
  gl.Uniform4f(planarDepth_.place(gl, "depthRows"), p[10], p[14], p[11], p[15]);
  gl.Uniform1f(planarDepth_.place(gl, "metresPerUnit"), frame.metres_per_unit);
  device_.drawEverywhere();
}

// Where clearing is slower, the layers' planes are filled as a picture is. See empty_planes.frag
void Stages::drawEmptyPlanes(const pld_frame& frame) const {
  setPlainDrawing(device_.gl, frame.width, frame.height);
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, planes_.layersFrame());
  device_.use(emptyPlanes_);
  device_.drawEverywhere();
}

// The bound framebuffer's planes, empty.
void Stages::clear() const {
  const GlFunctions& gl = device_.gl;
  const GLfloat infinitelyFar = 0.0f;
  if (stage_ != PLD_STAGE_LAYERS || !emptyPlanes_.name) clearPlanes(gl, planesOf(stage_));
  if (stage_ == PLD_STAGE_SOLIDS) {
    gl.DepthMask(GL_TRUE);
    gl.ClearBufferfv(GL_DEPTH, 0, &infinitelyFar);
  }
}

void Stages::setBlends() const {
  if (device_.permutation.exact()) {
    room_.open();
    return;
  }
  if (stage_ != PLD_STAGE_SOLIDS) setBlending(device_.gl, planesOf(stage_));
}

// Solids test against each other, layers of low resolution in their seam, all else against the host's depth.
void Stages::setTests() const {
  const bool solids = stage_ == PLD_STAGE_SOLIDS && !device_.permutation.exact();
  if (!solids && !depthAttachment_) return;
  device_.gl.Enable(GL_DEPTH_TEST);
  device_.gl.DepthFunc(solids ? GL_GREATER : device_.permutation.depth == PLD_DEPTH_REVERSED ? GL_GEQUAL : GL_LEQUAL);
}

void Stages::bindSeam(GLuint occlusion) const {
  const GLuint first = device_.info.texture_unit;
  device_.bind(first, stage_ == PLD_STAGE_LOW ? low_.farZ() : planes_.planarZ());
  device_.bind(first + 1, planes_.solid());
  device_.bind(first + 2, planes_.frontZ());
  if (device_.permutation.rimsInSeam()) device_.bind(first + 3, occlusion);
  device_.gl.BindBufferBase(GL_UNIFORM_BUFFER, device_.info.uniform_binding, uniforms_);
}

// To the bound framebuffer. False, and nothing is attached, where the device cannot test against it.
bool Stages::attachDepth(const pld_frame& frame) const {
  if (!depthAttachment_) return true;
  device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, depthAttachment_, GL_TEXTURE_2D, frame.depth_texture, 0);
  if (device_.trusts() || device_.isComplete()) return true;
  device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, depthAttachment_, GL_TEXTURE_2D, 0, 0);
  return false;
}

// Draws of the library's own that the host's come after. False where there is none; else what accumulation asks for is
// set, but for the viewport.
bool Stages::prepare(const pld_frame& frame, bool isFirst) {
  const bool planar = isFirst && device_.permutation.planarDepth(), low = stage_ == PLD_STAGE_LOW,
             empties = stage_ == PLD_STAGE_LAYERS && emptyPlanes_.name;
  if (planar) drawPlanarDepth(frame);
  if (low) low_.drawFarthestDepth(frame);
  if (empties) drawEmptyPlanes(frame);
  if (!planar && !low && !empties) return false;
  device_.restoreForDraws();
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frameOf(stage_));
  return true;
}

pld_status Stages::open(pld_stage stage, const pld_frame& frame, int width, GLenum attachment, bool isFirst) {
  const GlFunctions& gl = device_.gl;
  depthAttachment_ = stage == PLD_STAGE_SOLIDS || stage == PLD_STAGE_LOW ? 0 : attachment;
  device_.save(unitsOf(stage), static_cast<int>(device_.info.uniform_binding), room_.storage());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frameOf(stage));
  if (!attachDepth(frame)) {
    device_.restore();
    return device_.fail(PLD_ERROR_FORMAT, "pld_begin: this device cannot test against depth_texture %u",
                        frame.depth_texture);
  }
  stage_ = stage;
  frame_ = frame;
  device_.pushGroup(kNames[stage]);
  if (isFirst) {
    device_.timers.nextFrame();
    room_.beginFrame();
  }
  device_.timers.mark(gl, Timers::markOf(stage, 0));
  const int pixelsATexel = stage == PLD_STAGE_LOW ? frame.low_factor : 1;
  setFrame(frame, width, pixelsATexel);
  const int wide = frame.width / pixelsATexel, high = frame.height / pixelsATexel;
  if (prepare(frame, isFirst))
    setViewportTo(gl, 0, 0, wide, high);
  else
    setAccumulation(gl, wide, high);
  if (!device_.permutation.exact()) clear();
  setBlends();
  setTests();
  bindSeam(frame.occlusion_texture);
  device_.restoreActiveUnit();
  device_.timers.mark(gl, Timers::markOf(stage, 1));
  return PLD_OK;
}

pld_status Stages::close(bool& whole) {
  const GlFunctions& gl = device_.gl;
  device_.markDrawn();
  if (depthAttachment_) device_.attach(frameOf(stage_), depthAttachment_, 0);
  const int pixelsATexel = stage_ == PLD_STAGE_LOW ? frame_.low_factor : 1;
  pld_status status = PLD_OK;
  if (device_.permutation.exact())
    status = room_.fold(stage_, frameOf(stage_), frame_.width / pixelsATexel, frame_.height / pixelsATexel, frame_,
                        stage_ == PLD_STAGE_LAYERS ? planes_.solid() : 0);
  whole = status == PLD_OK;
  if (whole && stage_ == PLD_STAGE_RIMS) status = rims_.darken(frame_);
  if (whole && stage_ == PLD_STAGE_LOW) low_.addToLayers(frame_);
  device_.timers.mark(gl, Timers::markOf(stage_, 2));
  device_.restore();
  device_.popGroup();
  return status;
}

}  // namespace pellucid::c
