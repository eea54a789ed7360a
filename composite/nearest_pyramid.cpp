#include "composite/nearest_pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pellucid {
namespace {

constexpr int kMostLevels = 6;

}  // namespace

NearestPyramid::NearestPyramid(const Image<float>& viewZ) : viewZ_(viewZ) {
  int width = viewZ.width(), height = viewZ.height();
  for (int level = 1; level <= kMostLevels && (width > 1 || height > 1); ++level) {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    Image<int> nearest(width, height);
    tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
      for (int y = rows.begin(); y != rows.end(); ++y)
        for (int x = 0; x < width; ++x) {
          int found = -1;
          for (int k = 0; k < 4; ++k) {
            const int block = level - 1;
            const int child = at((2 * x + (k & 1)) << block, (2 * y + k / 2) << block, block);
            if (child < 0) continue;
            const auto index = static_cast<std::size_t>(child);
            if (found < 0 || viewZ_[index] < viewZ_[static_cast<std::size_t>(found)]) found = child;
          }
          nearest.at(x, y) = found;
        }
    });
    coarse_.push_back(std::move(nearest));
  }
}

bool NearestPyramid::hit(int x, int y) const {
  if (x < 0 || y < 0 || x >= viewZ_.width() || y >= viewZ_.height()) return false;
  return viewZ_.at(x, y) > 0.0f && viewZ_.at(x, y) <= kFar;
}

int NearestPyramid::at(int x, int y, int level) const {
  if (x < 0 || y < 0 || x >= viewZ_.width() || y >= viewZ_.height()) return -1;
  if (level == 0) return hit(x, y) ? y * viewZ_.width() + x : -1;
  return coarse_[static_cast<std::size_t>(level - 1)].at(x >> level, y >> level);
}

}  // namespace pellucid
