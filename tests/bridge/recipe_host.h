// A GL host that runs a recipe's passes itself, by a loop of its own: what a Vulkan engine does, where bits can be
// compared with the GL pass.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine_bridge/include/pellucid/recipe.h"
#include "tests/bridge/host.h"

namespace pellucid::test {

// How many of two hosts' numbers have other bits. Expects as many of either.
std::size_t differingWords(const std::vector<float>& a, const std::vector<float>& b);

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
  // Of shadow maps: runs all passes for a face.
  //   draw  with the program in use, over the whole face
  void runFace(const pld_shadow_view& view, const std::function<void(GLuint program)>& draw);
  // The array of PLD_ROLE_SHADOW_MAPS.
  GLuint maps() const;
  // Of the image of one of the roles behind PLD_ROLE_PICTURE, in four channels; empty where the recipe has none.
  std::vector<float> output(pld_role role) const;

 private:
  struct Image {
    GLuint texture = 0;
    std::vector<GLuint> layers;  // each alone, of arrays
  };

  Image makeImage(uint32_t index) const;
  GLuint viewOf(const pld_recipe_read& read, uint32_t repeat) const;
  // One repeat of a pass, or one face.
  struct Turn {
    uint32_t repeat = 0;
    int32_t faceLayer = 0;
    GLuint faceDepth = 0;
  };
  GLuint layerOf(const pld_recipe_attachment& one, const Turn& turn) const;
  void attach(const pld_recipe_pass& pass, const Turn& turn) const;
  void set(uint32_t index, const Turn& turn, const std::vector<char>& constants, const int32_t area[4]) const;
  void leave() const;
  void setBlending(const pld_recipe_pass& pass) const;
  void bind(const pld_recipe_pass& pass, uint32_t repeat) const;

  const pld_recipe& recipe_;
  const Host& host_;
  std::vector<Image> images_;
  std::vector<GLuint> programs_, buffers_;
  GLuint frame_ = 0, constants_ = 0, sampler_ = 0, vertexArray_ = 0;
};

}  // namespace pellucid::test
