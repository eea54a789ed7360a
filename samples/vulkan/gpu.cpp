#include "samples/vulkan/gpu.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstdio>
#include <cstring>

#include "samples/engine/engine_scene.h"

namespace engine {
namespace {

using Usage = vk::ImageUsageFlagBits;

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

}  // namespace

int validationMessages() {
  return said;
}

Gpu::Gpu() {
  glslang::InitializeProcess();
  const vk::ApplicationInfo application("engine", 1, nullptr, 0, VK_API_VERSION_1_3);
  const char* const layer = "VK_LAYER_KHRONOS_validation";
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Kind = vk::DebugUtilsMessageTypeFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT messenger({}, Severity::eWarning | Severity::eError, Kind::eValidation,
                                                       hear);
  const auto synchronisation = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features(1, &synchronisation, 0, nullptr, &messenger);
  instance_ = vk::createInstanceUnique({{}, &application, 1, &layer, 1, &extension, &features});
  loader_ = vk::DispatchLoaderDynamic(*instance_, vkGetInstanceProcAddr);
  messenger_ = instance_->createDebugUtilsMessengerEXTUnique(messenger, nullptr, loader_);
  makeDevice();
  commands_ = device_->createCommandPoolUnique({});
  nearest_ = device_->createSamplerUnique(vk::SamplerCreateInfo()
                                              .setAddressModeU(vk::SamplerAddressMode::eClampToEdge)
                                              .setAddressModeV(vk::SamplerAddressMode::eClampToEdge));
  constexpr uint32_t sets = 128;
  const vk::DescriptorPoolSize sizes[] = {{vk::DescriptorType::eCombinedImageSampler, 16 * sets},
                                          {vk::DescriptorType::eUniformBuffer, sets},
                                          {vk::DescriptorType::eStorageBuffer, 6 * sets}};
  pool_ = device_->createDescriptorPoolUnique({{}, sets, sizes});
}

Gpu::~Gpu() {
  glslang::FinalizeProcess();
}

// The first device of version 1.3; lists in fragment shaders and sums in double precision are the exact tier's.
void Gpu::makeDevice() {
  for (const vk::PhysicalDevice one : instance_->enumeratePhysicalDevices())
    if (!physical_ && one.getProperties().apiVersion >= VK_API_VERSION_1_3) physical_ = one;
  if (!physical_) stop("no device with Vulkan 1.3");
  std::printf("%s\n", physical_.getProperties().deviceName.data());
  vk::PhysicalDeviceVulkan13Features newer;
  newer.setDynamicRendering(true).setSynchronization2(true);
  const auto features =
      vk::PhysicalDeviceFeatures().setIndependentBlend(true).setFragmentStoresAndAtomics(true).setShaderFloat64(true);
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, 0, 1, &priority);  // family 0 draws on every device that can
  device_ = physical_.createDeviceUnique(vk::DeviceCreateInfo({}, queue, {}, {}, &features, &newer));
}

vk::DeviceMemory Gpu::memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) {
  const vk::PhysicalDeviceMemoryProperties all = physical_.getMemoryProperties();
  uint32_t type = 0;
  while (type < all.memoryTypeCount &&
         !((needs.memoryTypeBits >> type & 1u) && (all.memoryTypes[type].propertyFlags & wanted) == wanted))
    ++type;
  if (type == all.memoryTypeCount) stop("no memory of the kind that is wanted");
  return *memories_.emplace_back(device_->allocateMemoryUnique({needs.size, type}));
}

GpuImage Gpu::image(vk::Format format, int width, int height, uint32_t layers) {
  GpuImage made;
  made.format = format;
  made.width = static_cast<uint32_t>(width);
  made.height = static_cast<uint32_t>(height);
  const auto drawn = isDepth(format) ? Usage::eDepthStencilAttachment : Usage::eColorAttachment;
  made.image = *images_.emplace_back(device_->createImageUnique(
      vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {made.width, made.height, 1}, 1, layers)
          .setUsage(Usage::eSampled | Usage::eTransferSrc | drawn)));
  device_->bindImageMemory(
      made.image, memory(device_->getImageMemoryRequirements(made.image), vk::MemoryPropertyFlagBits::eDeviceLocal), 0);
  const auto view = [&](vk::ImageViewType type, uint32_t first, uint32_t count) {
    return *views_.emplace_back(
        device_->createImageViewUnique({{}, made.image, type, format, {}, {aspectOf(format), 0, 1, first, count}}));
  };
  for (uint32_t i = 0; i < layers; ++i) made.layers.push_back(view(vk::ImageViewType::e2D, i, 1));
  made.whole = layers > 1 ? view(vk::ImageViewType::e2DArray, 0, layers) : made.layers[0];
  run([&](vk::CommandBuffer commands) {  // into the one layout that serves all uses, where it stays
    vk::ImageMemoryBarrier2 barrier;
    barrier.setDstStageMask(vk::PipelineStageFlagBits2::eAllCommands)
        .setNewLayout(vk::ImageLayout::eGeneral)
        .setImage(made.image)
        .setSubresourceRange({aspectOf(format), 0, 1, 0, layers});
    commands.pipelineBarrier2({{}, {}, {}, barrier});
  });
  return made;
}

