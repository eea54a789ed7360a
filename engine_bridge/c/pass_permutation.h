// What a pass keeps per pixel, and the text that it takes: one place that knows how methods, tiers and features
// combine.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/gl_functions.h"
#include "shaders/plane_layout.h"

namespace pellucid::c {

// Textures that seams read, in the order of their units.
constexpr int kMostSeamUnits = 4;
constexpr const char* kSeamSamplers[kMostSeamUnits] = {"pldOpaqueZ", "pldSolid", "pldFrontZ", "pldOpaqueOpen"};

struct Permutation {
  pld_method method = PLD_METHOD_PHENOMENOLOGICAL;
  pld_tier tier = PLD_TIER_FLOAT;
  uint32_t features = 0;
  pld_weight weight = PLD_WEIGHT_BY_EQ5;
  pld_depth depth = PLD_DEPTH_DEVICE;
  pld_rows rows = PLD_ROWS_UP;
  bool atLowResolution = false;  // the planes of PLD_STAGE_LOW
  uint32_t fixedFields = 0;      // pld_fixed: of the next, what every frame has
  pld_frame fixed{};

  bool has(pld_feature feature) const { return (features & static_cast<uint32_t>(feature)) != 0; }
  bool scatters() const { return has(PLD_FEATURE_REFRACTION) || has(PLD_FEATURE_DIFFUSION); }
  bool sorted() const { return method == PLD_METHOD_OVER; }
  bool fronts() const { return method == PLD_METHOD_FRONT_TAIL; }
  // Fragments are listed and summed at the end of a stage, not blended.
  bool exact() const { return tier == PLD_TIER_EXACT; }
  // Whether the nearest layer is drawn apart; lists know it.
  bool frontStage() const { return (fronts() || named()) && !exact(); }
  bool published() const { return tier == PLD_TIER_PUBLISHED; }
  bool grey() const { return !published() && !has(PLD_FEATURE_COLOURED); }
  bool light() const { return !published() && (has(PLD_FEATURE_LIGHT) || low()); }
  bool low() const { return has(PLD_FEATURE_LOW_RESOLUTION); }
  bool lowOver() const { return low() && fronts(); }  // what lies before the nearest layer has planes of its own
  bool rims() const { return has(PLD_FEATURE_RIMS); }
  // From sums of one kind what occlusion hides is taken later; others take rims that are dark already.
  bool rimsInSeam() const { return rims() && (published() || fronts() || sorted()); }
  bool losesLight() const { return published() && has(PLD_FEATURE_LIGHT); }
  bool outputs() const { return has(PLD_FEATURE_OUTPUTS); }
  bool moves() const { return has(PLD_FEATURE_MOTION); }
  bool named() const { return has(PLD_FEATURE_IDENTITY); }
  bool marked() const { return moves() || named(); }  // layers tell more than what they look like
  bool meansDepth() const { return has(PLD_FEATURE_DEPTHS) && !lowOver(); }
  // Lists alone tell in which order opacity grows; what comes from low resolution is in none.
  bool reachesOpacity() const { return has(PLD_FEATURE_DEPTHS) && exact() && !low(); }
  bool rimsApart() const { return rims() && !rimsInSeam(); }
  int seamUnits() const { return rimsInSeam() ? kMostSeamUnits : 3; }  // textures that the seam reads
  // Whether planar depth is needed beside the host's.
  bool planarDepth() const {
    return rims() || low() || scatters() || has(PLD_FEATURE_SOLIDS) || depth == PLD_DEPTH_LINEAR;
  }
};

// Whether a host was built with the header of this minor version or a later one.
//   version  of its header, as PLD_VERSION
constexpr bool isSince(uint32_t version, uint32_t minor) {
  return version >= (uint32_t{PLD_VERSION_MAJOR} << 20 | minor << 10);
}

extern const uint32_t kEveryFeature;  // pld_feature

LayerModel modelOf(const Permutation& permutation);

// Whether pld_frame.projection, by columns, has clip w = -z; whether it has w = 1.
bool isPerspective(const float* projection);
bool isOrthographic(const float* projection);

// What shaders/shared/refraction.glsl takes as focal lengths: pixels, for orthographic views pixels a metre.
struct Focal {
  float x, y;
};
//   pixelsATexel  of PLD_STAGE_LOW, else 1
Focal focalOf(const pld_frame& frame, int pixelsATexel);
// pld_frame.weight_reference, or what stands for 0. Metres
float referenceOf(const pld_frame& frame);

// Empty when the parts go together, else what does not: a clause.
//   maybeLight  light that a tier has no plane for may be lost
std::string refusalOf(const Permutation& permutation, bool maybeLight = false);
// What is said of Permutation::losesLight().
std::string lostLight();

std::vector<PlaneSpec> planesOf(const Permutation& permutation);

// Defines of shaders/gl/seam.glsl for a stage; of planar_depth.frag; of resolve_here.glsl.
std::vector<std::string> seamDefines(const Permutation& permutation, pld_stage stage);
std::vector<std::string> depthDefines(pld_depth depth, pld_clip clip);
//   showsThrough  false for what looks at a pixel's layers and not at the background behind them
std::vector<std::string> resolveDefines(const Permutation& permutation, bool showsThrough = true);
// How many storage blocks the lists of the exact tier take; 0 in other tiers. Of a stage's lists, without marks.
int listBlocks(const Permutation& permutation);
int listBlocks(const Permutation& permutation, pld_stage stage);
// Of each of them, as shaders/gl/exact_lists.glsl and listed_marks.glsl have it.
const char* listName(const Permutation& permutation, int block);
// Of the exact tier: defines of shaders/gl/exact_fold.frag, of exact_marks.frag.
std::vector<std::string> foldDefines(const Permutation& permutation, pld_stage stage);
std::vector<std::string> marksDefines(const Permutation& permutation);
// Of it with marks: which of PLD_STORAGE_* of shaders/gl/exact_lists.glsl the block of marks is, as a define.
std::string marksPlace(const Permutation& permutation);

}  // namespace pellucid::c
