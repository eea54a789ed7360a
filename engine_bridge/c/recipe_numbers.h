// The uniform blocks of passes: how they lie, and what a frame puts into them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

// Of a frame, for one pass.
struct FrameNumbers {
  const Permutation& permutation;
  const pld_frame& frame;
  int width;        // of the largest picture
  int atlasLayers;  // of the spread pyramid
  int view = 0;     // pld_view, where the pass shows one
};

// The block of shaders/gl/seam.glsl, PldFrame.
constexpr std::size_t kSeamFloats = 20;
//   pixelsATexel  of PLD_STAGE_LOW, else 1
void fillSeam(const FrameNumbers& numbers, int pixelsATexel, float* block);

// Of full-screen stages, in std140.
constexpr const char* kStageBlock = "PldNumbers";
// One number of the block.
struct NumberPlace {
  StageNumber number;
  const char* name;
  const char* type;  // in GLSL; of an array that of one
  int count;         // of an array, else 1
  std::size_t offset, bytes;
};
std::vector<NumberPlace> placesOf(const std::vector<StageNumber>& stage);
std::size_t sizeOfStageBlock(const std::vector<StageNumber>& stage);
// "<layout> uniform PldNumbers { ... };", empty where nothing is told.
std::string stageBlockText(const std::vector<StageNumber>& stage, const std::string& layout);
//   places  of the pass
void fillStage(const FrameNumbers& numbers, const std::vector<NumberPlace>& places, uint32_t repeat, std::byte* block);

}  // namespace pellucid::c
