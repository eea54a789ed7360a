#include "engine_bridge/c/host_texts.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/glsl_text.h"

namespace pellucid::c {

bool HostTexts::hasSeams() const {
  return std::any_of(std::begin(seams_), std::end(seams_), [](const std::string& text) { return !text.empty(); });
}

pld_status HostTexts::checkVersion(const char* call, int version) {
  static constexpr int versions[] = {330, 400, 410, 420, 430, 440, 450, 460};
  for (const int one : versions)
    if (one == version) return PLD_OK;
  return device_.fail(PLD_ERROR_ARGUMENT, "%s: found version %d, expected 330 to 460 as GLSL has them", call, version);
}

pld_status HostTexts::seam(pld_stage stage, int version, const char*& text) {
  if (stage < PLD_STAGE_SOLIDS || stage > PLD_STAGE_LOW || !(stagesOf(device_.permutation) & (1u << stage)))
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_glsl: this pass has no stage %d", static_cast<int>(stage));
  if (const pld_status status = checkVersion("pld_glsl", version); status != PLD_OK) return status;
  if (device_.permutation.exact() && version < 430)
    return device_.fail(PLD_ERROR_UNSUPPORTED,
                        "pld_glsl: found version %d, expected 430 or later: the exact tier writes to storage buffers",
                        version);
  const pld_create_info& info = device_.info;
  std::string& kept = seams_[stage];
  kept = seamText(device_.permutation, stage, {PLD_DIALECT_GL, version},
                  {static_cast<int>(info.uniform_binding), static_cast<int>(info.texture_unit),
                   static_cast<int>(info.storage_binding)});
  text = kept.c_str();
  return PLD_OK;
}

pld_status HostTexts::shadows(pld_shadow_text which, int version, const char*& text) {
  if (which != PLD_SHADOW_TEXT_CASTER && which != PLD_SHADOW_TEXT_LOOKUP)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_shadow_glsl: found text %d, which pld_shadow_text does not have",
                        static_cast<int>(which));
  if (!casters_.exist()) return device_.fail(PLD_ERROR_ORDER, "pld_shadow_glsl: before pld_shadow_resize");
  if (const pld_status status = checkVersion("pld_shadow_glsl", version); status != PLD_OK) return status;
  const pld_shadow_info& maps = casters_.info();
  std::string& kept = shadows_[which];
  kept = which == PLD_SHADOW_TEXT_CASTER
             ? casterText(maps.coloured != 0, {PLD_DIALECT_GL, version},
                          {static_cast<int>(device_.info.uniform_binding), 0})
             : shadowText({maps.lights, maps.faces, edgeOf(maps), channelsOf(maps)}, {PLD_DIALECT_GL, version},
                          {static_cast<int>(maps.uniform_binding), static_cast<int>(maps.texture_unit)});
  text = kept.c_str();
  return PLD_OK;
}

// Hosts of 0.4 and earlier could connect whatever they had.
pld_status HostTexts::failWithoutText(GLuint program) {
  constexpr const char* sentence = "pld_connect: program %u holds no text of pld_glsl() or pld_shadow_glsl()";
  if (device_.isHostSince(5)) return device_.fail(PLD_ERROR_ARGUMENT, sentence, program);
  char text[120];
  std::snprintf(text, sizeof(text), sentence, program);
  device_.say(PLD_LOG_WARNING, text);
  return PLD_OK;
}

pld_status HostTexts::connect(GLuint program) {
  const GlFunctions& gl = device_.gl;
  const pld_create_info& info = device_.info;
  GLint linked = GL_FALSE;
  if (gl.IsProgram(program)) gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_connect: found %u, expected a linked program of this context",
                        program);
  bool holdsText = false;
  const std::pair<const char*, GLuint> blocks[] = {{"PldFrame", info.uniform_binding},
                                                   {"PldShadowFrame", info.uniform_binding},
                                                   {"PldShadows", casters_.info().uniform_binding}};
  for (const auto& [name, binding] : blocks) {
    const GLuint block = gl.GetUniformBlockIndex(program, name);
    if (block == GL_INVALID_INDEX) continue;
    gl.UniformBlockBinding(program, block, binding);
    holdsText = true;
  }
  if (!holdsText) return failWithoutText(program);
  GLint current = 0;
  gl.GetIntegerv(GL_CURRENT_PROGRAM, &current);
  gl.UseProgram(program);
  for (GLint i = 0; i < device_.permutation.seamUnits(); ++i) {
    const GLint place = gl.GetUniformLocation(program, kSeamSamplers[i]);
    if (place >= 0) gl.Uniform1i(place, static_cast<GLint>(info.texture_unit) + i);
  }
  const GLint maps = gl.GetUniformLocation(program, "pldShadowMaps");
  if (maps >= 0) gl.Uniform1i(maps, static_cast<GLint>(casters_.info().texture_unit));
  // One that the host has deleted while it was current is gone now.
  gl.UseProgram(current && gl.IsProgram(static_cast<GLuint>(current)) ? static_cast<GLuint>(current) : 0);
  return PLD_OK;
}

}  // namespace pellucid::c
