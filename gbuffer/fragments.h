// Transparent fragments of each pixel, in any order: what the sorted truth and every method can be computed from.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gbuffer/image.h"
#include "shaders/plane_layout.h"

namespace pellucid {

// Laid out as two std430 rows and a half, so that the GL pass writes it directly.
struct Fragment {
  glm::vec3 radiance;      // C = coverage * L_r + E, premultiplied, scene-linear
  float coverage;          // [0,1]; 0 marks additive light
  glm::vec3 transmission;  // t, [0,1]
  float z;                 // planar metres, > 0
  glm::vec2 offset;        // refraction delta, float pixels, y down
  float variance;          // diffusion, one layer's s^2, float pixels^2
  // Hash of file, node, mesh and triangle, by --noise object of a piece of it: the same for every chunking and order.
  std::uint32_t identity;
};
static_assert(sizeof(Fragment) == 48);

// What few lists need of every fragment besides: empty, else one row per fragment, 0 where a fragment has none of it.
using FragmentColumn = std::vector<glm::vec4>;
constexpr std::size_t kFragmentColumns = 1;

// Lists of the pixels of one window, concatenated row by row. What adds, orders or leaves out fragments does so by the
// functions here, which take all columns along.
struct FragmentLists {
  Window window;                       // in display coordinates
  std::vector<std::uint64_t> offsets;  // size width * height + 1: pixel i owns [offsets[i], offsets[i + 1])
  std::vector<Fragment> fragments;
  FragmentColumn dispersion;  // where a layer disperses: refraction delta of red minus `offset`, of blue minus it
  Image<glm::vec4> solid;     // nearest fragment that hides everything: rgb, planar z (+inf: none)

  bool disperses() const { return !dispersion.empty(); }
  // Every column; a new one has its place here and in columnsOf().
  std::array<FragmentColumn*, kFragmentColumns> columns() { return {&dispersion}; }
  std::array<const FragmentColumn*, kFragmentColumns> columns() const { return {&dispersion}; }
  bool hasColumns() const;

  void append(const Fragment& fragment);
  // Fragments [first, last) of other lists.
  void append(const FragmentLists& from, std::size_t first, std::size_t last);
  void endPixel() { offsets.push_back(fragments.size()); }
  // Columns that other lists have.
  void addColumnsOf(const FragmentLists& like);
  void clearColumns();
  // As many fragments, with the columns that lists of such layers have.
  void resize(std::size_t count, const LayerModel& layers);
  // Keeps of the fragments from `first` on, in their order, those that `keeps`.
  template <class Keeps>
  void keepFrom(std::size_t first, const Keeps& keeps);
  // Order of two fragments' columns by their bits: below, above or at 0.
  int compareColumns(std::size_t a, std::size_t b) const;
  // Puts fragment first + order[i] in the place of first + i.
  void reorder(std::size_t first, const std::vector<std::size_t>& order);

 private:
  void move(std::size_t from, std::size_t to);
  void shrink(std::size_t count);
};

// The columns that lists of such layers have.
std::array<bool, kFragmentColumns> columnsOf(const LayerModel& layers);
// Lists of the same window and solids, before the first pixel's fragments.
FragmentLists emptyLike(const FragmentLists& lists);
// Whether some fragment refracts or diffuses.
bool anyScatters(const FragmentLists& lists);
// What the fragments are, as far as their scattering has planes of its own.
LayerModel modelOf(const FragmentLists& lists);

template <class Keeps>
void FragmentLists::keepFrom(std::size_t first, const Keeps& keeps) {
  std::size_t kept = first;
  for (std::size_t i = first; i < fragments.size(); ++i)
    if (keeps(fragments[i])) move(i, kept++);
  shrink(kept);
}

}  // namespace pellucid
