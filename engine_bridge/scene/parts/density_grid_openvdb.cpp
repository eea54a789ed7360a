// The one place that reads OpenVDB.
#include <fmt/format.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <filesystem>
#include <mutex>
#include <new>

#include "engine_bridge/scene/density_grid.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr std::uintmax_t kSmallFile = std::uintmax_t{64} << 20;
constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;  // 512 MiB of floats

std::string namesOf(const openvdb::GridPtrVec& grids) {
  std::string names;
  for (const auto& grid : grids)
    names += (names.empty() ? "" : ", ") + grid->getName() + " (" + grid->valueType() + ")";
  return names.empty() ? "none" : names;
}

// Descriptors alone are read here: a damaged tree is met only where it is wanted.
std::string wantedName(openvdb::io::File& file, const std::string& path, const GridOptions& options) {
  const std::string& name = options.name;
  const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
  std::vector<std::string> floats;
  for (const auto& grid : *grids) {
    if (!name.empty() && grid->getName() != name) continue;
    if (grid->valueType() == "float") floats.push_back(grid->getName());
  }
  for (const std::string& each : floats)
    if (each == options.preferred) return each;
  if (floats.size() == 1) return floats[0];
  throw MeaningError(fmt::format("{}: found the grids {}, expected {}", path, namesOf(*grids),
                                 name.empty() ? fmt::format("a float grid `{}`, or one float grid", options.preferred)
                                              : fmt::format("a float grid named '{}'", name)));
}

glm::dmat4 worldFromIndex(const openvdb::math::Transform& transform, const std::string& path) {
  if (!transform.isLinear())
    throw MeaningError(
        fmt::format("{}: the grid's transform is a {}, expected an affine one", path, transform.mapType()));
  const openvdb::math::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();  // row vectors
  glm::dmat4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      matrix[row][column] = m(row, column);
      if (!std::isfinite(m(row, column)) || std::abs(m(row, column)) > 1e15)
        throw MeaningError(
            fmt::format("{}: the grid's transform holds {}, expected magnitudes up to 1e15", path, m(row, column)));
    }
  if (!(std::abs(glm::determinant(glm::dmat3(matrix))) > 1e-30))
    throw MeaningError(fmt::format("{}: the grid's transform flattens it, expected voxels with a volume", path));
  return matrix;
}

struct Oddities {
  std::size_t negative = 0, nonFinite = 0;
};

void fill(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box, DensityGrid& made, Oddities& oddities) {
  const openvdb::FloatGrid::ConstAccessor values = grid.getConstAccessor();
  openvdb::Coord at;
  for (at[2] = box.min()[2]; at[2] <= box.max()[2]; ++at[2])
    for (at[1] = box.min()[1]; at[1] <= box.max()[1]; ++at[1])
      for (at[0] = box.min()[0]; at[0] <= box.max()[0]; ++at[0]) {
        float value = values.getValue(at);
        if (!std::isfinite(value)) {
          ++oddities.nonFinite;
          value = 0.0f;
        } else if (value < 0.0f) {
          ++oddities.negative;
          value = 0.0f;
        }
        value = std::min(value, 1e15f);
        made.most = std::max(made.most, value);
        made.density.at({at[0] - box.min()[0], at[1] - box.min()[1], at[2] - box.min()[2]}) = value;
      }
}

std::shared_ptr<DensityGrid> read(const std::string& path, const GridOptions& options,
                                  std::vector<std::string>& notes) {
  openvdb::io::File file(path);
  file.open(false);  // read now: a file that shrinks later is then none of ours
  const std::string name = wantedName(file, path, options);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
  if (!grid) throw InputError(fmt::format("{}: the grid '{}' could not be read", path, name));
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    throw MeaningError(fmt::format("{}: the grid '{}' is a level set, expected a fog volume", path, name));
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  if (box.empty())
    throw MeaningError(fmt::format("{}: the grid '{}' has no active voxel, expected a fog volume", path, name));
  std::int64_t size[3];
  for (int c = 0; c < 3; ++c) size[c] = std::int64_t{box.max()[c]} - box.min()[c] + 1;
  if (size[0] > kMostTexels || size[1] > kMostTexels || size[2] > kMostTexels || size[0] * size[1] > kMostTexels ||
      size[0] * size[1] * size[2] > kMostTexels)
    throw ResourceError(fmt::format("{}: the grid '{}' spans {}x{}x{} voxels, expected at most {} in all", path, name,
                                    size[0], size[1], size[2], kMostTexels));
  auto made = std::make_shared<DensityGrid>();
  made->density =
      Volume<float>({static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2])}, 0.0f);
  glm::dmat4 world = worldFromIndex(grid->transform(), path);
  glm::dmat4 metres(options.metresPerUnit);
  metres[3][3] = 1.0;
  if (options.zUp) metres = metres * glm::dmat4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);  // y up is (x, z, -y)
  world = metres * world;
  glm::dmat4 indexFromBox(1.0);  // a voxel reaches half a voxel around its index
  for (int c = 0; c < 3; ++c) {
    indexFromBox[c][c] = static_cast<double>(size[c]);
    indexFromBox[3][c] = box.min()[c] - 0.5;
  }
  made->boxFromWorld = glm::inverse(world * indexFromBox);
  Oddities oddities;
  fill(*grid, box, *made, oddities);
  if (oddities.nonFinite > 0)
    notes.push_back(fmt::format("{}: {} values are not finite and count as 0", path, oddities.nonFinite));
  if (oddities.negative > 0)
    notes.push_back(fmt::format("{}: {} values are below 0 and count as 0", path, oddities.negative));
  return made;
}

std::shared_ptr<const DensityGrid> readGrid(const std::string& path, const GridOptions& options,
                                            std::vector<std::string>& notes) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem))
    throw InputError(fmt::format("{}: no such file, expected an OpenVDB grid", path));
  try {
    return read(path, options, notes);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    // A broken size in a small file asks for all the memory there is.
    if (std::filesystem::file_size(path, problem) < kSmallFile)
      throw InputError(fmt::format("{}: damaged: it claims to hold more than memory could", path));
    throw ResourceError(fmt::format("{}: does not fit in memory", path));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: damaged, or no OpenVDB file: {}", path, error.what()));
  }
}

}  // namespace
}  // namespace pellucid

extern "C" [[gnu::visibility("default")]] pellucid::DensityGridReader* pellucidDensityGridReader() {
  return &pellucid::readGrid;
}
