// A Vulkan 1.3 device without a window, under the validation layers, and what a small renderer makes on it. Everything
// made lives as long as the device.
#pragma once
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS  // structs are filled in by the names of their members
#include <forward_list>
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace engine {

using Commands = vk::raii::CommandBuffer;

struct GpuImage {
  vk::Image image;
  vk::Format format = vk::Format::eUndefined;
  vk::Extent2D extent;
  vk::ImageView whole;                // an array where there are several layers
  std::vector<vk::ImageView> layers;  // each alone
};

struct GpuBuffer {
  vk::Buffer buffer;
  vk::DeviceSize size = 0;
  char* mapped = nullptr;
};

// What a shader finds at a binding of set 0, the only one: an image, or a part of a buffer.
struct Binding {
  uint32_t place = 0;
  vk::DescriptorType type = vk::DescriptorType::eCombinedImageSampler;
  vk::ImageView view;
  vk::DescriptorBufferInfo part;
  bool smooth = false;  // linear between texels and levels, else the nearest texel
};

// A graphics pipeline over dynamic viewport, scissor, cull mode and front face.
struct PipelineShape {
  std::string vertex, fragment;   // GLSL
  std::vector<Binding> bindings;  // places and types
  bool meshes = false;            // whether there are vertices, as engine_scene.h has them
  std::vector<vk::Format> colours;
  std::vector<vk::PipelineColorBlendAttachmentState> blends;
  vk::Format depth = vk::Format::eUndefined;
  vk::CompareOp compare = vk::CompareOp::eAlways;
  bool writesDepth = false;
};

struct GpuPipeline {
  vk::PipelineLayout layout;  // with room for 128 bytes of push constants
  vk::Pipeline pipeline;
};

// What a pass draws into.
struct Targets {
  vk::Rect2D area;
  std::vector<vk::RenderingAttachmentInfo> colours;
  vk::RenderingAttachmentInfo depth;  // without a view where there is none
};
vk::RenderingAttachmentInfo target(vk::ImageView view, vk::AttachmentLoadOp load, const vk::ClearValue& clear = {});

class Gpu {
 public:
  Gpu();

  GpuImage image(vk::Format format, vk::Extent2D extent, uint32_t layers = 1, uint32_t levels = 1);
  //   filled  null, or `size` bytes
  GpuBuffer buffer(vk::BufferUsageFlags usage, vk::DeviceSize size, const void* filled = nullptr);
  GpuPipeline pipeline(const PipelineShape& shape);
  bool blends(vk::Format format) const;

  // Makes visible what was written before, begins to draw into all of the area, and binds.
  void begin(const Commands& to, const GpuPipeline& pipeline, const Targets& into,
             const std::vector<Binding>& bindings) const;
  // Records, submits and waits.
  void run(const std::function<void(const Commands&)>& record) const;
  // All components as floats, of formats that have such.
  std::vector<float> read(const GpuImage& image);

 private:
  vk::raii::DeviceMemory memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const;
  vk::raii::ShaderModule compile(const std::string& text, bool vertex) const;
  template <class Handle>
  auto keep(Handle&& made) {
    const auto kept = std::make_shared<Handle>(std::move(made));
    kept_.push_front(kept);
    return **kept;
  }

  vk::raii::Context context_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  vk::raii::PhysicalDevice physical_ = nullptr;
  vk::raii::Device device_ = nullptr;
  vk::raii::CommandPool commands_ = nullptr;
  vk::raii::Sampler nearest_ = nullptr, smooth_ = nullptr;
  std::forward_list<std::shared_ptr<void>> kept_;  // the newest goes first
};

// Errors and warnings of the validation layers so far.
int validationMessages();
// What was written before is seen after: one barrier for all.
void waitForWrites(const Commands& to);

}  // namespace engine
