#include "engine_bridge/scene/fog_grids.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/blackbody.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kMostBytes = 1 << 30;
constexpr float kBrightest = 1e15f;  // so that sums along a ray stay in float
constexpr double kOfATexel = 1e-6;   // by which boxes may miss each other's texels and still share them

glm::dmat4 texelFromBox(const DensityGrid& grid) {
  glm::dmat4 matrix(1.0);
  for (int c = 0; c < 3; ++c) matrix[c][c] = static_cast<double>(grid.density.size[c]);
  return matrix;
}

double voxelVolume(const DensityGrid& grid) {
  const glm::dvec3 size(grid.density.size);
  return std::abs(1.0 / glm::determinant(glm::dmat3(grid.boxFromWorld))) / (size.x * size.y * size.z);
}

// What the voxels of one grid emit.
Volume<glm::vec4> emissionOf(const RoledGrid& grid, const GlowSettings& glow, std::vector<std::string>& notes) {
  const Volume<float>& values = grid.values->density;
  Volume<glm::vec4> emission(values.size, glm::vec4(0.0f));
  std::atomic<std::size_t> tooHot{0};
  tbb::parallel_for(std::size_t{0}, values.texels.size(), [&](std::size_t i) {
    const auto value = static_cast<double>(values.texels[i]);
    if (value <= 0.0) return;
    glm::dvec3 sent = glow.emission * value;
    if (grid.role == GridRole::temperature) {
      const double kelvin = glow.kelvin * value;
      if (kelvin > kHottest) tooHot.fetch_add(1, std::memory_order_relaxed);
      sent = glow.fromRec709 * (glow.absorption * blackbodyRadiance(std::min(kelvin, kHottest)));
    }
    emission.texels[i] =
        glm::vec4(glm::clamp(glm::vec3(glm::max(sent, glm::dvec3(0.0))), glm::vec3(0.0f), glm::vec3(kBrightest)), 0.0f);
  });
  if (tooHot > 0)
    notes.push_back(
        fmt::format("--fog-grid: {} voxels are hotter than {:g} K and count as that; --fog kelvin=K says "
                    "what a value of 1 is",
                    tooHot.load(), kHottest));
  return emission;
}

// The box around all grids, in texels of one of them.
struct Lattice {
  glm::dmat4 worldFromTexel{1.0};
  glm::ivec3 size{0};
};

Lattice latticeOf(const std::vector<RoledGrid>& grids) {
  const DensityGrid* finest = grids[0].values.get();
  for (const RoledGrid& grid : grids)
    if (voxelVolume(*grid.values) < voxelVolume(*finest) * (1.0 - kOfATexel)) finest = grid.values.get();
  const glm::dmat4 texelFromWorld = texelFromBox(*finest) * finest->boxFromWorld;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const RoledGrid& grid : grids) {
    const glm::dmat4 texelFromBoxOf = texelFromWorld * glm::inverse(grid.values->boxFromWorld);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 at(texelFromBoxOf * glm::dvec4(corner & 1, (corner >> 1) & 1, corner >> 2, 1.0));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  low = glm::floor(low + kOfATexel);
  const glm::dvec3 size = glm::ceil(high - kOfATexel) - low;
  if (!(size.x * size.y * size.z * (sizeof(float) + sizeof(glm::vec4)) <= kMostBytes))
    throw ResourceError(
        fmt::format("--fog-grid: the box around all grids has {:g}x{:g}x{:g} voxels of the finest, "
                    "expected at most {:g} in all",
                    size.x, size.y, size.z, std::floor(kMostBytes / (sizeof(float) + sizeof(glm::vec4)))));
  Lattice lattice;
  glm::dmat4 shift(1.0);
  shift[3] = glm::dvec4(low, 1.0);
  lattice.worldFromTexel = glm::inverse(texelFromWorld) * shift;
  lattice.size = glm::ivec3(size);
  return lattice;
}

// Adds what lies between the texels of one volume to those of another.
//   boxFromWorld  of the first
template <class Wide, class T>
void addTexels(const Volume<T>& from, const glm::dmat4& boxFromWorld, const Lattice& lattice, Volume<T>& sum) {
  const glm::dmat4 boxFromTexel = boxFromWorld * lattice.worldFromTexel;
  const glm::dvec3 size(from.size);
  tbb::parallel_for(0, lattice.size.z, [&](int z) {
    for (int y = 0; y < lattice.size.y; ++y)
      for (int x = 0; x < lattice.size.x; ++x) {
        const glm::dvec3 at(boxFromTexel * glm::dvec4(x + 0.5, y + 0.5, z + 0.5, 1.0));
        if (glm::any(glm::lessThan(at, glm::dvec3(0.0))) || glm::any(glm::greaterThan(at, glm::dvec3(1.0)))) continue;
        sum.at({x, y, z}) += T(from.template between<Wide>(at * size));
      }
  });
}

}  // namespace

std::shared_ptr<const DensityGrid> joinedGrids(const std::vector<RoledGrid>& grids, const GlowSettings& glow,
                                               std::vector<std::string>& notes) {
  if (grids.size() == 1 && grids[0].role == GridRole::density) return grids[0].values;
  const Lattice lattice = latticeOf(grids);
  auto joined = std::make_shared<DensityGrid>();
  joined->density = Volume<float>(lattice.size, 0.0f);
  glm::dmat4 texelFromBoxOf(1.0);
  for (int c = 0; c < 3; ++c) texelFromBoxOf[c][c] = static_cast<double>(lattice.size[c]);
  joined->boxFromWorld = glm::inverse(lattice.worldFromTexel * texelFromBoxOf);
  for (const RoledGrid& grid : grids) {
    if (grid.role == GridRole::density) {
      addTexels<double>(grid.values->density, grid.values->boxFromWorld, lattice, joined->density);
      continue;
    }
    if (joined->emission.texels.empty()) joined->emission = Volume<glm::vec4>(lattice.size, glm::vec4(0.0f));
    addTexels<glm::dvec4>(emissionOf(grid, glow, notes), grid.values->boxFromWorld, lattice, joined->emission);
  }
  for (const float density : joined->density.texels) joined->most = std::max(joined->most, density);
  return joined;
}

}  // namespace pellucid
