#include "tests/vulkan/spirv_text.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <spirv-tools/libspirv.hpp>

namespace pellucid::test {
namespace {

struct Process {
  Process() { glslang::InitializeProcess(); }
  ~Process() { glslang::FinalizeProcess(); }
};

void look(glslang::TProgram& program, SpirvText& found) {
  for (int i = 0; i < program.getNumUniformVariables(); ++i) {
    const glslang::TObjectReflection& uniform = program.getUniform(i);
    if (uniform.getBinding() < 0) continue;  // of a block
    const auto set = static_cast<int>(uniform.getType()->getQualifier().layoutSet);
    found.samplers[uniform.name] = {set, uniform.getBinding()};
  }
  for (int i = 0; i < program.getNumUniformBlocks(); ++i) {
    const glslang::TObjectReflection& block = program.getUniformBlock(i);
    found.block += block.name;
    found.blockSet = static_cast<int>(block.getType()->getQualifier().layoutSet);
    found.blockBinding = block.getBinding();
    found.blockBytes = block.size;
  }
  for (int i = 0; i < program.getNumBufferBlocks(); ++i) {
    const glslang::TObjectReflection& block = program.getBufferBlock(i);
    found.storage[block.name] = {static_cast<int>(block.getType()->getQualifier().layoutSet), block.getBinding()};
  }
  for (int i = 0; i < program.getNumPipeOutputs(); ++i) {
    const glslang::TQualifier& output = program.getPipeOutput(i).getType()->getQualifier();
    if (output.hasLocation()) found.outputs.insert(static_cast<int>(output.layoutLocation));
  }
}

}  // namespace

SpirvText compiledText(const std::string& text, bool vertex, TextKind kind) {
  static const Process process;
  SpirvText found;
  const EShLanguage stage = vertex ? EShLangVertex : EShLangFragment;
  const bool vulkan = kind == TextKind::vulkan;
  const auto messages = static_cast<EShMessages>(vulkan ? EShMsgSpvRules | EShMsgVulkanRules : EShMsgDefault);
  glslang::TShader shader(stage);
  const char* const source = text.c_str();
  shader.setStrings(&source, 1);
  if (vulkan) {
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!shader.parse(GetDefaultResources(), 100, false, messages)) {
    found.failure = shader.getInfoLog();
    return found;
  }
  if (!program.link(messages)) {
    found.failure = program.getInfoLog();
    return found;
  }
  if (!vulkan) return found;
  program.buildReflection(EShReflectionSeparateBuffers | EShReflectionAllBlockVariables);
  look(program, found);
  std::vector<uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(stage), words);
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* said) {
    found.failure += said + std::string("\n");
  });
  if (!tools.Validate(words)) found.failure += "spirv-val refuses it";
  return found;
}

}  // namespace pellucid::test
