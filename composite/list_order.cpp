#include "composite/list_order.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace pellucid {
namespace {

bool before(const Fragment& a, const Fragment& b) {
  if (a.z != b.z) return a.z < b.z;
  return std::memcmp(&a, &b, sizeof(Fragment)) < 0;
}

}  // namespace

void orderByDepthAndBits(FragmentLists& lists) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lists.solid.size(), 256), [&](const auto& pixels) {
    std::vector<std::size_t> order;
    for (std::size_t pixel = pixels.begin(); pixel != pixels.end(); ++pixel) {
      const std::size_t first = lists.offsets[pixel], last = lists.offsets[pixel + 1];
      if (!lists.hasColumns()) {
        std::sort(lists.fragments.begin() + static_cast<std::ptrdiff_t>(first),
                  lists.fragments.begin() + static_cast<std::ptrdiff_t>(last), before);
        continue;
      }
      order.resize(last - first);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Fragment &left = lists.fragments[first + a], &right = lists.fragments[first + b];
        if (before(left, right) || before(right, left)) return before(left, right);
        return lists.compareColumns(first + a, first + b) < 0;
      });
      lists.reorder(first, order);
    }
  });
}

}  // namespace pellucid
