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
  view,
  depthOpacity
};

// Of a frame: all of it, its texels of low resolution, the spread pyramid. Of a face of a shadow map: as casters are
// drawn, filtered across, as it is looked up.
enum class PartOfFrame { picture, low, pyramid, drawnFace, acrossFace, keptFace };

struct PlannedImage {
  std::string name;
  pld_role role = PLD_ROLE_OWN;
  pld_format format = PLD_FORMAT_HOST;
  PartOfFrame part = PartOfFrame::picture;
  uint32_t layers = 1;
  std::array<float, 4> clear{};

  // An array, though it may have one layer.
  bool isMaps() const { return role == PLD_ROLE_SHADOW_MAPS; }
};

constexpr uint32_t kAllComponents = 15;  // of pld_recipe_attachment.write_mask

struct PlannedRead {
  uint32_t image;
  uint32_t binding;  // of draws: beside the first of the seam's
  std::string sampler;
  int32_t layer = 0;
};

// When the GL pass runs a pass: as a stage begins, by the host between pld_begin() and pld_end(), as it ends, or in
// pld_resolve().
enum class Moment { begin, draws, end, resolve };

struct PlannedPass {
  std::string name;
  pld_pass_kind kind = PLD_PASS_FULL_SCREEN;
  Moment moment = Moment::end;
  PartOfFrame part = PartOfFrame::picture;  // that is drawn; of the pyramid one level each time
  std::vector<pld_recipe_attachment> attachments;
  std::vector<PlannedRead> reads;
  uint32_t depthImage = PLD_NO_IMAGE;
  pld_compare compare = PLD_COMPARE_NONE;
  bool writesDepth = false;
  uint32_t lists = 0;  // storage blocks of stage_plan.h, bits
  bool emptiesLists = false;

  pld_stage stage = PLD_STAGE_LAYERS;  // of draws, and whose begin or end other passes belong to
  std::string file;                    // of others, below shaders/
  std::vector<std::string> defines;
  std::vector<StageNumber> numbers;
  int firstView = -1, lastView = -1;  // pld_view, of what pld_resolve() shows by it; -1: others read what it draws

  bool shows(int view) const { return view >= firstView && view <= lastView; }
};

// What a plan depends on besides its permutation.
struct PlanShape {
  pld_clip clip = PLD_CLIP_MINUS_ONE_TO_ONE;
  // Of the spread pyramid. 2: of odd and of even levels, so that no level is drawn to the image it reads; of one layer
  // it is, and a barrier lies between the levels.
  int atlasLayers = 2;
  bool debugViews = false;  // PLD_FLAG_DEBUG_VIEWS
};

struct RecipePlan {
  int atlasLayers = 2;
  std::vector<PlannedImage> images;
  std::vector<PlannedPass> passes;
  pld_shadow_info maps{};  // of a plan of shadow maps, see caster_plan.h; all 0 in that of frames

  bool isOfMaps() const { return maps.faces > 0; }
};

constexpr pld_format formatOf(PlaneFormat format) {
  switch (format) {
    case PlaneFormat::r16f:
      return PLD_FORMAT_R16F;
    case PlaneFormat::rg16f:
      return PLD_FORMAT_RG16F;
    case PlaneFormat::rgba16f:
      return PLD_FORMAT_RGBA16F;
    case PlaneFormat::r32f:
      return PLD_FORMAT_R32F;
    case PlaneFormat::rg32f:
      return PLD_FORMAT_RG32F;
    case PlaneFormat::rgba32f:
      return PLD_FORMAT_RGBA32F;
    case PlaneFormat::rgba8:
      return PLD_FORMAT_RGBA8;
    default:
      return PLD_FORMAT_RG8_SNORM;
  }
}

// Of a texel; 0 for the host's.
constexpr int bitsOf(pld_format format) {
  constexpr int bits[] = {0, 16, 32, 64, 32, 64, 128, 32, 16, 32};
  return bits[format];
}

constexpr pld_blend blendOf(PlaneBlend blend) {
  constexpr pld_factor one = PLD_FACTOR_ONE;
  switch (blend) {
    case PlaneBlend::minimum:
      return {1, one, one, PLD_BLEND_MINIMUM, one, one, PLD_BLEND_MINIMUM};
    case PlaneBlend::alphaMinimum:
      return {1, one, one, PLD_BLEND_ADD, one, one, PLD_BLEND_MINIMUM};
    case PlaneBlend::product:
      return {1, PLD_FACTOR_ZERO, PLD_FACTOR_ONE_MINUS_SOURCE_COLOUR, PLD_BLEND_ADD, one, one, PLD_BLEND_ADD};
    default:
      return {1, one, one, PLD_BLEND_ADD, one, one, PLD_BLEND_ADD};
  }
}

}  // namespace pellucid::c
