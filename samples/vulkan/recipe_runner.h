// Runs a recipe of Pellucid on Vulkan: a loop over its images, buffers and passes. Knows no method, tier or feature.
#pragma once
#include <pellucid/recipe.h>

#include <map>

#include "samples/vulkan/gpu.h"

namespace engine {

class RecipeRunner {
 public:
  struct Host {
    const pld_recipe* recipe = nullptr;
    int32_t width = 0, height = 0;        // of the largest picture
    std::map<pld_role, GpuImage> images;  // of that size
    uint64_t fragments = 0;               // room of each stage's lists, where the recipe keeps some
    std::string vertex, fragment;         // of the host's draws; of the second what stands behind the recipe's text
    std::vector<Binding> bindings;        // of these, others than the recipe's
  };
  RecipeRunner(Gpu& gpu, Host host);

  // Records a frame or, of shadow maps, a face; the other is null.
  //   draw  the host's meshes of a stage, all else being bound
  using Draw = std::function<void(const GpuPipeline&, pld_stage)>;
  void record(const Commands& to, const pld_frame* frame, const pld_shadow_view* face, const Draw& draw);
  // After it ran: whether every list had room.
  bool hadRoom() const;
  const GpuImage& image(pld_role role) const { return host_.images.at(role); }

 private:
  GpuPass passOf(const pld_recipe_pass& pass, uint32_t turn, vk::DeviceSize constants) const;

  Gpu& gpu_;
  Host host_;
  std::vector<GpuImage> images_;
  std::vector<GpuBuffer> buffers_;
  std::vector<vk::DeviceSize> zeroed_;
  std::vector<GpuPipeline> pipelines_;
  GpuBuffer constants_, counts_;  // of every pass and repeat; fragments that came, a word for each pass
};

}  // namespace engine
