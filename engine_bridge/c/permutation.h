// What a pass keeps per pixel, and the text that it takes: one place that knows how methods, tiers and features
// combine.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

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
  bool fronts() const { return method == PLD_METHOD_FRONT_TAIL; }
  // Fragments are listed and summed at the end of a stage, not blended.
  bool exact() const { return tier == PLD_TIER_EXACT; }
  bool inFloats() const { return tier == PLD_TIER_FLOAT || exact(); }
  // Whether the nearest layer is drawn apart; lists know it.
  bool frontStage() const { return fronts() && !exact(); }
  bool published() const { return tier == PLD_TIER_PUBLISHED; }
  bool grey() const { return !published() && !has(PLD_FEATURE_COLOURED); }
  bool light() const { return !published() && (has(PLD_FEATURE_LIGHT) || low()); }
  // No layer adds light: half of the sums are not needed.
  bool lean() const { return !published() && !light(); }
  // The nearest layer that diffuses has a place beside a sum. At low resolution the nearest of all is wanted too.
  bool diffuseInAlpha() const { return has(PLD_FEATURE_DIFFUSION) && !published() && !atLowResolution; }
  bool low() const { return has(PLD_FEATURE_LOW_RESOLUTION); }
  bool lowOver() const { return low() && fronts(); }  // what lies before the nearest layer has planes of its own
  bool rims() const { return has(PLD_FEATURE_RIMS); }
  // From sums of one kind what occlusion hides is taken later; others take rims that are dark already.
  bool rimsInSeam() const { return rims() && (published() || fronts()); }
  bool rimsApart() const { return rims() && !rimsInSeam(); }
  int seamUnits() const { return rimsInSeam() ? 4 : 3; }  // textures that the seam reads
  // Whether planar depth is needed beside the host's.
  bool planarDepth() const {
    return rims() || low() || scatters() || has(PLD_FEATURE_SOLIDS) || depth == PLD_DEPTH_LINEAR;
  }
};

// Whether pld_frame.projection, by columns, has clip w = -z; whether it has w = 1.
bool isPerspective(const float* projection);
bool isOrthographic(const float* projection);

// What shaders/shared/refraction.glsl takes as focal lengths: pixels, for orthographic views pixels a metre.
struct Focal {
  float x, y;
};
//   pixelsATexel  of PLD_STAGE_LOW, else 1
Focal focalOf(const pld_frame& frame, int pixelsATexel);

// Empty when the parts go together, else what does not: a sentence.
std::string conflictOf(const Permutation& permutation);

// product: of rgb, ZERO, ONE_MINUS_SRC_COLOR; a adds. alphaMinimum: rgb adds
enum class BlendKind { add, minimum, alphaMinimum, product };

// One texture that layers are blended into.
struct PlaneSpec {
  GLuint attachment;
  GLenum format;  // sized
  int bits;
  GLuint unit;  // where shaders/gl/resolve_here.glsl reads it
  BlendKind blend;
  GLfloat clear[4];
};
std::vector<PlaneSpec> planesOf(const Permutation& permutation);
PlaneSpec nearestPlane();  // of low-resolution layers besides

// Of shaders/gl/sums_output.glsl, lean_output.glsl and resolve_here.glsl: what lies where. Without SCATTER, which
// stages and views choose.
std::vector<std::string> scatterPlaces(const Permutation& permutation);
// Defines of shaders/gl/seam.glsl for a stage; of empty_planes.frag; of planar_depth.frag; of resolve_here.glsl.
std::vector<std::string> seamDefines(const Permutation& permutation, pld_stage stage);
std::vector<std::string> emptyDefines(const std::vector<PlaneSpec>& planes);
std::vector<std::string> depthDefines(pld_depth depth, pld_clip clip);
std::vector<std::string> resolveDefines(const Permutation& permutation);
// Of the exact tier: which blocks a stage's lists have, from block 0 without a gap; defines of
// shaders/gl/exact_fold.frag.
bool listsOffsets(const Permutation& permutation, pld_stage stage);
std::vector<std::string> foldDefines(const Permutation& permutation, pld_stage stage);

}  // namespace pellucid::c
