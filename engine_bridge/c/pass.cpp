#include "engine_bridge/c/pass.h"

#include <algorithm>

#include "engine_bridge/c/frame_checks.h"
#include "engine_bridge/c/pass_choices.h"
#include "engine_bridge/c/plan_builder.h"

using namespace pellucid::c;

namespace {

constexpr int kAtlasLayers = 1;  // of the spread pyramid: GL has a barrier between its levels

}  // namespace

pld_status pld_pass::checkFeatures() {
  const Permutation& p = device.permutation;
  const bool loses = p.losesLight() && !device.isHostSince(5);  // as hosts of 0.4 and earlier have it
  if (loses) device.say(PLD_LOG_WARNING, ("pld_create: " + lostLight()).c_str());
  const std::string refusal = refusalOf(p, loses);
  return refusal.empty() ? PLD_OK : device.fail(PLD_ERROR_UNSUPPORTED, "pld_create: %s", refusal.c_str());
}

pld_status pld_pass::checkDevice() {
  const GlFunctions& gl = device.gl;
  const pld_create_info& info = device.info;
  const Permutation& p = device.permutation;
  if (p.has(PLD_FEATURE_DIFFUSION) && !gl.TextureBarrier)
    return device.fail(PLD_ERROR_UNSUPPORTED,
                       "pld_create: PLD_FEATURE_DIFFUSION needs OpenGL 4.5 or GL_ARB_texture_barrier");
  GLint bindings = 0, units = 0, drawBuffers = 0;
  gl.GetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &bindings);
  gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  gl.GetIntegerv(GL_MAX_DRAW_BUFFERS, &drawBuffers);
  const int lastUnit = std::min(units, kMostUnits) - p.seamUnits();
  if (info.uniform_binding >= static_cast<uint32_t>(bindings) || lastUnit < 0 ||
      info.texture_unit > static_cast<uint32_t>(lastUnit))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "pld_create: uniform_binding %u, texture_unit %u: expected below %d and at most %d",
                       info.uniform_binding, info.texture_unit, bindings, lastUnit);
  if (drawBuffers < kDrawBuffers)
    return device.fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d draw buffers, expected %d", drawBuffers,
                       kDrawBuffers);
  return room_.check();
}

// Framebuffers, buffers and programs: all but what has the picture's size. Empty, else the driver's words.
std::string pld_pass::makeParts() {
  device.create();
  textures_.create(plan_);
  stages_.create();
  views_.create();
  validation_.create();
  std::string failure = runner_.build();
  if (failure.empty()) failure = stages_.build();
  return failure;
}

pld_status pld_pass::create(const pld_create_info& info) {
  if (const pld_status status = device.load(info); status != PLD_OK) return status;
  Permutation& p = device.permutation;
  p = permutationOf(info);
  if (!device.isHostSince(4) && p.scatters() && !p.published()) p.features |= PLD_FEATURE_LIGHT;
  if (const pld_status status = checkFeatures(); status != PLD_OK) return status;
  plan_ = recipePlan(p, {info.clip, kAtlasLayers, (info.flags & PLD_FLAG_DEBUG_VIEWS) != 0});
  if (const pld_status status = checkDevice(); status != PLD_OK) return status;
  device.reportPendingErrors("pld_create");
  SavedState state;
  state.save(device.gl, {0, 0}, -1);
  const std::string failure = makeParts();
  state.restore(device.gl);
  const GLenum error = device.takeErrors();
  if (error == GL_OUT_OF_MEMORY) return device.fail(PLD_ERROR_MEMORY, "pld_create: the GL device has no room");
  if (!failure.empty()) return device.fail(PLD_ERROR_INTERNAL, "%s", failure.c_str());
  if (error != GL_NO_ERROR) return device.fail(PLD_ERROR_INTERNAL, "pld_create: GL error 0x%x", error);
  return PLD_OK;
}

void pld_pass::destroyObjects() {
  casters_.release();
  room_.release();
  validation_.destroy();
  views_.destroy();
  stages_.destroy();
  runner_.destroy();
  textures_.destroy();
  device.destroy();
}

pld_status pld_pass::makeTextures(int width, int height) {
  if (textures_.make(width, height)) return room_.make(width, height);
  return device.fail(PLD_ERROR_UNSUPPORTED, "pld_resize: this device cannot draw to the planes of this tier at once");
}

void pld_pass::releaseTextures() {
  textures_.release();
  room_.release();
  width_ = height_ = 0;
}

