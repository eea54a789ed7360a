// Several grids of one fog: densities that add up, and what glows among them, as one grid.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gbuffer/medium.h"

namespace pellucid {

// What the values of a grid are.
enum class GridRole {
  density,      // factors on the fog's density
  emission,     // factors on the radiance that a metre adds
  temperature,  // of a black body
};

// A grid as it was read: its values lie in `density`, whatever they are.
struct RoledGrid {
  std::shared_ptr<const DensityGrid> values;
  GridRole role = GridRole::density;
};

// What grids of emission and of temperature emit.
struct GlowSettings {
  glm::dvec3 emission{1.0};    // radiance that a metre adds where an emission grid is 1, scene-linear
  double absorption = 1.0;     // 1/m: how much of a black body's radiance a metre of a temperature grid adds
  double kelvin = 1.0;         // what a value of 1 of a temperature grid stands for
  glm::dmat3 fromRec709{1.0};  // to the picture's linear space
};

// Densities add up, and so does emission. One density grid is itself, to the bit. Several lie in the box around all,
// in texels of the finest of them, whose own keep their values; what others hold is taken from between their voxels at
// the centres of these texels. Emission is worked out at each voxel first. Throws ResourceError where that box has too
// many texels.
//   grids  at least one
std::shared_ptr<const DensityGrid> joinedGrids(const std::vector<RoledGrid>& grids, const GlowSettings& glow,
                                               std::vector<std::string>& notes);

}  // namespace pellucid
