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
namespace {

int said = 0;

VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  ++said;
  std::fprintf(stderr, "validation: %s\n", data->pMessage);
  return VK_FALSE;
}

bool isDepth(vk::Format format) {
  return format == vk::Format::eD32Sfloat;
}

vk::ImageAspectFlags aspectOf(vk::Format format) {
  return isDepth(format) ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
}

vk::raii::Instance makeInstance(const vk::raii::Context& context, const void* layers) {
  const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
  const char* const layer = "VK_LAYER_KHRONOS_validation";
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  return {context, vk::InstanceCreateInfo{.pNext = layers, .pApplicationInfo = &application}
                       .setPEnabledLayerNames(layer)
                       .setPEnabledExtensionNames(extension)};
}

// Lists in fragment shaders and sums in double precision are the exact tier's.
vk::raii::Device makeDevice(const vk::raii::PhysicalDevice& physical) {
  const vk::PhysicalDeviceVulkan13Features newer{.synchronization2 = true, .dynamicRendering = true};
  const vk::PhysicalDeviceFeatures features{
      .independentBlend = true, .fragmentStoresAndAtomics = true, .shaderFloat64 = true};
  const float priority = 1.0f;
  const char* const extension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
  const auto queue = vk::DeviceQueueCreateInfo{}.setQueuePriorities(priority);  // family 0 draws on every device
  return {physical, vk::DeviceCreateInfo{.pNext = &newer, .pEnabledFeatures = &features}
                        .setQueueCreateInfos(queue)
                        .setPEnabledExtensionNames(extension)};
}

}  // namespace

int validationMessages() {
  return said;
}

vk::RenderingAttachmentInfo target(vk::ImageView view, vk::AttachmentLoadOp load, const vk::ClearValue& clear) {
  return {.imageView = view,
          .imageLayout = vk::ImageLayout::eGeneral,
          .loadOp = load,
          .storeOp = vk::AttachmentStoreOp::eStore,
          .clearValue = clear};
}

Gpu::Gpu() {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  glslang::InitializeProcess();
  const vk::DebugUtilsMessengerCreateInfoEXT messenger{.messageSeverity = Severity::eWarning | Severity::eError,
                                                       .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
                                                       .pfnUserCallback = hear};
  const auto synchronisation = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const auto layers = vk::ValidationFeaturesEXT{.pNext = &messenger}.setEnabledValidationFeatures(synchronisation);
  instance_ = makeInstance(context_, &layers);
  messenger_ = {instance_, messenger};
  for (const vk::raii::PhysicalDevice& one : instance_.enumeratePhysicalDevices())
    if (!*physical_ && one.getProperties().apiVersion >= VK_API_VERSION_1_3) physical_ = one;
  if (!*physical_) stop("no device with Vulkan 1.3");
  std::printf("%s\n", physical_.getProperties().deviceName.data());
  device_ = makeDevice(physical_);
  commands_ = {device_, vk::CommandPoolCreateInfo{}};
  constexpr auto edge = vk::SamplerAddressMode::eClampToEdge;
  vk::SamplerCreateInfo sampler{.addressModeU = edge, .addressModeV = edge};
  nearest_ = {device_, sampler};
  sampler.magFilter = sampler.minFilter = vk::Filter::eLinear;
  sampler.mipmapMode = vk::SamplerMipmapMode::eLinear;
  sampler.maxLod = VK_LOD_CLAMP_NONE;
  smooth_ = {device_, sampler};
}

vk::raii::DeviceMemory Gpu::memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const {
  const vk::PhysicalDeviceMemoryProperties all = physical_.getMemoryProperties();
  for (uint32_t type = 0; type < all.memoryTypeCount; ++type)
    if (needs.memoryTypeBits >> type & 1u && (all.memoryTypes[type].propertyFlags & wanted) == wanted)
      return {device_, vk::MemoryAllocateInfo{.allocationSize = needs.size, .memoryTypeIndex = type}};
  stop("no memory of the kind that is wanted");
}

