// What reading a picture came to, told to a user in a line each.
#include <fmt/format.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "gbuffer/depth_kind.h"
#include "gbuffer/object_coverage.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {
namespace {

// How often each number below kDigits occurs.
using Counts = std::vector<std::uint32_t>;
constexpr std::size_t kDigits = 65536;

// Depths are above 0, so their bits as integers have their order.
std::uint32_t bitsOf(float depth) {
  return std::bit_cast<std::uint32_t>(depth);
}

//   count  raises some of two tables of counts for two depths; with one table, depths that are alike would wait for
//          each other
template <class Count>
Counts countsOf(const Image<float>& viewZ, const Count& count) {
  tbb::enumerable_thread_specific<std::array<Counts, 2>> parts([] {
    return std::array<Counts, 2>{Counts(kDigits, 0), Counts(kDigits, 0)};
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, viewZ.size(), kDigits),
                    [&](const tbb::blocked_range<std::size_t>& pixels) {
                      std::array<Counts, 2>& counts = parts.local();
                      const float* z = viewZ.data();
                      std::size_t i = pixels.begin();
                      for (; i + 1 < pixels.end(); i += 2) {
                        count(bitsOf(z[i]), counts[0].data());
                        count(bitsOf(z[i + 1]), counts[1].data());
                      }
                      if (i < pixels.end()) count(bitsOf(z[i]), counts[0].data());
                    });
  Counts sum(kDigits, 0);
  for (const std::array<Counts, 2>& part : parts)
    for (const Counts& counts : part)
      for (std::size_t digit = 0; digit < kDigits; ++digit) sum[digit] += counts[digit];
  return sum;
}

// The digit at which `rank` is spent; what is left of it is the rank among those of that digit.
std::uint32_t digitAt(const Counts& counts, std::size_t& rank) {
  std::uint32_t digit = 0;
  while (rank >= counts[digit]) rank -= counts[digit++];
  return digit;
}

// Metres, over the pixels that hit something: exactly the middle one, found by its upper and then its lower half.
double medianDepth(const GBuffer& gbuffer) {
  const Counts upper = countsOf(gbuffer.viewZ, [](std::uint32_t bits, std::uint32_t* counts) { ++counts[bits >> 16]; });
  const auto finite = upper.begin() + (bitsOf(std::numeric_limits<float>::infinity()) >> 16);
  const std::size_t hit = std::accumulate(upper.begin(), finite, std::size_t{0});
  if (hit == 0) return 0.0;
  std::size_t rank = hit / 2;
  const std::uint32_t high = digitAt(upper, rank);
  const Counts lower = countsOf(gbuffer.viewZ, [high](std::uint32_t bits, std::uint32_t* counts) {
    if (bits >> 16 == high) ++counts[bits & 0xffffu];
  });
  return static_cast<double>(std::bit_cast<float>(high << 16 | digitAt(lower, rank)));
}

// In metres, over the pixels that hit something; what the file has may be another unit or kind.
std::string metresText(const OpaqueFile& file) {
  const Image<float>& viewZ = file.gbuffer.viewZ;
  float least = std::numeric_limits<float>::infinity(), most = 0.0f;
  for (std::size_t i = 0; i < viewZ.size(); ++i)
    if (std::isfinite(viewZ[i])) least = std::min(least, viewZ[i]), most = std::max(most, viewZ[i]);
  const std::string stored = fmt::format("{:.6g} to {:.6g}", file.choice.least, file.choice.most),
                    metres = fmt::format("{:.6g} to {:.6g}", least, most);
  return stored == metres ? stored : fmt::format("{}, which is {} m", stored, metres);
}

std::string depthLine(const OpaqueFile& file) {
  const OpaqueChoice& choice = file.choice;
  const std::size_t pixels = file.gbuffer.viewZ.size();
  std::string line =
      fmt::format("depth: {}{}{}, {}, ", choice.depthChannel, choice.depthFile.empty() ? "" : " of ", choice.depthFile,
                  choice.depthKind.empty() ? "planar" : depthKindWords(parseDepthKind(choice.depthKind)));
  if (choice.farPixels < pixels)
    line += fmt::format("{}, median {:.6g} m, ", metresText(file), medianDepth(file.gbuffer));
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
  std::vector<std::string> lines = {picture, depthLine(file)};
  if (file.gbuffer.objects)
    lines.push_back(fmt::format("edges: where colours do not tell how much of a pixel is whose, Cryptomatte {} does",
                                file.gbuffer.objects->layer()));
  return lines;
}

}  // namespace pellucid
