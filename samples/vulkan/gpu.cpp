#include "samples/vulkan/gpu.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <vulkan/vulkan_format_traits.hpp>

#include "samples/engine/engine_scene.h"

namespace engine {
vk::RenderingAttachmentInfo target(vk::ImageView view, vk::AttachmentLoadOp load, const vk::ClearValue& clear) {
  return {view, vk::ImageLayout::eGeneral, {}, {}, {}, load, vk::AttachmentStoreOp::eStore, clear};
}

Gpu::Gpu() {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  glslang::InitializeProcess();
  const vk::ApplicationInfo application("engine", 1, nullptr, 0, VK_API_VERSION_1_3);
  const char *const layer = "VK_LAYER_KHRONOS_validation", *const debugging = VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                    *const pushing = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
  const auto hear = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                       const VkDebugUtilsMessengerCallbackDataEXT* data, void*) -> VkBool32 {
    ++validationMessages;
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
  };
  const vk::DebugUtilsMessengerCreateInfoEXT messenger({}, Severity::eWarning | Severity::eError,
                                                       vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation, hear);
  const auto synchronisation = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT validation(1, &synchronisation, 0, nullptr, &messenger);
  instance_ = {context_, vk::InstanceCreateInfo({}, &application, 1, &layer, 1, &debugging, &validation)};
  messenger_ = {instance_, messenger};
  for (const vk::raii::PhysicalDevice& one : instance_.enumeratePhysicalDevices())
    if (!*physical_ && one.getProperties().apiVersion >= VK_API_VERSION_1_3) physical_ = one;
  if (!*physical_) stop("no device with Vulkan 1.3");
  std::printf("%s\n", physical_.getProperties().deviceName.data());
  // Lists in fragment shaders and sums in double precision are the exact tier's, numbers of triangles those of casters.
  const auto newer = vk::PhysicalDeviceVulkan13Features().setDynamicRendering(true).setSynchronization2(true);
  vk::PhysicalDeviceFeatures features;
  features.setIndependentBlend(true).setFragmentStoresAndAtomics(true).setShaderFloat64(true).setGeometryShader(true);
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, 0, 1, &priority);  // family 0 draws on every device that can
  device_ = {physical_, vk::DeviceCreateInfo({}, queue, {}, pushing, &features, &newer)};
  commands_ = {device_, vk::CommandPoolCreateInfo()};
  constexpr auto edge = vk::SamplerAddressMode::eClampToEdge;
  auto sampler = vk::SamplerCreateInfo().setAddressModeU(edge).setAddressModeV(edge);
  nearest_ = {device_, sampler};
  sampler.setMinFilter(vk::Filter::eLinear).setMagFilter(vk::Filter::eLinear).setMaxLod(VK_LOD_CLAMP_NONE);
  smooth_ = {device_, sampler.setMipmapMode(vk::SamplerMipmapMode::eLinear)};
}

vk::raii::DeviceMemory Gpu::memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const {
  const vk::PhysicalDeviceMemoryProperties all = physical_.getMemoryProperties();
  for (uint32_t type = 0; type < all.memoryTypeCount; ++type)
    if (needs.memoryTypeBits >> type & 1u && (all.memoryTypes[type].propertyFlags & wanted) == wanted)
      return {device_, vk::MemoryAllocateInfo(needs.size, type)};
  stop("no memory of the kind that is wanted");
}

GpuImage Gpu::image(vk::Format format, int width, int height, uint32_t layers, uint32_t levels) {
  using Usage = vk::ImageUsageFlagBits;
  using Aspect = vk::ImageAspectFlagBits;
  const bool isDepth = format == vk::Format::eD32Sfloat;
  const vk::ImageUsageFlags drawn = isDepth ? Usage::eDepthStencilAttachment : Usage::eColorAttachment;
  GpuImage made{{}, format, isDepth ? Aspect::eDepth : Aspect::eColor};
  made.width = static_cast<uint32_t>(width), made.height = static_cast<uint32_t>(height);
  vk::raii::Image image(
      device_, vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {made.width, made.height, 1}, levels, layers)
                   .setUsage(Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst | drawn));
  image.bindMemory(keep(memory(image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal)), 0);
  made.image = keep(std::move(image));
  const auto view = [&](vk::ImageViewType type, uint32_t first, uint32_t count) {
    const vk::ImageSubresourceRange range(made.aspect, 0, levels, first, count);
    return keep(vk::raii::ImageView(device_, vk::ImageViewCreateInfo({}, made.image, type, format, {}, range)));
  };
  for (uint32_t i = 0; i < layers; ++i) made.layers.push_back(view(vk::ImageViewType::e2D, i, 1));
  made.whole = layers > 1 ? view(vk::ImageViewType::e2DArray, 0, layers) : made.layers[0];
  run([&](const Commands& to) {  // into the one layout that serves all uses, where it stays
    const vk::ImageMemoryBarrier2 barrier({}, {}, vk::PipelineStageFlagBits2::eAllCommands, {}, {},
                                          vk::ImageLayout::eGeneral, 0, 0, made.image,
                                          {made.aspect, 0, levels, 0, layers});
    to.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barrier));
  });
  return made;
}

