// A Vulkan 1.3 device without a window, under the validation layers, and what a small renderer makes on it. Everything
// made lives as long as the device.
#pragma once
#include <array>
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
  vk::ImageAspectFlags aspect;
  uint32_t width = 0, height = 0;
  vk::ImageView whole;                // an array where there are several layers
  std::vector<vk::ImageView> layers;  // each alone
};

struct GpuBuffer {
  vk::Buffer buffer;
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

// What a pass reads, and what it draws into: no recipe has more than 8 outputs. One without a format has no image.
struct GpuPass {
  std::vector<Binding> bindings;
  vk::Rect2D area;
  std::array<vk::Format, 8> formats{};
  std::array<vk::PipelineColorBlendAttachmentState, 8> blends{};
  std::array<vk::RenderingAttachmentInfo, 8> outputs{};
  vk::Format depthFormat = vk::Format::eUndefined;  // or depth is tested
  vk::CompareOp compare = vk::CompareOp::eAlways;
  bool writesDepth = false;
  vk::RenderingAttachmentInfo depth;
};
vk::RenderingAttachmentInfo target(vk::ImageView view, vk::AttachmentLoadOp load, const vk::ClearValue& clear = {});

struct GpuPipeline {
  vk::PipelineLayout layout;  // with room for 128 bytes of push constants
  vk::Pipeline pipeline;
};

class Gpu {
 public:
  Gpu();

  GpuImage image(vk::Format format, int width, int height, uint32_t layers = 1, uint32_t levels = 1);
  //   filled  null, or `size` bytes
  GpuBuffer buffer(vk::BufferUsageFlags usage, vk::DeviceSize size, const void* filled = nullptr);
  // For passes that differ from this one in area and images alone. GLSL; with `meshes` the vertices of engine_scene.h.
  GpuPipeline pipeline(const GpuPass& pass, const std::string& vertex, const std::string& fragment, bool meshes);

  // Makes visible what was written before, binds, and draws: a triangle over all of the area, or what `draw` does.
  void draw(const Commands& to, const GpuPipeline& pipeline, const GpuPass& pass,
            const std::function<void()>& draw = nullptr) const;
  // Records, submits and waits.
  void run(const std::function<void(const Commands&)>& record) const;
  // All components as floats, of formats that have such.
  std::vector<float> read(const GpuImage& image);

 private:
  vk::raii::DeviceMemory memory(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const;
  vk::raii::ShaderModule compile(const std::string& text, bool vertex) const;
  template <class Handle>
  auto keep(Handle made) {
    kept_.push_front(std::make_shared<Handle>(std::move(made)));
    return **static_cast<Handle*>(kept_.front().get());
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

inline int validationMessages = 0;  // errors and warnings of the layers so far
// What was written before is seen after: one barrier for all.
void waitForWrites(const Commands& to);

}  // namespace engine
