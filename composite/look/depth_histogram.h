// Pixels by depth on a logarithmic axis: a wrong unit and a far value that nobody named show there.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

struct DepthBins {
  double nearest = 0, farthest = 0;  // metres; both 0 where nothing was hit
  std::vector<std::size_t> pixels;   // by bins of equal ratio from nearest to farthest
  std::size_t nothing = 0;           // pixels where nothing was hit
};

//   viewZ  planar metres above 0, +inf where nothing was hit
//   count  of bins, at least 1
DepthBins depthBins(const Image<float>& viewZ, int count = 64);
std::string histogramSvg(const DepthBins& bins);  // self-contained

}  // namespace pellucid
