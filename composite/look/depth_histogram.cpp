#include "composite/look/depth_histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr double kLeft = 20, kRight = 700, kTop = 30, kBottom = 170;

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, words);
}

}  // namespace

DepthBins depthBins(const Image<float>& viewZ, int count) {
  DepthBins bins;
  bins.pixels.assign(static_cast<std::size_t>(count), 0);
  for (std::size_t i = 0; i < viewZ.size(); ++i) {
    const double z = static_cast<double>(viewZ[i]);
    if (!std::isfinite(z)) {
      ++bins.nothing;
      continue;
    }
    bins.nearest = bins.farthest > 0 ? std::min(bins.nearest, z) : z;
    bins.farthest = std::max(bins.farthest, z);
  }
  const double span = bins.farthest > bins.nearest ? std::log(bins.farthest / bins.nearest) : 1.0;
  for (std::size_t i = 0; i < viewZ.size(); ++i) {
    const double z = static_cast<double>(viewZ[i]);
    if (!std::isfinite(z)) continue;
    const int bin = static_cast<int>(std::log(z / bins.nearest) / span * count);
    ++bins.pixels[static_cast<std::size_t>(std::clamp(bin, 0, count - 1))];
  }
  return bins;
}

std::string histogramSvg(const DepthBins& bins) {
  std::string svg = fmt::format(
      "<svg class=\"histogram\" xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" height=\"210\" "
      "viewBox=\"0 0 720 210\" font-family=\"sans-serif\" font-size=\"12\">{}",
      text(kLeft, 18, "start", "Pixels by depth, in bins of equal ratio"));
  const std::size_t most = *std::max_element(bins.pixels.begin(), bins.pixels.end());
  const double width = (kRight - kLeft) / static_cast<double>(bins.pixels.size());
  for (std::size_t i = 0; i < bins.pixels.size() && most > 0; ++i) {
    const double height = (kBottom - kTop) * static_cast<double>(bins.pixels[i]) / static_cast<double>(most);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#4677b0\"/>",
                       kLeft + static_cast<double>(i) * width, kBottom - height, width, height);
  }
  svg += fmt::format("<path d=\"M{} {}H{}\" stroke=\"#222\"/>", kLeft, kBottom, kRight);
  if (most > 0)
    svg += text(kLeft, kBottom + 18, "start", fmt::format("{:.4g} m", bins.nearest)) +
           text(kRight, kBottom + 18, "end", fmt::format("{:.4g} m", bins.farthest));
  return svg + text((kLeft + kRight) / 2, kBottom + 32, "middle", fmt::format("nothing hit: {} pixels", bins.nothing)) +
         "</svg>\n";
}

}  // namespace pellucid