GpuBuffer Gpu::buffer(vk::BufferUsageFlags usage, vk::DeviceSize size, const void* filled) {
  using Usage = vk::BufferUsageFlagBits;
  using Memory = vk::MemoryPropertyFlagBits;
  vk::raii::Buffer buffer(device_, vk::BufferCreateInfo({}, size, usage | Usage::eTransferSrc | Usage::eTransferDst));
  auto at = memory(buffer.getMemoryRequirements(), Memory::eHostVisible | Memory::eHostCoherent);
  buffer.bindMemory(*at, 0);
  auto* const mapped = static_cast<char*>(at.mapMemory(0, VK_WHOLE_SIZE));
  if (filled) std::memcpy(mapped, filled, size);
  keep(std::move(at));
  return {keep(std::move(buffer)), mapped};
}

vk::raii::ShaderModule Gpu::compile(const std::string& text, bool vertex) const {
  const EShLanguage stage = vertex ? EShLangVertex : EShLangFragment;
  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  glslang::TShader shader(stage);
  const char* const source = text.c_str();
  shader.setStrings(&source, 1);
  glslang::TProgram program;
  program.addShader(&shader);
  if (!shader.parse(GetDefaultResources(), 450, false, rules)) stop(shader.getInfoLog());
  if (!program.link(rules)) stop(program.getInfoLog());
  std::vector<uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(stage), words);
  return {device_, vk::ShaderModuleCreateInfo({}, words)};
}

