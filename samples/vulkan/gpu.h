// A Vulkan 1.3 device without a window, under the validation layers, and what a small renderer makes on it. Everything
// made lives as long as the device.
#pragma once
#include <functional>
#include <string>
#include <vector>
#include <vulkan/vulkan.hpp>
#include <vulkan/vulkan_format_traits.hpp>

namespace engine {

constexpr uint32_t kPushedBytes = 128;  // that every pipeline takes, and every device has

struct GpuImage {
  vk::Image image;
  vk::Format format = vk::Format::eUndefined;
  uint32_t width = 0, height = 0;
  std::vector<vk::ImageView> layers;  // each alone
  vk::ImageView whole;                // an array where there are several
};

struct GpuBuffer {
  vk::Buffer buffer;
  vk::DeviceSize size = 0;
  char* mapped = nullptr;
};

// What a shader finds at a binding: an image, or a part of a buffer.
struct Binding {
  uint32_t place;
  vk::DescriptorType type;
  vk::ImageView view;
  vk::DescriptorBufferInfo part;
};

// A graphics pipeline over dynamic viewport, scissor, cull mode and front face.
struct PipelineShape {
  std::string vertex, fragment;  // GLSL
  vk::PipelineLayout layout;
  bool meshes = false;  // vertices of a position and a normal, else none
  std::vector<vk::Format> colours;
  std::vector<vk::PipelineColorBlendAttachmentState> blends;
  vk::Format depth = vk::Format::eUndefined;
  vk::CompareOp compare = vk::CompareOp::eAlways;
  bool writesDepth = false;
};

class Gpu {
 public:
  Gpu();
  ~Gpu();

  GpuImage image(vk::Format format, int width, int height, uint32_t layers = 1);
  GpuBuffer buffer(vk::DeviceSize size, vk::BufferUsageFlags usage);
  vk::DescriptorSetLayout setLayout(const std::vector<Binding>& bindings);
  vk::PipelineLayout pipelineLayout(const std::vector<vk::DescriptorSetLayout>& sets);
  vk::Pipeline pipeline(const PipelineShape& shape);
  vk::DescriptorSet descriptorSet(vk::DescriptorSetLayout layout, const std::vector<Binding>& bindings);
  bool blends(vk::Format format) const;

  // Records, submits and waits.
  void run(const std::function<void(vk::CommandBuffer)>& record);
  // All components as floats, of formats that have such.
  std::vector<float> read(const GpuImage& image);

 private:
  void makeDevice();
  vk::DeviceMemory memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted);
  vk::UniqueShaderModule compile(const std::string& text, bool vertex);

  vk::UniqueInstance instance_;
  vk::DispatchLoaderDynamic loader_;
  vk::UniqueHandle<vk::DebugUtilsMessengerEXT, vk::DispatchLoaderDynamic> messenger_;
  vk::PhysicalDevice physical_;
  vk::UniqueDevice device_;
  vk::UniqueCommandPool commands_;
  vk::UniqueSampler nearest_;
  vk::UniqueDescriptorPool pool_;
  std::vector<vk::UniqueDeviceMemory> memories_;
  std::vector<vk::UniqueImage> images_;
  std::vector<vk::UniqueImageView> views_;
  std::vector<vk::UniqueBuffer> buffers_;
  std::vector<vk::UniqueDescriptorSetLayout> setLayouts_;
  std::vector<vk::UniquePipelineLayout> layouts_;
  std::vector<vk::UniquePipeline> pipelines_;
};

// Errors and warnings of the validation layers so far.
int validationMessages();
// What was written before is seen after: one barrier for all.
void waitForWrites(vk::CommandBuffer commands);
void setArea(vk::CommandBuffer commands, vk::Rect2D area);

}  // namespace engine
