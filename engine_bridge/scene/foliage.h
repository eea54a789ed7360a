// Cut-out surfaces: which textures are masks, and mip levels that keep what a mask covers. MODEL section 10.
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

// Mip levels 0.. of a mask's colour and alpha: colours averaged by what covers them, alpha averaged and then scaled so
// that each level covers the same area at this cutoff as level 0 under bilinear filtering. Castano: Computing Alpha
// Mipmaps, 2010. Levels halve, rounded down, to 1x1.
//   cutoff  (0,1]
std::vector<Image<glm::vec4>> coveragePreservingMips(const Image<glm::vec4>& texels, float cutoff);

// Whether the texels of its base colour are filtered weighted by their alpha: clear ones then lend their colour to
// none. Where alpha is not looked at, or is 1 everywhere, they are filtered as they are.
bool weighsByAlpha(const Material& material, const Scene& scene);

// The cut that the base texture's own alpha has to reach, (0,1]; 0 for a material without one.
float cutOfBase(const Material& material);

// Part of a level's area whose bilinear alpha reaches the cutoff. [0,1]
double coveredArea(const Image<glm::vec4>& level, float cutoff, float scale = 1.0f);

}  // namespace pellucid
