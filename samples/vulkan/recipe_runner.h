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
    std::string vertex, fragment;   // GLSL; of the fragment stage what stands behind the seam
    std::vector<Binding> bindings;  // others than the recipe's
  };

  //   images     by role, of the largest picture's size
  //   fragments  room of each stage's lists, where the recipe keeps some
  RecipeRunner(Gpu& gpu, const pld_recipe* recipe, vk::Extent2D extent, std::map<pld_role, GpuImage> images,
               uint64_t fragments, Material material);

  // Records a frame.
  //   draw  the meshes of a stage into an area, all else being bound
  using Draw = std::function<void(const Commands&, const GpuPipeline&, pld_stage, vk::Rect2D)>;
  void record(const Commands& to, const pld_frame& frame, const Draw& draw);
  // After it ran: whether every list had room.
  bool hadRoom() const;

 private:
  GpuPipeline pipelineOf(const pld_recipe_pass& pass);
  std::vector<Binding> bindingsOf(const pld_recipe_pass& pass, uint32_t repeat, vk::DeviceSize constants) const;
  Targets targetsOf(const pld_recipe_pass& pass, uint32_t repeat, vk::Rect2D area) const;
  void run(const Commands& to, uint32_t index, uint32_t repeat, vk::Rect2D area, vk::DeviceSize constants,
           const Draw& draw);

  Gpu& gpu_;
  const pld_recipe* recipe_;
  vk::Extent2D extent_;
  uint64_t fragments_;
  Material material_;
  std::vector<GpuImage> images_;
  std::vector<GpuBuffer> buffers_;
  std::vector<vk::DeviceSize> zeroed_;
  std::vector<GpuPipeline> pipelines_;
  GpuBuffer constants_, counts_;  // of every pass and repeat; fragments that came, a word for each pass
};

}  // namespace engine
