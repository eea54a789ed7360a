#include "composite/probe_lists.h"

#include <cmath>
#include <utility>

#include "shaders/probe.h"

namespace pellucid {

ProbeGrid::ProbeGrid(const Window& data, std::size_t most) : data_(data), numbers_(data.width(), data.height(), -1) {
  while (numbers_.size() / (static_cast<std::size_t>(cell_) * static_cast<std::size_t>(cell_)) > most) ++cell_;
  for (int y = 0; y < data.height(); ++y)
    for (int x = 0; x < data.width(); ++x)
      if (shading::isProbe({x, y}, cell_)) {
        numbers_.at(x, y) = static_cast<std::int32_t>(places_.size());
        places_.emplace_back(x, y);
      }
}

void ProbeGrid::keep(const std::vector<std::uint8_t>& kept) {
  const PixelPlaces before = std::move(places_);
  places_.clear();
  for (std::size_t i = 0; i < before.size(); ++i) {
    std::int32_t& number = numbers_.at(before[i].x, before[i].y);
    number = kept[i] ? static_cast<std::int32_t>(places_.size()) : -1;
    if (kept[i]) places_.push_back(before[i]);
  }
}

ProbeLists::ProbeLists(const ProbeGrid& grid)
    : grid_(grid),
      fragments_(grid.places().size()),
      solids_(grid.places().size(), glm::vec4(0.0f, 0.0f, 0.0f, INFINITY)) {}

void ProbeLists::add(const FragmentLists& lists) {
  std::size_t pixel = 0;
  for (int y = lists.window.y0; y < lists.window.y1; ++y)
    for (int x = lists.window.x0; x < lists.window.x1; ++x, ++pixel) {
      const std::int32_t number = grid_.numbers_.at(x - grid_.data_.x0, y - grid_.data_.y0);
      if (number < 0) continue;
      const auto probe = static_cast<std::size_t>(number);
      fragments_[probe].assign(lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[pixel]),
                               lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[pixel + 1]));
      solids_[probe] = lists.solid[pixel];
    }
}

void ProbeLists::mark(std::vector<std::uint8_t>& touched) const {
  for (std::size_t i = 0; i < fragments_.size(); ++i)
    if (!fragments_[i].empty() || solids_[i].a < INFINITY) touched[i] = 1;
}

void ProbeLists::keep(const std::vector<std::uint8_t>& kept) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    if (next != i) {
      fragments_[next] = std::move(fragments_[i]);
      solids_[next] = solids_[i];
    }
    ++next;
  }
  fragments_.resize(next);
  solids_.resize(next);
}

FragmentLists ProbeLists::finish() const {
  FragmentLists all;
  all.window = grid_.window();
  all.solid = Image<glm::vec4>(all.window.width(), all.window.height(), glm::vec4(0.0f, 0.0f, 0.0f, INFINITY));
  all.offsets.assign(1, 0);
  for (std::size_t i = 0; i < fragments_.size(); ++i) {
    for (Fragment fragment : fragments_[i]) {
      fragment.offset = glm::vec2(0.0f);
      fragment.variance = 0.0f;
      all.fragments.push_back(fragment);
    }
    all.offsets.push_back(all.fragments.size());
    all.solid[i] = solids_[i];
  }
  all.offsets.resize(all.solid.size() + 1, all.fragments.size());
  return all;
}

}  // namespace pellucid