pld_status pld_pass::resize(int width, int height) {
  if (step_ == Step::open) return device.fail(PLD_ERROR_ORDER, "pld_resize: between pld_begin and pld_end");
  if (casters_.isOpen()) return device.fail(PLD_ERROR_ORDER, "pld_resize: between pld_shadow_begin and pld_shadow_end");
  GLint most = 0;
  device.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (width < 1 || height < 1 || width > most || height > most)
    return device.fail(PLD_ERROR_SIZE, "pld_resize: found %dx%d, expected 1 to %d pixels on either side", width, height,
                       most);
  device.looked = false;
  if (width == width_ && height == height_) return PLD_OK;
  device.reportPendingErrors("pld_resize");
  pld_status status = PLD_OK;
  {
    const Room room(device, device.permutation.exact() ? Storage{0, 0} : Storage{});
    releaseTextures();
    status = makeTextures(width, height);
  }
  const GLenum error = device.takeErrors();
  if (error == GL_OUT_OF_MEMORY)
    status = device.fail(PLD_ERROR_MEMORY, "pld_resize: the GL device has no room for planes of %dx%d", width, height);
  else if (error != GL_NO_ERROR && status == PLD_OK)
    status = device.fail(PLD_ERROR_INTERNAL, "pld_resize: GL error 0x%x", error);
  if (status != PLD_OK) {
    releaseTextures();
    step_ = Step::sizeless;
    return status;
  }
  width_ = width;
  height_ = height;
  step_ = Step::between;
  stagesDone_ = 0;
  return PLD_OK;
}

pld_status pld_pass::fix(const pld_frame& frame, uint32_t fields) {
  if (fields & ~kEveryField)
    return device.fail(PLD_ERROR_ARGUMENT, "pld_fix: fields hold a bit that this version does not have: 0x%x", fields);
  if (texts_.hasSeams()) return device.fail(PLD_ERROR_ORDER, "pld_fix: after pld_glsl, whose text it changes");
  if (const pld_status status = checkNumbers(device, "pld_fix", frame, fields); status != PLD_OK) return status;
  device.permutation.fixed = frame;
  device.permutation.fixedFields = fields;
  validation_.nameTexts();
  return PLD_OK;
}

pld_status pld_pass::checkOrder(pld_stage stage) {
  if (casters_.isOpen()) return device.fail(PLD_ERROR_ORDER, "pld_begin: between pld_shadow_begin and pld_shadow_end");
  if (step_ == Step::sizeless) return device.fail(PLD_ERROR_ORDER, "pld_begin: before pld_resize");
  if (step_ == Step::open) return device.fail(PLD_ERROR_ORDER, "pld_begin: the last stage has not met its pld_end");
  if (stage < PLD_STAGE_SOLIDS || stage > PLD_STAGE_LOW)
    return device.fail(PLD_ERROR_ARGUMENT, "pld_begin: found stage %d, which pld_stage does not have",
                       static_cast<int>(stage));
  const uint32_t needed = stagesOf(device.permutation), bit = 1u << stage, before = needed & (bit - 1);
  if (!(needed & bit))
    return device.fail(PLD_ERROR_ORDER, "pld_begin: this pass has no %s: its method and features ask for none",
                       nameOf(stage));
  if (before != 0 && (stagesDone_ & before) != before)
    return device.fail(PLD_ERROR_ORDER, "pld_begin: %s comes after those before it", nameOf(stage));
  if (before != 0 && (stagesDone_ & bit))
    return device.fail(PLD_ERROR_ORDER, "pld_begin: %s again in one frame", nameOf(stage));
  return PLD_OK;
}

pld_status pld_pass::begin(pld_stage stage, const pld_frame& frame) {
  const pld_status status = beginStage(stage, frame);
  beginFailed_ = status != PLD_OK;
  return status;
}

pld_status pld_pass::beginStage(pld_stage stage, const pld_frame& frame) {
  if (const pld_status status = checkOrder(stage); status != PLD_OK) return status;
  GLenum attachment = 0;
  if (const pld_status status = checkFrame(device, frame, width_, height_, attachment); status != PLD_OK) return status;
  const bool isFirst = (stagesOf(device.permutation) & ((1u << stage) - 1)) == 0;
  const pld_frame& before = stages_.frame();
  if (!isFirst && (frame.width != before.width || frame.height != before.height))
    return device.fail(PLD_ERROR_SIZE, "pld_begin: found %dx%d, expected the %dx%d of this frame's first stage",
                       frame.width, frame.height, before.width, before.height);
  if (const pld_status status = stages_.open(stage, frame, width_, attachment, isFirst); status != PLD_OK)
    return status;
  validation_.beginStage(room_.storage());
  if (isFirst) stagesDone_ = 0;
  step_ = Step::open;
  return PLD_OK;
}

pld_status pld_pass::end() {
  if (step_ != Step::open)
    return device.fail(PLD_ERROR_ORDER, beginFailed_ ? "pld_end: the last pld_begin failed, and nothing was begun"
                                                     : "pld_end: without a pld_begin");
  // A stage that was misused is drawn all the same: the picture shows what the sentence says.
  const pld_status seen = validation_.endStage(stages_.stage());
  bool whole = false;
  const pld_status status = stages_.close(whole);
  if (whole) stagesDone_ |= 1u << stages_.stage();
  step_ = Step::drawn;
  return status == PLD_OK ? seen : status;
}

