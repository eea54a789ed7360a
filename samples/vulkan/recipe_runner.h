// Runs a recipe of Pellucid on Vulkan: a loop over its images, buffers and passes. Knows no method, tier or feature.
#pragma once
#include <pellucid/recipe.h>

#include <map>

#include "samples/vulkan/gpu.h"

namespace engine {

class RecipeRunner {
 public:
  // What the host draws its transparent geometry with.
  struct Material {
    std::string vertex, fragment;  // GLSL; of the fragment stage what stands behind the seam
    vk::DescriptorSetLayout set;   // its own, 0; the recipe was made for set 1
  };

  //   images     by role, of the largest picture's size
  //   fragments  room of each stage's lists, where the recipe keeps some
  RecipeRunner(Gpu& gpu, const pld_recipe* recipe, int width, int height, std::map<pld_role, GpuImage> images,
               uint64_t fragments, const Material& material);

  // Records a frame.
  //   draw  the meshes, with pipeline and set 1 bound, and the layout for set 0
  using Draw = std::function<void(vk::CommandBuffer, vk::PipelineLayout)>;
  void record(vk::CommandBuffer commands, const pld_frame& frame, const Draw& draw);
  // After it ran: whether every list had room.
  bool hadRoom() const;

 private:
  struct Pass {
    vk::DescriptorSetLayout setLayout;
    vk::PipelineLayout layout;
    vk::Pipeline pipeline;
  };

  Pass passOf(const pld_recipe_pass& pass, const Material& material);
  std::vector<Binding> bindingsOf(const pld_recipe_pass& pass, uint32_t repeat, vk::DeviceSize constants) const;
  void run(vk::CommandBuffer commands, uint32_t index, uint32_t repeat, vk::Rect2D area, vk::DeviceSize constants,
           const Draw& draw);
  void emptyLists(vk::CommandBuffer commands, const pld_recipe_pass& pass);
  void beginRendering(vk::CommandBuffer commands, const pld_recipe_pass& pass, uint32_t repeat, vk::Rect2D area);

  Gpu& gpu_;
  const pld_recipe* recipe_;
  int width_, height_;
  uint64_t fragments_;
  std::vector<GpuImage> images_;
  std::vector<GpuBuffer> buffers_;
  std::vector<vk::DeviceSize> zeroed_;
  std::vector<Pass> passes_;
  GpuBuffer constants_, counts_;  // of every pass and repeat; fragments that came, a word for each pass
};

}  // namespace engine