GpuBuffer Gpu::buffer(vk::DeviceSize size, vk::BufferUsageFlags usage) {
  GpuBuffer made;
  made.size = size;
  made.buffer = *buffers_.emplace_back(device_->createBufferUnique(
      {{}, size, usage | vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst}));
  const vk::DeviceMemory at =
      memory(device_->getBufferMemoryRequirements(made.buffer),
             vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
  device_->bindBufferMemory(made.buffer, at, 0);
  made.mapped = static_cast<char*>(device_->mapMemory(at, 0, VK_WHOLE_SIZE));
  return made;
}

vk::DescriptorSetLayout Gpu::setLayout(const std::vector<Binding>& bindings) {
  std::vector<vk::DescriptorSetLayoutBinding> places;
  for (const Binding& one : bindings)
    places.emplace_back(one.place, one.type, 1, vk::ShaderStageFlagBits::eAllGraphics);
  return *setLayouts_.emplace_back(device_->createDescriptorSetLayoutUnique({{}, places}));
}

vk::PipelineLayout Gpu::pipelineLayout(const std::vector<vk::DescriptorSetLayout>& sets) {
  const vk::PushConstantRange pushed(vk::ShaderStageFlagBits::eAllGraphics, 0, kPushedBytes);
  return *layouts_.emplace_back(device_->createPipelineLayoutUnique({{}, sets, pushed}));
}

vk::UniqueShaderModule Gpu::compile(const std::string& text, bool vertex) {
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
  return device_->createShaderModuleUnique({{}, words});
}

vk::Pipeline Gpu::pipeline(const PipelineShape& shape) {
  using Stage = vk::ShaderStageFlagBits;
  const vk::UniqueShaderModule vertex = compile(shape.vertex, true), fragment = compile(shape.fragment, false);
  const vk::PipelineShaderStageCreateInfo stages[] = {{{}, Stage::eVertex, *vertex, "main"},
                                                      {{}, Stage::eFragment, *fragment, "main"}};
  const vk::VertexInputBindingDescription binding(0, sizeof(Vertex));
  const vk::VertexInputAttributeDescription attributes[] = {{0, 0, vk::Format::eR32G32B32Sfloat, 0},
                                                            {1, 0, vk::Format::eR32G32B32Sfloat, sizeof(glm::vec3)}};
  const vk::PipelineVertexInputStateCreateInfo input({}, shape.meshes, &binding, shape.meshes ? 2 : 0, attributes);
  const vk::PipelineInputAssemblyStateCreateInfo assembly({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  const auto raster = vk::PipelineRasterizationStateCreateInfo().setLineWidth(1.0f);
  const vk::PipelineMultisampleStateCreateInfo samples;
  const vk::PipelineDepthStencilStateCreateInfo depth({}, shape.depth != vk::Format::eUndefined, shape.writesDepth,
                                                      shape.compare);
  const vk::PipelineColorBlendStateCreateInfo blend({}, false, {}, shape.blends);
  const vk::DynamicState dynamics[] = {vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                                       vk::DynamicState::eCullMode, vk::DynamicState::eFrontFace};
  const vk::PipelineDynamicStateCreateInfo dynamic({}, dynamics);
  const vk::PipelineRenderingCreateInfo targets(0, shape.colours, shape.depth);
  const vk::GraphicsPipelineCreateInfo info({}, stages, &input, &assembly, nullptr, &viewport, &raster, &samples,
                                            &depth, &blend, &dynamic, shape.layout, {}, 0, {}, 0, &targets);
  return *pipelines_.emplace_back(device_->createGraphicsPipelineUnique({}, info).value);
}

vk::DescriptorSet Gpu::descriptorSet(vk::DescriptorSetLayout layout, const std::vector<Binding>& bindings) {
  const vk::DescriptorSet set = device_->allocateDescriptorSets({*pool_, layout})[0];
  for (const Binding& one : bindings) {
    const vk::DescriptorImageInfo image(*nearest_, one.view, vk::ImageLayout::eGeneral);
    device_->updateDescriptorSets(vk::WriteDescriptorSet(set, one.place, 0, 1, one.type, &image, &one.part), {});
  }
  return set;
}

bool Gpu::blends(vk::Format format) const {
  const vk::FormatFeatureFlags features = physical_.getFormatProperties(format).optimalTilingFeatures;
  return static_cast<bool>(features & vk::FormatFeatureFlagBits::eColorAttachmentBlend);
}

void Gpu::run(const std::function<void(vk::CommandBuffer)>& record) {
  const auto all = device_->allocateCommandBuffersUnique({*commands_, vk::CommandBufferLevel::ePrimary, 1});
  const vk::CommandBuffer commands = *all[0];
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  waitForWrites(commands);
  commands.end();
  const vk::Queue queue = device_->getQueue(0, 0);
  queue.submit(vk::SubmitInfo({}, {}, commands));
  queue.waitIdle();
}

std::vector<float> Gpu::read(const GpuImage& image) {
  const std::size_t bytes = vk::blockSize(image.format) * std::size_t{image.width} * image.height;
  const GpuBuffer copy = buffer(bytes, {});
  run([&](vk::CommandBuffer commands) {
    const vk::BufferImageCopy region(0, 0, 0, {aspectOf(image.format), 0, 0, 1}, {}, {image.width, image.height, 1});
    commands.copyImageToBuffer(image.image, vk::ImageLayout::eGeneral, copy.buffer, region);
  });
  std::vector<float> texels(bytes / sizeof(float));
  std::memcpy(texels.data(), copy.mapped, bytes);
  return texels;
}

void waitForWrites(vk::CommandBuffer commands) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  const vk::MemoryBarrier2 barrier(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllCommands | Stage::eHost,
                                   Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead);
  commands.pipelineBarrier2({{}, barrier});
}

void setArea(vk::CommandBuffer commands, vk::Rect2D area) {
  commands.setViewport(
      0, vk::Viewport(static_cast<float>(area.offset.x), static_cast<float>(area.offset.y),
                      static_cast<float>(area.extent.width), static_cast<float>(area.extent.height), 0.0f, 1.0f));
  commands.setScissor(0, area);
  commands.setCullMode(vk::CullModeFlagBits::eNone);
  commands.setFrontFace(vk::FrontFace::eCounterClockwise);
}

}  // namespace engine