GpuImage Gpu::image(vk::Format format, vk::Extent2D extent, uint32_t layers, uint32_t levels) {
  using Usage = vk::ImageUsageFlagBits;
  const auto drawn = isDepth(format) ? Usage::eDepthStencilAttachment : Usage::eColorAttachment;
  vk::raii::Image image(
      device_, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                   .format = format,
                                   .extent = {extent.width, extent.height, 1},
                                   .mipLevels = levels,
                                   .arrayLayers = layers,
                                   .usage = Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst | drawn});
  auto at = memory(image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
  image.bindMemory(keep(std::move(at)), 0);
  GpuImage made{.image = keep(std::move(image)), .format = format, .extent = extent};
  const auto view = [&](vk::ImageViewType type, uint32_t first, uint32_t count) {
    return keep(vk::raii::ImageView(
        device_, vk::ImageViewCreateInfo{.image = made.image,
                                         .viewType = type,
                                         .format = format,
                                         .subresourceRange = {aspectOf(format), 0, levels, first, count}}));
  };
  for (uint32_t i = 0; i < layers; ++i) made.layers.push_back(view(vk::ImageViewType::e2D, i, 1));
  made.whole = layers > 1 ? view(vk::ImageViewType::e2DArray, 0, layers) : made.layers[0];
  run([&](const Commands& to) {  // into the one layout that serves all uses, where it stays
    const vk::ImageMemoryBarrier2 barrier{.dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                          .newLayout = vk::ImageLayout::eGeneral,
                                          .image = made.image,
                                          .subresourceRange = {aspectOf(format), 0, levels, 0, layers}};
    to.pipelineBarrier2(vk::DependencyInfo{}.setImageMemoryBarriers(barrier));
  });
  return made;
}

GpuBuffer Gpu::buffer(vk::BufferUsageFlags usage, vk::DeviceSize size, const void* filled) {
  using Usage = vk::BufferUsageFlagBits;
  using Memory = vk::MemoryPropertyFlagBits;
  vk::raii::Buffer buffer(
      device_, vk::BufferCreateInfo{.size = size, .usage = usage | Usage::eTransferSrc | Usage::eTransferDst});
  auto at = memory(buffer.getMemoryRequirements(), Memory::eHostVisible | Memory::eHostCoherent);
  buffer.bindMemory(*at, 0);
  auto* const mapped = static_cast<char*>(at.mapMemory(0, VK_WHOLE_SIZE));
  if (filled) std::memcpy(mapped, filled, size);
  keep(std::move(at));
  return {keep(std::move(buffer)), size, mapped};
}

vk::raii::ShaderModule Gpu::compile(const std::string& text, bool vertex) const {
  const EShLanguage stage = vertex ? EShLangVertex : EShLangFragment;
  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  glslang::TShader shader(stage);
  const char* const source = text.c_str();
  shader.setStrings(&source, 1);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  glslang::TProgram program;
  program.addShader(&shader);
  if (!shader.parse(GetDefaultResources(), 450, false, rules)) stop(shader.getInfoLog());
  if (!program.link(rules)) stop(program.getInfoLog());
  std::vector<uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(stage), words);
  return {device_, vk::ShaderModuleCreateInfo{}.setCode(words)};
}

GpuPipeline Gpu::pipeline(const PipelineShape& shape) {
  using Stage = vk::ShaderStageFlagBits;
  using Format = vk::Format;
  std::vector<vk::DescriptorSetLayoutBinding> places;
  for (const Binding& one : shape.bindings) places.push_back({one.place, one.type, 1, Stage::eAllGraphics});
  constexpr auto pushed = vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR;
  const vk::DescriptorSetLayout set = keep(
      vk::raii::DescriptorSetLayout(device_, vk::DescriptorSetLayoutCreateInfo{.flags = pushed}.setBindings(places)));
  const vk::PushConstantRange constants{Stage::eAllGraphics, 0, 128};
  const vk::PipelineLayout layout = keep(vk::raii::PipelineLayout(
      device_, vk::PipelineLayoutCreateInfo{}.setSetLayouts(set).setPushConstantRanges(constants)));

  const vk::raii::ShaderModule vertex = compile(shape.vertex, true), fragment = compile(shape.fragment, false);
  const vk::PipelineShaderStageCreateInfo stages[] = {
      {.stage = Stage::eVertex, .module = *vertex, .pName = "main"},
      {.stage = Stage::eFragment, .module = *fragment, .pName = "main"}};
  const vk::VertexInputBindingDescription binding{.stride = sizeof(Vertex)};
  const vk::VertexInputAttributeDescription attributes[] = {
      {0, 0, Format::eR32G32B32Sfloat, offsetof(Vertex, position)},
      {1, 0, Format::eR32G32B32Sfloat, offsetof(Vertex, normal)},
      {2, 0, Format::eR32G32B32A32Sfloat, offsetof(Vertex, colour)},
      {3, 0, Format::eR32G32Sfloat, offsetof(Vertex, uv)}};
  vk::PipelineVertexInputStateCreateInfo input;
  if (shape.meshes) input.setVertexBindingDescriptions(binding).setVertexAttributeDescriptions(attributes);
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1.0f};
  const vk::PipelineMultisampleStateCreateInfo samples;
  const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = shape.depth != Format::eUndefined,
                                                      .depthWriteEnable = shape.writesDepth,
                                                      .depthCompareOp = shape.compare};
  const auto blend = vk::PipelineColorBlendStateCreateInfo{}.setAttachments(shape.blends);
  const vk::DynamicState dynamics[] = {vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                                       vk::DynamicState::eCullMode, vk::DynamicState::eFrontFace};
  const auto dynamic = vk::PipelineDynamicStateCreateInfo{}.setDynamicStates(dynamics);
  const auto targets =
      vk::PipelineRenderingCreateInfo{.depthAttachmentFormat = shape.depth}.setColorAttachmentFormats(shape.colours);
  const auto info = vk::GraphicsPipelineCreateInfo{.pNext = &targets,
                                                   .pVertexInputState = &input,
                                                   .pInputAssemblyState = &assembly,
                                                   .pViewportState = &viewport,
                                                   .pRasterizationState = &raster,
                                                   .pMultisampleState = &samples,
                                                   .pDepthStencilState = &depth,
                                                   .pColorBlendState = &blend,
                                                   .pDynamicState = &dynamic,
                                                   .layout = layout}
                        .setStages(stages);
  return {layout, keep(vk::raii::Pipeline(device_, nullptr, info))};
}

