#include "engine_bridge/c/stages.h"

#include <algorithm>

#include "engine_bridge/c/host_textures.h"
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
  if (!device_.gl.onProcessor || p.tier != PLD_TIER_FLOAT) return {};
  return emptyPlanes_.build(device_.gl, "gl/empty_planes.frag", emptyDefines(modelOf(p)));
}

void Stages::destroy() {
  emptyPlanes_.destroy(device_.gl);
  if (uniforms_) device_.gl.DeleteBuffers(1, &uniforms_);
}

// The seam's, and what passes at the stage's end read from.
Units Stages::units() const {
  const int first = static_cast<int>(device_.info.texture_unit), end = first + device_.permutation.seamUnits(),
            own = runner_.unitsAtEnd(stage_);
  return own > 0 ? Units{0, std::max(end, own)} : Units{first, end - first};
}

void Stages::setFrame() const {
  float block[kSeamFloats];
  fillSeam({device_.permutation, frame_, width_, plan_.atlasLayers}, stage_ == PLD_STAGE_LOW ? frame_.low_factor : 1,
           block);
  device_.gl.BindBuffer(GL_UNIFORM_BUFFER, uniforms_);
  device_.gl.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(block), block);
  device_.gl.BindBufferBase(GL_UNIFORM_BUFFER, device_.info.uniform_binding, uniforms_);
}

// Where clearing is slower, the layers' planes are filled as a picture is. See empty_planes.frag
void Stages::drawEmptyPlanes(const PlannedPass& draws) const {
  setPlainDrawing(device_.gl, frame_.width, frame_.height);
  runner_.bindFrame(draws);
  device_.use(emptyPlanes_);
  device_.drawEverywhere();
}

// To the bound framebuffer. False, and nothing is attached, where the device cannot test against it.
bool Stages::attachDepth(GLuint texture) const {
  if (!depthAttachment_) return true;
  device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, depthAttachment_, GL_TEXTURE_2D, texture, 0);
  if (device_.trusts() || device_.isComplete()) return true;
  device_.gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, depthAttachment_, GL_TEXTURE_2D, 0, 0);
  return false;
}

// Draws of the library's own that the host's come after; then all is set as accumulation asks for, the framebuffer is
// bound and its planes are empty.
void Stages::prepare(const PlannedPass& draws) {
  const bool fills = stage_ == PLD_STAGE_LAYERS && emptyPlanes_.name;
  bool drew = fills;
  for (const PlannedPass& pass : plan_.passes) {
    if (pass.moment != Moment::begin || pass.stage != stage_) continue;
    runner_.run(pass);
    drew = true;
  }
  if (fills) drawEmptyPlanes(draws);
  const PassArea area = areaOf(plan_, draws, 0, frame_);
  if (drew) {
    device_.restoreForDraws();
    runner_.bindFrame(draws);
    setViewportTo(device_.gl, 0, 0, area.width, area.height);
  } else {
    setAccumulation(device_.gl, area.width, area.height);
  }
  if (!fills) runner_.clear(draws);
}

pld_status Stages::open(pld_stage stage, const pld_frame& frame, int width, GLenum attachment, bool isFirst) {
  const GlFunctions& gl = device_.gl;
  const PlannedPass& draws = runner_.drawsOf(stage);
  const bool testsHost = draws.depthImage != PLD_NO_IMAGE && !draws.writesDepth;
  stage_ = stage;
  depthAttachment_ = testsHost ? attachment : 0;
  device_.save(units(), static_cast<int>(device_.info.uniform_binding), room_.storage());
  runner_.bindFrame(draws);
  if (!attachDepth(frame.depth_texture)) {
    device_.restore();
    return device_.fail(PLD_ERROR_FORMAT, "pld_begin: this device cannot test against depth_texture %u",
                        frame.depth_texture);
  }
  frame_ = frame;
  width_ = width;
  device_.pushGroup(kNames[stage]);
  if (isFirst) {
    device_.timers.nextFrame();
    room_.beginFrame();
  }
  device_.timers.mark(gl, Timers::markOf(stage, 0));
  setFrame();
  runner_.begin(frame, width);
  prepare(draws);
  if (draws.emptiesLists)
    room_.open();
  else
    runner_.setBlending(draws);
  runner_.setTests(draws);
  runner_.bindSeam(draws);
  device_.restoreActiveUnit();
  device_.timers.mark(gl, Timers::markOf(stage, 1));
  return PLD_OK;
}

pld_status Stages::checkOcclusion(const PlannedPass& pass) {
  TextureFacts facts;
  if (device_.trusts() || !runner_.reads(pass, PLD_ROLE_OCCLUSION)) return PLD_OK;
  if (factsOf(device_.gl, frame_.occlusion_texture, facts) && facts.width >= frame_.width &&
      facts.height >= frame_.height)
    return PLD_OK;
  return device_.fail(PLD_ERROR_TEXTURE, "pld_end: occlusion_texture %u is no longer what pld_begin saw",
                      frame_.occlusion_texture);
}

// The passes of the stage's end, in the plan's order.
pld_status Stages::finish(bool& whole) {
  whole = true;
  runner_.begin(frame_, width_);
  for (const PlannedPass& pass : plan_.passes) {
    if (pass.moment != Moment::end || pass.stage != stage_) continue;
    if (const pld_status status = checkOcclusion(pass); status != PLD_OK) return status;
    if (pass.lists > 0) room_.show();
    runner_.run(pass);
    if (pass.lists == 0) continue;
    const pld_status status = room_.count();
    whole = status == PLD_OK;
    if (!whole) return status;
  }
  return PLD_OK;
}

pld_status Stages::close(bool& whole) {
  device_.markDrawn();
  if (depthAttachment_) device_.attach(textures_.frame(runner_.drawsOf(stage_)), depthAttachment_, 0);
  const pld_status status = finish(whole);
  device_.timers.mark(device_.gl, Timers::markOf(stage_, 2));
  device_.restore();
  device_.popGroup();
  return status;
}

}  // namespace pellucid::c
