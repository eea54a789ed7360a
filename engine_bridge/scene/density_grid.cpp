#include "engine_bridge/scene/density_grid.h"

#include "gbuffer/loaded_part.h"

namespace pellucid {

std::shared_ptr<const DensityGrid> readDensityGrid(const std::string& path, const GridOptions& options,
                                                   std::vector<std::string>& notes) {
  static DensityGridReader* const read =
      partFunction<DensityGridReader*()>("pellucid_grids.so", "pellucidDensityGridReader")();
  return read(path, options, notes);
}

}  // namespace pellucid
