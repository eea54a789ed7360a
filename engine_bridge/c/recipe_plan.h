// What a pass does in a frame: its images and its passes in their order. A pure function of the permutation, from which
// the GL pass takes its own stages and recipes all they say.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine_bridge/c/stage_plan.h"
#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::c {

// What full-screen stages are told, by the names that shaders/gl has for it.
enum class StageNumber {
  pictureSize,
  texelSize,   // pictureSize of a stage whose pixels are texels of low resolution
  texelCount,  // the same under its own name
  factor,
  factorAsFloat,
  texelsAPixel,
  form,
  depthRows,
  metresPerUnit,
  level,
  lookup,
  largestSpread,
  spreadLevels,
  rowLength,
  weight,
  view
};

// Of a frame: all of it, its texels of low resolution, the spread pyramid.
enum class PartOfFrame { picture, low, pyramid };

struct PlannedImage {
  std::string name;
  pld_role role = PLD_ROLE_OWN;
  pld_format format = PLD_FORMAT_HOST;
  PartOfFrame part = PartOfFrame::picture;
  uint32_t layers = 1;
  std::array<float, 4> clear{};
};

struct PlannedRead {
  uint32_t image;
  uint32_t binding;  // of draws: beside the first of the seam's
  std::string sampler;
  int32_t layer = 0;
};

struct PlannedPass {
  std::string name;
  pld_pass_kind kind = PLD_PASS_FULL_SCREEN;
  PartOfFrame part = PartOfFrame::picture;  // that is drawn; of the pyramid one level each time
  std::vector<pld_recipe_attachment> attachments;
  std::vector<PlannedRead> reads;
  uint32_t depthImage = PLD_NO_IMAGE;
  pld_compare compare = PLD_COMPARE_NONE;
  bool writesDepth = false;
  int lists = 0;  // storage blocks
  bool emptiesLists = false;

  pld_stage stage = PLD_STAGE_LAYERS;  // of draws, and whose end other passes belong to
  std::string file;                    // of others, below shaders/
  std::vector<std::string> defines;
  std::vector<StageNumber> numbers;
  int view = 0;  // pld_view
};

struct RecipePlan {
  std::vector<PlannedImage> images;
  std::vector<PlannedPass> passes;
};

constexpr int kAtlasLayers = 2;  // of the spread pyramid

pld_format formatOf(PlaneFormat format);
// Of a texel; 0 for the host's.
int bitsOf(pld_format format);
pld_blend blendOf(PlaneBlend blend);
// Names of the blocks of shaders/gl/exact_lists.glsl.
extern const char* const kListNames[5];

}  // namespace pellucid::c
