#include "composite/cli/row_gatherer.h"

#include <algorithm>
#include <cmath>

#include "composite/deep/sample_channels.h"
#include "shaders/shading.h"

namespace pellucid::cli {

void RowGatherer::add(const FragmentLists& lists) {
  held_.push_back(lists);
  int ready = next_;
  while (ready < data_.y1 && covered(ready)) ++ready;
  if (ready == next_) return;
  write(next_, ready);
  next_ = ready;
  std::erase_if(held_, [&](const FragmentLists& each) { return each.window.y1 <= next_; });
}

bool RowGatherer::covered(int y) const {
  int width = 0;
  for (const FragmentLists& lists : held_)
    if (y >= lists.window.y0 && y < lists.window.y1) width += lists.window.width();
  return width == data_.width();
}

void RowGatherer::put(DeepRows& rows, const Fragment& fragment) const {
  auto values = recordValues(fragment);
  for (const std::size_t z : {std::size_t{7}, std::size_t{8}})
    values[z] = static_cast<float>(static_cast<double>(values[z]) * unitsPerMetre_);
  for (std::size_t c = 0; c < values.size(); ++c) rows.channels[c].push_back(values[c]);
}

// Sorted, so that other tools that never sort read them right, and the file does not depend on the order.
void RowGatherer::putPixel(DeepRows& rows, const FragmentLists& lists, int x, int y) {
  const glm::vec4 solid = lists.solid.at(x - lists.window.x0, y - lists.window.y0);
  const auto pixel = static_cast<std::size_t>(y - lists.window.y0) * static_cast<std::size_t>(lists.window.width()) +
                     static_cast<std::size_t>(x - lists.window.x0);
  sorted_.clear();
  for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
    const Fragment& fragment = lists.fragments[i];
    if (fragment.z <= solid.a && !shading::isSolid(fragment.coverage, fragment.transmission))
      sorted_.push_back(&fragment);
  }
  std::sort(sorted_.begin(), sorted_.end(), [](const Fragment* a, const Fragment* b) {
    return a->z != b->z ? a->z < b->z : a->identity < b->identity;
  });
  for (const Fragment* fragment : sorted_) put(rows, *fragment);
  if (std::isfinite(solid.a)) {
    Fragment opaque{};
    opaque.radiance = glm::vec3(solid);
    opaque.coverage = 1.0f;
    opaque.z = solid.a;
    put(rows, opaque);
  }
  rows.offsets.push_back(rows.channels[0].size());
}

void RowGatherer::write(int y0, int y1) {
  DeepRows rows;
  rows.window = {data_.x0, y0, data_.x1, y1};
  rows.channels.resize(recordChannels().size());
  rows.offsets.assign(1, 0);
  std::vector<const FragmentLists*> across;
  for (int y = y0; y < y1; ++y) {
    across.clear();
    for (const FragmentLists& lists : held_)
      if (y >= lists.window.y0 && y < lists.window.y1) across.push_back(&lists);
    std::sort(across.begin(), across.end(),
              [](const FragmentLists* a, const FragmentLists* b) { return a->window.x0 < b->window.x0; });
    for (const FragmentLists* lists : across)
      for (int x = lists->window.x0; x < lists->window.x1; ++x) putPixel(rows, *lists, x, y);
  }
  writer_.write(rows);
}

}  // namespace pellucid::cli
