// What reading a picture came to, told to a user in a line each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/depth_kind.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {
namespace {

// Metres, over the pixels that hit something.
double medianDepth(const GBuffer& gbuffer) {
  std::vector<float> hit;
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i)
    if (std::isfinite(gbuffer.viewZ[i])) hit.push_back(gbuffer.viewZ[i]);
  if (hit.empty()) return 0.0;
  const auto middle = hit.begin() + static_cast<std::ptrdiff_t>(hit.size() / 2);
  std::nth_element(hit.begin(), middle, hit.end());
  return static_cast<double>(*middle);
}

std::string depthLine(const OpaqueFile& file) {
  const OpaqueChoice& choice = file.choice;
  const std::size_t pixels = file.gbuffer.viewZ.size();
  std::string line =
      fmt::format("depth: {}{}{}, {}, ", choice.depthChannel, choice.depthFile.empty() ? "" : " of ", choice.depthFile,
                  choice.depthKind.empty() ? "planar" : depthKindWords(parseDepthKind(choice.depthKind)));
  if (choice.farPixels < pixels)
    line += fmt::format("{:.6g} to {:.6g}, median {:.6g} m, ", choice.least, choice.most, medianDepth(file.gbuffer));
  return line + fmt::format("1 unit is {:g} m, {:.3g}% of the pixels show nothing", file.metresPerUnit,
                            pixels ? 100.0 * static_cast<double>(choice.farPixels) / static_cast<double>(pixels) : 0.0);
}

}  // namespace

std::vector<std::string> understoodLines(const OpaqueFile& file) {
  std::string picture = "picture:";
  for (const std::string& channel : file.choice.beautyChannel)
    if (!channel.empty()) picture += " " + channel;
  const std::string part = file.document.parts[static_cast<std::size_t>(file.choice.beautyPart)].name;
  if (!part.empty() && file.document.ownParts > 1) picture += " of part " + part;
  if (!file.choice.preset.empty())
    picture += fmt::format(", preset {} by {}", file.choice.preset, file.choice.presetBy);
  picture += ", colours in " + spaceText(file.space);
  return {picture, depthLine(file)};
}

}  // namespace pellucid
