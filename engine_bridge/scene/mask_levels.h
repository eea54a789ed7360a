// Mip levels of cut-out textures: up to which one they hold the pattern, and what a cut leaves where they do not.
#pragma once
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

struct MaskLevels {
  // The coarsest level that holds the pattern: it is cut like the finest. 0 where none but the finest does.
  int resolved = 0;
  // All of them; the finest is the texture. Alpha is tested up to `resolved`; beyond it is the part of the texel's area
  // that the cut leaves of the finest level, [0,1], and colours are the means of what is left.
  std::vector<Image<glm::vec4>> levels;
};

constexpr double kMostOffInTheMean = 0.005;  // of coverage, read with rims a texel wide, over a whole level
constexpr double kMostOffInATexel = 0.05;    // of coverage, in the mean of a level's texels

// Of the levels that `tested` brings (halved, rounded down, to 1x1), those are kept as they are whose reading lies
// within both bounds of what the cut leaves of the finest, and that have no such level before them; all others are
// replaced.
//   tested    level 0 is the texture
//   cutoff    (0,1]
//   sampling  how the texture is magnified, and what lies beyond its edges
MaskLevels maskLevels(std::vector<Image<glm::vec4>> tested, float cutoff, const Sampling& sampling);

// Levels whose alpha is the plain mean: those of a texture that is no binary mask. Colours are weighted by alpha.
std::vector<Image<glm::vec4>> averagedLevels(const Image<glm::vec4>& texels);

// The part of each texel's area that the cut leaves of the texture as it is magnified, in alpha; colours are those of
// what is left.
Image<glm::vec4> keptTexels(const Image<glm::vec4>& texels, float cutoff, const Sampling& sampling);

}  // namespace pellucid
