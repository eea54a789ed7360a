// Density grids of OpenVDB, which is loaded when the first of them is met.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gbuffer/medium.h"

namespace pellucid {

struct GridOptions {
  std::string name;                   // of the grid; "": the preferred one, else the file's only float grid
  std::string preferred = "density";  // name of what is looked for
  double metresPerUnit = 1.0;         // --unit
  bool zUp = false;                   // the file's up is z, as Blender's is; glTF's is y
};

using DensityGridReader = std::shared_ptr<const DensityGrid>(const std::string& path, const GridOptions& options,
                                                             std::vector<std::string>& notes);

// The active voxels of a fog volume, dense. Values below 0 and not finite are 0, and said in `notes`. Throws InputError
// (missing, damaged), MeaningError (no such grid, a level set, a transform that bends), ResourceError (too large).
std::shared_ptr<const DensityGrid> readDensityGrid(const std::string& path, const GridOptions& options,
                                                   std::vector<std::string>& notes);

}  // namespace pellucid
