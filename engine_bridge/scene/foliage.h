// Cut-out surfaces: which textures are masks, and mip levels that hold what a cut leaves. MODEL section 10.
#pragma once
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

// The alpha of a texture's finest level, measured.
struct MaskMeasure {
  bool binary = false;       // PT17's baseMIPIsBinary, within the tolerances below
  double covered = 0.0;      // part of the texels with alpha >= 1/2
  double between = 0.0;      // part of the texels that are neither 0 nor 1 within kMaskNoise
  double unexplained = 0.0;  // part of the texels that are so and belong to no border; all of them where none can
};

constexpr float kMaskNoise = 0.125f;        // of full alpha: what JPEG at quality 75 adds to a mask's flat parts
constexpr int kMaskBorder = 2;              // texels: an antialiased or rung border has a 0 and a 1 this near
constexpr double kMostBetween = 1.0 / 3.0;  // more is noise, however near its extremes lie
constexpr double kMostUnexplained = 1e-3;   // thin tips and stray blocks

// Binary when both extremes occur, and values in between lie at borders only. Texels repeat beyond the edges.
MaskMeasure measureMask(const Image<glm::vec4>& texels);

// Whether rims of this material take their ambient occlusion from their neighbours: it transmits nothing, is lit, and
// is alpha-tested, or blended with a base colour texture that is a mask.
bool infersOcclusion(const Material& material, const Scene& scene);

// Mip levels 0.. of a texture that is cut out. Level 0 is the texture. From level 1 on alpha is the part of a texel's
// area that the cut leaves of level 0, filtered as the sampler does between its texels, and colours are the means of
// what is left; so the mean of every level's alpha is that part of the whole. Levels halve, rounded down, to 1x1.
//   cutoff    (0,1]
//   sampling  how the texture is magnified, and what lies beyond its edges
std::vector<Image<glm::vec4>> keptLevels(const Image<glm::vec4>& texels, float cutoff, const Sampling& sampling);

// Whether the texels of its base colour are filtered weighted by their alpha: clear ones then lend their colour to
// none. Where alpha is not looked at, or is 1 everywhere, they are filtered as they are.
bool weighsByAlpha(const Material& material, const Scene& scene);

// The cut that the base texture's own alpha has to reach, (0,1]; 0 for a material without one.
float cutOfBase(const Material& material);

}  // namespace pellucid
