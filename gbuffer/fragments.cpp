#include "gbuffer/fragments.h"

#include <algorithm>
#include <cstring>

namespace pellucid {

std::array<bool, kFragmentColumns> columnsOf(const LayerModel& layers) {
  return {layers.disperses};
}

bool FragmentLists::hasColumns() const {
  const auto all = columns();
  return std::any_of(all.begin(), all.end(), [](const FragmentColumn* column) { return !column->empty(); });
}

void FragmentLists::append(const Fragment& fragment) {
  fragments.push_back(fragment);
  for (FragmentColumn* column : columns())
    if (!column->empty()) column->emplace_back(0.0f);
}

void FragmentLists::append(const FragmentLists& from, std::size_t first, std::size_t last) {
  if (first == last) return;
  const auto begin = static_cast<std::ptrdiff_t>(first), end = static_cast<std::ptrdiff_t>(last);
  const std::size_t had = fragments.size();
  fragments.insert(fragments.end(), from.fragments.begin() + begin, from.fragments.begin() + end);
  for (std::size_t k = 0; k < kFragmentColumns; ++k) {
    FragmentColumn& to = *columns()[k];
    const FragmentColumn& added = *from.columns()[k];
    if (!added.empty()) {
      to.resize(had, glm::vec4(0.0f));
      to.insert(to.end(), added.begin() + begin, added.begin() + end);
    } else if (!to.empty()) {
      to.resize(fragments.size(), glm::vec4(0.0f));
    }
  }
}

void FragmentLists::addColumnsOf(const FragmentLists& like) {
  for (std::size_t k = 0; k < kFragmentColumns; ++k)
    if (!like.columns()[k]->empty()) columns()[k]->resize(fragments.size(), glm::vec4(0.0f));
}

void FragmentLists::clearColumns() {
  for (FragmentColumn* column : columns()) column->clear();
}

void FragmentLists::resize(std::size_t count, const LayerModel& layers) {
  fragments.resize(count);
  for (std::size_t k = 0; k < kFragmentColumns; ++k)
    columns()[k]->resize(columnsOf(layers)[k] ? count : 0, glm::vec4(0.0f));
}

int FragmentLists::compareColumns(std::size_t a, std::size_t b) const {
  for (const FragmentColumn* column : columns())
    if (!column->empty())
      if (const int order = std::memcmp(&(*column)[a], &(*column)[b], sizeof(glm::vec4)); order != 0) return order;
  return 0;
}

void FragmentLists::reorder(std::size_t first, const std::vector<std::size_t>& order) {
  const auto permute = [&](auto& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector before(begin, begin + static_cast<std::ptrdiff_t>(order.size()));
    for (std::size_t i = 0; i < order.size(); ++i) values[first + i] = before[order[i]];
  };
  permute(fragments);
  for (FragmentColumn* column : columns())
    if (!column->empty()) permute(*column);
}

void FragmentLists::move(std::size_t from, std::size_t to) {
  fragments[to] = fragments[from];
  for (FragmentColumn* column : columns())
    if (!column->empty()) (*column)[to] = (*column)[from];
}

void FragmentLists::shrink(std::size_t count) {
  fragments.resize(count);
  for (FragmentColumn* column : columns())
    if (!column->empty()) column->resize(count);
}

FragmentLists emptyLike(const FragmentLists& lists) {
  FragmentLists made;
  made.window = lists.window;
  made.solid = lists.solid;
  made.offsets.assign(1, 0);
  return made;
}

bool anyScatters(const FragmentLists& lists) {
  return std::any_of(lists.fragments.begin(), lists.fragments.end(), [](const Fragment& fragment) {
    return fragment.variance > 0.0f || fragment.offset != glm::vec2(0.0f);
  });
}

LayerModel modelOf(const FragmentLists& lists) {
  LayerModel model;
  model.refracts = model.diffuses = anyScatters(lists);
  model.disperses = lists.disperses();
  return model;
}

}  // namespace pellucid
