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
    std::vector<glm::vec4> dispersion;
    for (std::size_t pixel = pixels.begin(); pixel != pixels.end(); ++pixel) {
      const auto first = static_cast<std::ptrdiff_t>(lists.offsets[pixel]),
                 last = static_cast<std::ptrdiff_t>(lists.offsets[pixel + 1]);
      const auto begin = lists.fragments.begin() + first;
      if (!lists.disperses()) {
        std::sort(begin, lists.fragments.begin() + last, before);
        continue;
      }
      order.resize(static_cast<std::size_t>(last - first));
      std::iota(order.begin(), order.end(), std::size_t{0});
      const auto at = [&](std::size_t i) { return first + static_cast<std::ptrdiff_t>(i); };
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Fragment &left = lists.fragments[static_cast<std::size_t>(at(a))],
                       &right = lists.fragments[static_cast<std::size_t>(at(b))];
        if (before(left, right) || before(right, left)) return before(left, right);
        return std::memcmp(&lists.dispersion[static_cast<std::size_t>(at(a))],
                           &lists.dispersion[static_cast<std::size_t>(at(b))], sizeof(glm::vec4)) < 0;
      });
      std::vector<Fragment> fragments(begin, lists.fragments.begin() + last);
      dispersion.assign(lists.dispersion.begin() + first, lists.dispersion.begin() + last);
      for (std::size_t i = 0; i < order.size(); ++i) {
        lists.fragments[static_cast<std::size_t>(at(i))] = fragments[order[i]];
        lists.dispersion[static_cast<std::size_t>(at(i))] = dispersion[order[i]];
      }
    }
  });
}

}  // namespace pellucid