bool Gpu::blends(vk::Format format) const {
  const vk::FormatFeatureFlags features = physical_.getFormatProperties(format).optimalTilingFeatures;
  return static_cast<bool>(features & vk::FormatFeatureFlagBits::eColorAttachmentBlend);
}

void Gpu::begin(const Commands& to, const GpuPipeline& pipeline, const Targets& into,
                const std::vector<Binding>& bindings) const {
  waitForWrites(to);
  to.beginRendering(
      vk::RenderingInfo{.renderArea = into.area, .layerCount = 1, .pDepthAttachment = &into.depth}.setColorAttachments(
          into.colours));
  const vk::Extent2D extent = into.area.extent;
  to.setViewport(0, vk::Viewport{static_cast<float>(into.area.offset.x), static_cast<float>(into.area.offset.y),
                                 static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0f, 1.0f});
  to.setScissor(0, into.area);
  to.setCullMode(vk::CullModeFlagBits::eNone);
  to.setFrontFace(vk::FrontFace::eCounterClockwise);
  to.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline.pipeline);
  for (const Binding& one : bindings) {
    const vk::DescriptorImageInfo image{*(one.smooth ? smooth_ : nearest_), one.view, vk::ImageLayout::eGeneral};
    to.pushDescriptorSetKHR(vk::PipelineBindPoint::eGraphics, pipeline.layout, 0,
                            vk::WriteDescriptorSet{.dstBinding = one.place,
                                                   .descriptorCount = 1,
                                                   .descriptorType = one.type,
                                                   .pImageInfo = &image,
                                                   .pBufferInfo = &one.part});
  }
}

void Gpu::run(const std::function<void(const Commands&)>& record) const {
  const vk::raii::CommandBuffers all(device_, {.commandPool = *commands_, .commandBufferCount = 1});
  const Commands& commands = all[0];
  commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  waitForWrites(commands);
  commands.end();
  const vk::raii::Queue queue = device_.getQueue(0, 0);
  queue.submit(vk::SubmitInfo{}.setCommandBuffers(*commands));
  queue.waitIdle();
}

std::vector<float> Gpu::read(const GpuImage& image) {
  const vk::Extent2D extent = image.extent;
  const std::size_t bytes = vk::blockSize(image.format) * std::size_t{extent.width} * extent.height;
  const GpuBuffer copy = buffer({}, bytes);
  run([&](const Commands& to) {
    const vk::BufferImageCopy region{.imageSubresource = {aspectOf(image.format), 0, 0, 1},
                                     .imageExtent = {extent.width, extent.height, 1}};
    to.copyImageToBuffer(image.image, vk::ImageLayout::eGeneral, copy.buffer, region);
  });
  std::vector<float> texels(bytes / sizeof(float));
  std::memcpy(texels.data(), copy.mapped, bytes);
  return texels;
}

void waitForWrites(const Commands& to) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  const vk::MemoryBarrier2 barrier{.srcStageMask = Stage::eAllCommands,
                                   .srcAccessMask = Access::eMemoryWrite,
                                   .dstStageMask = Stage::eAllCommands | Stage::eHost,
                                   .dstAccessMask = Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead};
  to.pipelineBarrier2(vk::DependencyInfo{}.setMemoryBarriers(barrier));
}

}  // namespace engine
