#include "tests/vulkan/said_text.h"

namespace pellucid::test {

std::string versionLine(pld_dialect dialect) {
  return dialect == PLD_DIALECT_ES ? "#version 320 es\n" : "#version 450\n";
}

SaidText saidOf(const pld_recipe_pass& pass, const std::string& where, pld_dialect dialect, const std::string& head,
                const std::string& main) {
  SaidText said;
  said.where = where;
  said.fragment = pass.fragment;
  if (pass.kind == PLD_PASS_DRAWS)
    said.fragment = versionLine(dialect) + head + pass.fragment + main;
  else
    said.vertex = pass.vertex;
  said.set = static_cast<int>(pass.set);
  said.block = pass.constants_block;
  said.constantsBinding = static_cast<int>(pass.constants_binding);
  said.constantsSize = static_cast<int>(pass.constants_size);
  for (uint32_t i = 0; i < pass.read_count; ++i)
    said.reads[pass.reads[i].sampler] = {said.set, static_cast<int>(pass.reads[i].binding)};
  for (uint32_t i = 0; i < pass.storage_count; ++i)
    said.storage[pass.storage[i].block] = {said.set, static_cast<int>(pass.storage[i].binding)};
  for (uint32_t i = 0; i < pass.attachment_count; ++i)
    said.outputs.insert(static_cast<int>(pass.attachments[i].location));
  return said;
}

// Where a text is told of numbers that none of its functions needs, the compiler leaves the block out.
std::string faultOf(const SaidText& said, TextKind kind) {
  const SpirvText text = compiledText(said.fragment, false, kind);
  if (!text.failure.empty()) return text.failure;
  if (!said.vertex.empty())
    if (const SpirvText vertex = compiledText(said.vertex, true, kind); !vertex.failure.empty()) return vertex.failure;
  if (kind == TextKind::es) return {};
  if (text.samplers != said.reads) {
    std::string names;
    for (const auto& [name, place] : text.samplers)
      if (!said.reads.count(name)) names += " reads " + name;
    for (const auto& [name, place] : said.reads)
      if (!text.samplers.count(name)) names += " does not read " + name;
    return "other textures than the recipe says, or elsewhere:" + names;
  }
  if (text.storage != said.storage) return "other buffers than the recipe says";
  if (text.outputs != said.outputs) return "other outputs than attachments";
  if (text.blockBytes == 0) return {};
  if (text.block != said.block || text.blockSet != said.set || text.blockBinding != said.constantsBinding)
    return "another block than the recipe says: " + text.block;
  if ((text.blockBytes + 15) / 16 * 16 != said.constantsSize) return "constants of another size";
  return {};
}

}  // namespace pellucid::test
