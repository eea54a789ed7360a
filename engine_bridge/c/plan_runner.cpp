#include "engine_bridge/c/plan_runner.h"

#include <algorithm>
#include <cstring>

#include "engine_bridge/c/glsl_text.h"
#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/plan_words.h"
#include "engine_bridge/c/spread_layout.h"

namespace pellucid::c {
namespace {

// Whether one program serves both passes.
bool lookAlike(const PlannedPass& a, const PlannedPass& b) {
  const auto same = [](const PlannedRead& x, const PlannedRead& y) {
    return x.binding == y.binding && x.sampler == y.sampler;
  };
  return a.file == b.file && a.defines == b.defines && a.numbers == b.numbers && a.moment == b.moment &&
         std::equal(a.reads.begin(), a.reads.end(), b.reads.begin(), b.reads.end(), same);
}

int unitsRead(const PlannedPass& pass) {
  int units = 0;
  for (const PlannedRead& read : pass.reads) units = std::max(units, static_cast<int>(read.binding) + 1);
  return units;
}

// Whether a repeat looks up what the last one drew, in the same image.
bool readsItself(const PlannedPass& pass) {
  for (const PlannedRead& read : pass.reads)
    if (!pass.attachments.empty() && read.image == pass.attachments[0].image) return true;
  return false;
}

// A loose uniform of the program in use.
void setNumber(const GlFunctions& gl, GLint place, const NumberPlace& number, const std::byte* at) {
  GLint ints[4 * SpreadLayout::kLevels];
  GLfloat floats[4];
  const std::size_t components = number.bytes / sizeof(GLint) / static_cast<std::size_t>(number.count);
  if (number.type[0] != 'i') {
    std::memcpy(floats, at, number.bytes);
    components == 1 ? gl.Uniform1f(place, floats[0]) : gl.Uniform4f(place, floats[0], floats[1], floats[2], floats[3]);
    return;
  }
  std::memcpy(ints, at, number.bytes);
  switch (components) {
    case 1:
      return gl.Uniform1i(place, ints[0]);
    case 2:
      return gl.Uniform2i(place, ints[0], ints[1]);
    case 3:
      return gl.Uniform3i(place, ints[0], ints[1], ints[2]);
    default:
      return gl.Uniform4iv(place, number.count, ints);
  }
}

}  // namespace

std::string PlanRunner::build() {
  programs_.reserve(plan_.passes.size());
  programOf_.assign(plan_.passes.size(), 0);
  for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
    const PlannedPass& pass = plan_.passes[i];
    if (pass.kind != PLD_PASS_FULL_SCREEN) continue;
    const auto twin =
        std::find_if(programs_.begin(), programs_.end(), [&](const Own& own) { return lookAlike(*own.like, pass); });
    programOf_[i] = static_cast<std::size_t>(twin - programs_.begin());
    if (twin != programs_.end()) continue;
    if (std::string failure = build(pass, programs_.emplace_back()); !failure.empty()) return failure;
  }
  return {};
}

std::string PlanRunner::build(const PlannedPass& pass, Own& own) const {
  const GlFunctions& gl = device_.gl;
  std::vector<std::string> defines = pass.defines;
  if (pass.lists > 0)
    for (std::string& place : storageDefines(static_cast<int>(device_.info.storage_binding)))
      defines.push_back(std::move(place));
  if (std::string failure = own.program.build(gl, pass.file, defines); !failure.empty()) return failure;
  own.like = &pass;
  own.numbers = placesOf(pass.numbers);
  own.told.resize(sizeOfStageBlock(pass.numbers));
  own.wanted = own.told;
  for (const NumberPlace& number : own.numbers)
    own.places.push_back(gl.GetUniformLocation(own.program.name, number.name));
  for (const PlannedRead& read : pass.reads)
    gl.Uniform1i(gl.GetUniformLocation(own.program.name, read.sampler.c_str()),
                 static_cast<GLint>(firstUnitOf(pass) + read.binding));
  return {};
}

void PlanRunner::destroy() {
  for (Own& own : programs_) own.program.destroy(device_.gl);
  programs_.clear();
}

const PlannedPass& PlanRunner::drawsOf(pld_stage stage) const {
  return *std::find_if(plan_.passes.begin(), plan_.passes.end(),
                       [&](const PlannedPass& pass) { return pass.kind == PLD_PASS_DRAWS && pass.stage == stage; });
}

int PlanRunner::unitsAtEnd(pld_stage stage) const {
  int units = 0;
  for (const PlannedPass& pass : plan_.passes)
    if (pass.moment == Moment::end && pass.stage == stage) units = std::max(units, unitsRead(pass));
  return units;
}

int PlanRunner::unitsOfResolve() const {
  int units = 0;
  for (const PlannedPass& pass : plan_.passes)
    if (pass.moment == Moment::resolve) units = std::max(units, unitsRead(pass));
  return units;
}

bool PlanRunner::reads(const PlannedPass& pass, pld_role role) const {
  return std::any_of(pass.reads.begin(), pass.reads.end(),
                     [&](const PlannedRead& read) { return plan_.images[read.image].role == role; });
}

// As a stage begins, the host's own units are left alone: only those of the seam are to be had.
GLuint PlanRunner::firstUnitOf(const PlannedPass& pass) const {
  return pass.moment == Moment::begin || pass.moment == Moment::draws ? device_.info.texture_unit : 0;
}

