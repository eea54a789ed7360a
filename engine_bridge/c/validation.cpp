#include "engine_bridge/c/validation.h"

#include <cstdio>

#include "engine_bridge/c/glsl_text.h"

namespace pellucid::c {
namespace {

constexpr const char* kFrame = "PldFrame";

}  // namespace

void Validation::create() {
  if (!isOn()) return;
  device_.gl.GenQueries(1, &drawn_);
  nameTexts();
}

void Validation::destroy() {
  if (drawn_) device_.gl.DeleteQueries(1, &drawn_);
  drawn_ = 0;
}

void Validation::nameTexts() {
  if (!isOn()) return;
  for (int k = 0; k < kStages; ++k) {
    const auto stage = static_cast<pld_stage>(k);
    marks_[k] = seamMark(device_.permutation, stage);
    seams_[k] = std::string("the seam of ") + nameOf(stage);
  }
}

void Validation::begin(Units units, Storage storage) {
  const GlFunctions& gl = device_.gl;
  units_ = units;
  storage_ = storage;
  begun_.save(gl, units, static_cast<int>(device_.info.uniform_binding), storage);
  GLint open = 0;
  gl.GetQueryiv(GL_PRIMITIVES_GENERATED, GL_CURRENT_QUERY, &open);
  isCounting_ = open == 0;  // else the host counts itself
  if (isCounting_) gl.BeginQuery(GL_PRIMITIVES_GENERATED, drawn_);
}

void Validation::beginStage(Storage storage) {
  if (isOn()) begin({static_cast<int>(device_.info.texture_unit), device_.permutation.seamUnits()}, storage);
}

void Validation::beginFace() {
  if (isOn()) begin({}, {});
}

// Without a draw it does not matter which program is in use: what a host bound long before, often.
bool Validation::drewSomething() {
  if (!isCounting_) return true;
  GLuint64 count = 0;
  device_.gl.EndQuery(GL_PRIMITIVES_GENERATED);
  device_.gl.GetQueryObjectui64v(drawn_, GL_QUERY_RESULT, &count);
  return count != 0;
}

pld_status Validation::checkState(const char* call) {
  SavedState now;
  now.save(device_.gl, units_, static_cast<int>(device_.info.uniform_binding), storage_);
  char changed[80] = {};
  if (!now.differs(begun_, changed, sizeof(changed))) return PLD_OK;
  return device_.fail(PLD_ERROR_MISUSE, "%s: %s is another than the begin set: leave it alone until the end", call,
                      changed);
}

pld_status Validation::endStage(pld_stage stage) {
  if (!isOn()) return PLD_OK;
  const bool drawn = drewSomething();
  const pld_status status = checkState("pld_end");
  if (status != PLD_OK || !drawn) return status;
  return checkProgram({"pld_end", kFrame, marks_[stage].c_str(), seams_[stage].c_str()});
}

pld_status Validation::endFace() {
  if (!isOn()) return PLD_OK;
  const bool drawn = drewSomething();
  const pld_status status = checkState("pld_shadow_end");
  if (status != PLD_OK || !drawn) return status;
  return checkProgram({"pld_shadow_end", "PldShadowFrame", casterMark(casters_.info().coloured != 0),
                       "PLD_SHADOW_TEXT_CASTER of these maps"});
}

bool Validation::holds(GLuint program, const char* mark) const {
  GLuint index = GL_INVALID_INDEX;
  device_.gl.GetUniformIndices(program, 1, &mark, &index);
  return index != GL_INVALID_INDEX;
}

// Which text of this pass a program holds; null for none that it knows.
const char* Validation::otherText(GLuint program) const {
  for (int stage = 0; stage < kStages; ++stage)
    if (holds(program, marks_[stage].c_str())) return seams_[stage].c_str();
  if (device_.gl.GetUniformBlockIndex(program, kFrame) != GL_INVALID_INDEX)
    return "the seam of another pass, or of before pld_fix()";
  if (holds(program, casterMark(true)) || holds(program, casterMark(false))) return "PLD_SHADOW_TEXT_CASTER";
  return nullptr;
}

pld_status Validation::checkMark(GLuint program, const Text& text) {
  if (holds(program, text.mark)) return PLD_OK;
  if (const char* other = otherText(program))
    return device_.fail(PLD_ERROR_MISUSE, "%s: program %u, the last in use, holds %s: expected %s", text.call, program,
                        other, text.name);
  return device_.fail(PLD_ERROR_MISUSE,
                      "%s: program %u, the last in use, does not hold %s: what it drew wrote to no plane", text.call,
                      program, text.name);
}

pld_status Validation::checkConnection(GLuint program, const Text& text) {
  const GlFunctions& gl = device_.gl;
  GLint binding = -1;
  gl.GetActiveUniformBlockiv(program, gl.GetUniformBlockIndex(program, text.block), GL_UNIFORM_BLOCK_BINDING, &binding);
  if (static_cast<GLuint>(binding) == device_.info.uniform_binding) return PLD_OK;
  return device_.fail(
      PLD_ERROR_MISUSE,
      "%s: program %u is not connected: found its block %s at binding %d, expected %u: see pld_connect()", text.call,
      program, text.block, binding, device_.info.uniform_binding);
}

pld_status Validation::checkSamplers(GLuint program, const Text& text) {
  const GlFunctions& gl = device_.gl;
  for (GLint i = 0; i < units_.count; ++i) {
    const GLint place = gl.GetUniformLocation(program, kSeamSamplers[i]);
    if (place < 0) continue;
    GLint unit = -1;
    gl.GetUniformiv(program, place, &unit);
    if (unit != units_.first + i)
      return device_.fail(
          PLD_ERROR_MISUSE,
          "%s: program %u is not connected: found its sampler %s at unit %d, expected %d: see pld_connect()", text.call,
          program, kSeamSamplers[i], unit, units_.first + i);
  }
  return PLD_OK;
}

// Of a program that asks shadow maps besides.
pld_status Validation::checkLookup(GLuint program, const char* call) {
  const GlFunctions& gl = device_.gl;
  const GLuint block = gl.GetUniformBlockIndex(program, "PldShadows");
  if (block == GL_INVALID_INDEX || !casters_.exist()) return PLD_OK;
  GLint binding = -1, buffer = 0;
  gl.GetActiveUniformBlockiv(program, block, GL_UNIFORM_BLOCK_BINDING, &binding);
  const GLuint expected = casters_.info().uniform_binding;
  if (static_cast<GLuint>(binding) != expected)
    return device_.fail(PLD_ERROR_MISUSE,
                        "%s: program %u is not connected: found its block PldShadows at binding %d, expected %u: see "
                        "pld_connect()",
                        call, program, binding, expected);
  gl.GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, expected, &buffer);
  if (static_cast<GLuint>(buffer) == casters_.table()) return PLD_OK;
  return device_.fail(PLD_ERROR_MISUSE,
                      "%s: program %u asks shadow maps: found buffer %d at binding %u, expected "
                      "PLD_VALUE_SHADOW_BUFFER",
                      call, program, buffer, expected);
}

pld_status Validation::checkProgram(const Text& text) {
  const GlFunctions& gl = device_.gl;
  GLint current = 0, pipeline = 0;
  gl.GetIntegerv(GL_CURRENT_PROGRAM, &current);
  if (current == 0) {
    // Separable programs are not looked into.
    if (gl.version >= 41) gl.GetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &pipeline);
    if (pipeline != 0) return PLD_OK;
    return device_.fail(PLD_ERROR_MISUSE, "%s: no program is in use: keep the last one until the end", text.call);
  }
  const auto program = static_cast<GLuint>(current);
  if (const pld_status status = checkMark(program, text); status != PLD_OK) return status;
  if (const pld_status status = checkConnection(program, text); status != PLD_OK) return status;
  if (const pld_status status = checkSamplers(program, text); status != PLD_OK) return status;
  return checkLookup(program, text.call);
}

}  // namespace pellucid::c