GpuPipeline Gpu::pipeline(const GpuPass& pass, const std::string& vertex, const std::string& fragment, bool meshes) {
  using Stage = vk::ShaderStageFlagBits;
  using enum vk::Format;
  using enum vk::DynamicState;
  for (std::size_t i = 0; i < pass.formats.size(); ++i) {
    const auto features = physical_.getFormatProperties(pass.formats[i]).optimalTilingFeatures;
    if (pass.blends[i].blendEnable && !(features & vk::FormatFeatureFlagBits::eColorAttachmentBlend))
      stop("this device does not blend into " + vk::to_string(pass.formats[i]));
  }
  std::vector<vk::DescriptorSetLayoutBinding> places;
  for (const Binding& one : pass.bindings) places.emplace_back(one.place, one.type, 1, Stage::eAllGraphics);
  const vk::DescriptorSetLayoutCreateInfo setInfo(vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR, places);
  const vk::DescriptorSetLayout set = keep(vk::raii::DescriptorSetLayout(device_, setInfo));
  const vk::PushConstantRange pushed(Stage::eAllGraphics, 0, 128);
  const vk::PipelineLayout layout =
      keep(vk::raii::PipelineLayout(device_, vk::PipelineLayoutCreateInfo({}, set, pushed)));

  const vk::raii::ShaderModule modules[] = {compile(vertex, true), compile(fragment, false)};
  const vk::PipelineShaderStageCreateInfo stages[] = {{{}, Stage::eVertex, *modules[0], "main"},
                                                      {{}, Stage::eFragment, *modules[1], "main"}};
  const vk::VertexInputBindingDescription binding(0, sizeof(Vertex));
  const vk::VertexInputAttributeDescription attributes[] = {{0, 0, eR32G32B32Sfloat, offsetof(Vertex, position)},
                                                            {1, 0, eR32G32B32Sfloat, offsetof(Vertex, normal)},
                                                            {2, 0, eR32G32B32A32Sfloat, offsetof(Vertex, colour)},
                                                            {3, 0, eR32G32Sfloat, offsetof(Vertex, uv)}};
  vk::PipelineVertexInputStateCreateInfo input;
  if (meshes) input.setVertexBindingDescriptions(binding).setVertexAttributeDescriptions(attributes);
  const vk::PipelineInputAssemblyStateCreateInfo assembly({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  const auto raster = vk::PipelineRasterizationStateCreateInfo().setLineWidth(1.0f);
  const vk::PipelineMultisampleStateCreateInfo samples;
  const bool tests = pass.depthFormat != eUndefined;
  const vk::PipelineDepthStencilStateCreateInfo depth({}, tests, pass.writesDepth, pass.compare);
  const vk::PipelineColorBlendStateCreateInfo blend({}, false, {}, pass.blends);
  const vk::DynamicState dynamics[] = {eViewport, eScissor, eCullMode, eFrontFace};
  const vk::PipelineDynamicStateCreateInfo dynamic({}, dynamics);
  const vk::PipelineRenderingCreateInfo targets(0, pass.formats, pass.depthFormat);
  const vk::GraphicsPipelineCreateInfo info({}, stages, &input, &assembly, nullptr, &viewport, &raster, &samples,
                                            &depth, &blend, &dynamic, layout, {}, 0, {}, 0, &targets);
  return {layout, keep(vk::raii::Pipeline(device_, nullptr, info))};
}

void Gpu::draw(const Commands& to, const GpuPipeline& pipeline, const GpuPass& pass,
               const std::function<void()>& draw) const {
  waitForWrites(to);
  to.beginRendering(vk::RenderingInfo({}, pass.area, 1, 0, pass.outputs, &pass.depth));
  const glm::vec4 area(pass.area.offset.x, pass.area.offset.y, pass.area.extent.width, pass.area.extent.height);
  to.setViewport(0, vk::Viewport(area.x, area.y, area.z, area.w, 0.0f, 1.0f));
  to.setScissor(0, pass.area);
  to.setCullMode(vk::CullModeFlagBits::eNone);
  to.setFrontFace(vk::FrontFace::eCounterClockwise);
  to.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline.pipeline);
  for (const Binding& one : pass.bindings) {
    const vk::DescriptorImageInfo image(*(one.smooth ? smooth_ : nearest_), one.view, vk::ImageLayout::eGeneral);
    to.pushDescriptorSetKHR(vk::PipelineBindPoint::eGraphics, pipeline.layout, 0,
                            vk::WriteDescriptorSet({}, one.place, 0, 1, one.type, &image, &one.part));
  }
  if (draw)
    draw();
  else
    to.draw(3, 1, 0, 0);
  to.endRendering();
}

void Gpu::run(const std::function<void(const Commands&)>& record) const {
  const vk::raii::CommandBuffers all(device_, {*commands_, vk::CommandBufferLevel::ePrimary, 1});
  const Commands& commands = all[0];
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  waitForWrites(commands);
  commands.end();
  device_.getQueue(0, 0).submit(vk::SubmitInfo({}, {}, *commands));
  device_.waitIdle();
}

std::vector<float> Gpu::read(const GpuImage& image) {
  std::vector<float> texels(vk::blockSize(image.format) / sizeof(float) * std::size_t{image.width} * image.height);
  const GpuBuffer copy = buffer({}, texels.size() * sizeof(float));
  const vk::BufferImageCopy region(0, 0, 0, {image.aspect, 0, 0, 1}, {}, {image.width, image.height, 1});
  run([&](const Commands& to) { to.copyImageToBuffer(image.image, vk::ImageLayout::eGeneral, copy.buffer, region); });
  std::memcpy(texels.data(), copy.mapped, texels.size() * sizeof(float));
  return texels;
}

void waitForWrites(const Commands& to) {
  using Stage = vk::PipelineStageFlagBits2;
  using enum vk::AccessFlagBits2;
  const vk::MemoryBarrier2 barrier(Stage::eAllCommands, eMemoryWrite, Stage::eAllCommands | Stage::eHost,
                                   eMemoryRead | eMemoryWrite | eHostRead);
  to.pipelineBarrier2(vk::DependencyInfo({}, barrier));
}

}  // namespace engine