GLuint PlanRunner::textureOf(uint32_t image) const {
  switch (plan_.images[image].role) {
    case PLD_ROLE_COLOUR:
      return frame_.colour_texture;
    case PLD_ROLE_DEPTH:
      return frame_.depth_texture;
    case PLD_ROLE_OCCLUSION:
      return frame_.occlusion_texture;
    default:
      return textures_.texture(image);
  }
}

void PlanRunner::begin(const pld_frame& frame, int width) {
  frame_ = frame;
  width_ = width;
  isPlain_ = false;
  bound_.fill(0);
}

void PlanRunner::beginFace(int layer) {
  begin({}, 0);
  faceLayer_ = layer;
}

void PlanRunner::setPlain(const PassArea& area) {
  if (!isPlain_) setPlainDrawing(device_.gl, area.width, area.height);
  if (isPlain_ || area.x != 0 || area.y != 0) setViewportTo(device_.gl, area.x, area.y, area.width, area.height);
  isPlain_ = true;
}

void PlanRunner::bindFrame(const PlannedPass& pass) const {
  const GLuint frame = textures_.frame(pass);
  if (!frame) return;
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  for (const pld_recipe_attachment& one : pass.attachments)
    if (one.layer == PLD_LAYER_OF_FACE)
      device_.attachLayer(frame, GL_COLOR_ATTACHMENT0 + one.location, textures_.texture(one.image),
                          faceLayer_ + static_cast<int>(one.location));
}

void PlanRunner::clear(const PlannedPass& pass) const {
  const GlFunctions& gl = device_.gl;
  for (const pld_recipe_attachment& one : pass.attachments)
    if (one.load == PLD_LOAD_CLEAR)
      gl.ClearBufferfv(GL_COLOR, static_cast<GLint>(one.location), plan_.images[one.image].clear.data());
  if (!pass.writesDepth) return;
  gl.DepthMask(GL_TRUE);
  gl.ClearBufferfv(GL_DEPTH, 0, plan_.images[pass.depthImage].clear.data());
}

void PlanRunner::setBlending(const PlannedPass& pass) const {
  const GlFunctions& gl = device_.gl;
  for (const pld_recipe_attachment& one : pass.attachments) {
    const pld_blend& blend = one.blend;
    const auto writes = [&](uint32_t bit) { return static_cast<GLboolean>((one.write_mask & bit) != 0); };
    if (one.write_mask != kAllComponents) gl.ColorMaski(one.location, writes(1), writes(2), writes(4), writes(8));
    if (!blend.enabled) continue;
    gl.Enablei(GL_BLEND, one.location);
    gl.BlendFuncSeparatei(one.location, wordOf(blend.source), wordOf(blend.destination), wordOf(blend.alpha_source),
                          wordOf(blend.alpha_destination));
    gl.BlendEquationSeparatei(one.location, wordOf(blend.op), wordOf(blend.alpha_op));
  }
}

void PlanRunner::setTests(const PlannedPass& pass) const {
  if (pass.compare == PLD_COMPARE_NONE) return;
  device_.gl.Enable(GL_DEPTH_TEST);
  device_.gl.DepthFunc(wordOf(pass.compare));
}

void PlanRunner::bind(GLuint unit, GLuint texture) {
  if (bound_[unit] != texture) device_.bind(unit, texture);
  bound_[unit] = texture;
}

void PlanRunner::bindReads(const PlannedPass& pass) {
  for (const PlannedRead& read : pass.reads) bind(firstUnitOf(pass) + read.binding, textureOf(read.image));
}

void PlanRunner::bindSeam(const PlannedPass& pass) {
  bound_.fill(0);
  std::array<GLuint, kMostSeamUnits> textures{};
  for (const PlannedRead& read : pass.reads) textures[read.binding] = textureOf(read.image);
  for (int i = 0; i < device_.permutation.seamUnits(); ++i)
    device_.bind(firstUnitOf(pass) + static_cast<GLuint>(i), textures[static_cast<std::size_t>(i)]);
}

// What the program knows already it is not told again.
void PlanRunner::tell(Own& own, uint32_t repeat, int view) {
  fillStage({device_.permutation, frame_, width_, plan_.atlasLayers, view}, own.numbers, repeat, own.wanted.data());
  for (std::size_t i = 0; i < own.numbers.size(); ++i) {
    const NumberPlace& number = own.numbers[i];
    const std::byte* const wanted = own.wanted.data() + number.offset;
    if (own.isTold && std::equal(wanted, wanted + number.bytes, own.told.data() + number.offset)) continue;
    setNumber(device_.gl, own.places[i], number, wanted);
  }
  own.told = own.wanted;
  own.isTold = true;
}

void PlanRunner::run(const PlannedPass& pass, int view) {
  Own& own = programs_[programOf_[textures_.indexOf(pass)]];
  const bool toHost = textures_.frame(pass) == 0, needsBarrier = readsItself(pass);
  const uint32_t repeats = repeatsOf(plan_, pass, frame_);
  for (uint32_t repeat = 0; repeat < repeats; ++repeat) {
    setPlain(areaOf(plan_, pass, repeat, frame_));
    if (repeat == 0) {
      bindFrame(pass);
      if (toHost) device_.allowColours(1, false);
      clear(pass);
      setBlending(pass);
      bindReads(pass);
      device_.use(own.program);
    }
    tell(own, repeat, view);
    device_.drawEverywhere();
    if (needsBarrier) device_.gl.TextureBarrier();
  }
  const auto leavesState = [](const pld_recipe_attachment& one) {
    return one.blend.enabled || one.write_mask != kAllComponents;
  };
  if (toHost || std::any_of(pass.attachments.begin(), pass.attachments.end(), leavesState)) isPlain_ = false;
}

}  // namespace pellucid::c
