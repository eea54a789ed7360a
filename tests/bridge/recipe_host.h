// A GL host that runs a recipe's passes itself, by a loop of its own: what a Vulkan engine does, where bits can be
// compared with the GL pass.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine_bridge/include/pellucid/recipe.h"
#include "tests/bridge/host.h"

namespace pellucid::test {

class RecipeHost {
 public:
  //   main  GLSL behind the seam, of a stage's draws
  RecipeHost(const pld_recipe& recipe, const Host& host, const std::function<std::string(pld_stage)>& main);
  ~RecipeHost();
  RecipeHost(const RecipeHost&) = delete;
  RecipeHost& operator=(const RecipeHost&) = delete;

  // Runs all passes; the picture is in the host's output.
  //   draw  with the program in use, over the whole viewport
  void run(const pld_frame& frame, const std::function<void(pld_stage, GLuint program)>& draw);
  // Of the image of one of the roles behind PLD_ROLE_PICTURE, in four channels; empty where the recipe has none.
  std::vector<float> output(pld_role role) const;

 private:
  struct Image {
    GLuint texture = 0;
    std::vector<GLuint> layers;  // each alone, of arrays
  };

  Image makeImage(uint32_t index) const;
  GLuint viewOf(const pld_recipe_read& read, uint32_t repeat) const;
  void attach(const pld_recipe_pass& pass, uint32_t repeat) const;
  void setBlending(const pld_recipe_pass& pass) const;
  void bind(const pld_recipe_pass& pass, uint32_t repeat) const;

  const pld_recipe& recipe_;
  const Host& host_;
  std::vector<Image> images_;
  std::vector<GLuint> programs_, buffers_;
  GLuint frame_ = 0, constants_ = 0, sampler_ = 0, vertexArray_ = 0;
};

}  // namespace pellucid::test
