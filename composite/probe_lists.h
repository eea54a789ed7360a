// Pixels that stand for a picture, spread evenly over it, one from each cell of a grid: their fragment lists, side by
// side in a window of their own. What needs to know where they lie is told beside it.
#pragma once
#include <cstdint>
#include <vector>

#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// Where the pixels of some lists lie in the data window, row by row of the lists' window; pixels beyond its end hold
// nothing and lie nowhere.
using PixelPlaces = std::vector<glm::ivec2>;

class ProbeGrid {
 public:
  //   most  probes, about
  ProbeGrid(const Window& data, std::size_t most);
  int cell() const { return cell_; }  // edge in pixels; see shaders/shared/probe.glsl
  const PixelPlaces& places() const { return places_; }
  Window window() const { return {0, 0, kWidth, (static_cast<int>(places_.size()) + kWidth - 1) / kWidth}; }
  // Leaves out probes.
  //   kept  by the probe's number: 0 leaves it out
  void keep(const std::vector<std::uint8_t>& kept);

 private:
  friend class ProbeLists;
  static constexpr int kWidth = 64;
  int cell_ = 1;
  Window data_;
  PixelPlaces places_;
  Image<std::int32_t> numbers_;  // of the data window: which probe it is, -1 for none
};

// Takes the probes out of lists that come window by window.
class ProbeLists {
 public:
  explicit ProbeLists(const ProbeGrid& grid);
  void add(const FragmentLists& lists);
  // Marks the probes that a layer or a solid touches, by their number.
  void mark(std::vector<std::uint8_t>& touched) const;
  // Of grid.window(), which may have lost probes since: those that `kept` left out.
  void keep(const std::vector<std::uint8_t>& kept);
  // Of grid.window(). What refracts and diffuses is left out: it decides what is seen behind, not what the layers are.
  FragmentLists finish() const;

 private:
  const ProbeGrid& grid_;
  std::vector<std::vector<Fragment>> fragments_;
  std::vector<glm::vec4> solids_;
};

}  // namespace pellucid