pld_status pld_pass::resolve(const pld_target& target) {
  if (casters_.isOpen())
    return device.fail(PLD_ERROR_ORDER, "pld_resolve: between pld_shadow_begin and pld_shadow_end");
  const bool ofShadows = isOfShadows(target.view);
  if (!ofShadows && (step_ != Step::drawn || stagesDone_ != stagesOf(device.permutation)))
    return device.fail(PLD_ERROR_ORDER, beginFailed_
                                            ? "pld_resolve: the last pld_begin failed, and its frame is not drawn"
                                            : "pld_resolve: before all stages of a frame have met their pld_end");
  if (const pld_status status = views_.check(target, stages_.frame()); status != PLD_OK) return status;
  // Views of the same planes may follow; the next frame begins with its first stage.
  if (!ofShadows) return views_.resolve(target, stages_.frame(), width_);
  if (step_ == Step::open) return device.fail(PLD_ERROR_ORDER, "pld_resolve: between pld_begin and pld_end");
  return views_.resolveFace(target);
}

pld_status pld_pass::shadowResize(const pld_shadow_info* info) {
  if (step_ == Step::open || casters_.isOpen())
    return device.fail(PLD_ERROR_ORDER, "pld_shadow_resize: between a begin and its end");
  return casters_.resize(info);
}

pld_status pld_pass::shadowBegin(const pld_shadow_view& view) {
  if (!casters_.exist()) return device.fail(PLD_ERROR_ORDER, "pld_shadow_begin: before pld_shadow_resize");
  if (casters_.isOpen())
    return device.fail(PLD_ERROR_ORDER, "pld_shadow_begin: the last face has not met its pld_shadow_end");
  if (step_ == Step::open) return device.fail(PLD_ERROR_ORDER, "pld_shadow_begin: between pld_begin and pld_end");
  const pld_status status = casters_.begin(view);
  if (status == PLD_OK) validation_.beginFace();
  return status;
}

pld_status pld_pass::shadowEnd() {
  if (!casters_.isOpen()) return device.fail(PLD_ERROR_ORDER, "pld_shadow_end: without a pld_shadow_begin");
  const pld_status seen = validation_.endFace();
  casters_.end();
  return seen;
}

pld_status pld_pass::queryTimes(pld_value what, uint64_t& value) {
  if (!device.timers.on()) return device.fail(PLD_ERROR_UNSUPPORTED, "pld_query: times need PLD_FLAG_TIMERS");
  if (what == PLD_VALUE_NS_SHADOW)
    return device.timers.readFace(device.gl, value)
               ? PLD_OK
               : device.fail(PLD_ERROR_ORDER, "pld_query: no face's time is known yet");
  return device.timers.read(device.gl, what, value)
             ? PLD_OK
             : device.fail(PLD_ERROR_ORDER, "pld_query: no frame's times are known yet");
}

pld_status pld_pass::queryPlane(pld_value what, uint64_t& value) {
  const int plane = static_cast<int>(what) - static_cast<int>(PLD_VALUE_FIRST_PLANE);
  if (plane < 0 || plane >= kDrawBuffers)
    return device.fail(PLD_ERROR_ARGUMENT, "pld_query: found value %d, which pld_value does not have",
                       static_cast<int>(what));
  value = textures_.layersAt(plane);
  return PLD_OK;
}

pld_status pld_pass::query(pld_value what, uint64_t& value) {
  const Permutation& p = device.permutation;
  if (queryOf(p, what, value)) return PLD_OK;
  switch (what) {
    case PLD_VALUE_BYTES:
      value = textures_.bytes() + room_.bytes();
      return PLD_OK;
    case PLD_VALUE_NS_BEGIN:
    case PLD_VALUE_NS_DRAWS:
    case PLD_VALUE_NS_RESOLVE:
    case PLD_VALUE_NS_SHADOW:
      return queryTimes(what, value);
    case PLD_VALUE_FRAGMENTS:
    case PLD_VALUE_FRAGMENT_ROOM:
      if (!p.exact())
        return device.fail(PLD_ERROR_UNSUPPORTED, "pld_query: fragments are counted in PLD_TIER_EXACT alone");
      value = what == PLD_VALUE_FRAGMENTS ? room_.fragments() : room_.room();
      return PLD_OK;
    case PLD_VALUE_SHADOW_TEXTURE:
      value = casters_.texture();
      return PLD_OK;
    case PLD_VALUE_SHADOW_BUFFER:
      value = casters_.table();
      return PLD_OK;
    case PLD_VALUE_SHADOW_BYTES:
      value = casters_.bytes();
      return PLD_OK;
    default:
      return queryPlane(what, value);
  }
}
