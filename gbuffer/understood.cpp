// What reading a picture came to, told to a user in a line each.
#include <fmt/format.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "gbuffer/depth_kind.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {
namespace {

// Depths are above 0, so their bits as integers have their order; those of what is no depth are larger.
std::uint32_t bitsOf(float depth) {
  return std::bit_cast<std::uint32_t>(depth);
}
constexpr std::uint32_t kNothing = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());

// Depths between which the median is sought, both included, as bits.
struct Bracket {
  std::uint32_t low = 0, high = kNothing - 1;
};

// A bracket of few depths that the median is most likely among: the middle of a sample, four standard errors wide to
// each side.
Bracket likelyBracket(const Image<float>& viewZ) {
  constexpr std::size_t kSample = 16384;
  std::vector<std::uint32_t> hit;
  const std::size_t step = std::max<std::size_t>(viewZ.size() / kSample, 1);
  std::uint32_t place = 1;  // in its step, so that no pattern of the picture is met again and again
  for (std::size_t i = 0; i + step <= viewZ.size(); i += step) {
    place = place * 1664525u + 1013904223u;
    const std::uint32_t bits = bitsOf(viewZ[i + (place >> 8) % step]);
    if (bits < kNothing) hit.push_back(bits);
  }
  if (hit.size() < kSample / 8) return {};
  const auto middle = static_cast<std::ptrdiff_t>(hit.size() / 2),
             margin = static_cast<std::ptrdiff_t>(hit.size() / 64);
  const auto low = hit.begin() + middle - margin, high = hit.begin() + middle + margin;
  std::nth_element(hit.begin(), low, hit.end());
  std::nth_element(low, high, hit.end());
  return {*low, *high};
}

struct DepthsInBracket {
  std::size_t hit = 0, below = 0;  // pixels of any depth; of one below the bracket
  std::vector<std::uint32_t> inside;
  void look(const float* z, std::size_t size, Bracket bracket) {
    for (std::size_t i = 0; i < size; ++i)
      if (const std::uint32_t bits = bitsOf(z[i]); bits >= bracket.low && bits <= bracket.high) inside.push_back(bits);
  }
};

DepthsInBracket sortedOut(const Image<float>& viewZ, Bracket bracket) {
  constexpr std::size_t kBlock = 64;  // looked at as one; most hold nothing of the bracket
  tbb::enumerable_thread_specific<DepthsInBracket> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, viewZ.size() / kBlock, 1024),
                    [&](const tbb::blocked_range<std::size_t>& blocks) {
                      DepthsInBracket& part = parts.local();
                      for (std::size_t block = blocks.begin(); block != blocks.end(); ++block) {
                        const float* z = viewZ.data() + block * kBlock;
                        std::uint32_t hit = 0, below = 0, inside = 0;
                        for (std::size_t i = 0; i < kBlock; ++i) {
                          const std::uint32_t bits = bitsOf(z[i]);
                          hit += static_cast<std::uint32_t>(bits < kNothing);
                          below += static_cast<std::uint32_t>(bits < bracket.low);
                          inside += static_cast<std::uint32_t>(bits <= bracket.high);
                        }
                        part.hit += static_cast<std::size_t>(hit);
                        part.below += static_cast<std::size_t>(below);
                        if (inside > below) part.look(z, kBlock, bracket);
                      }
                    });
  DepthsInBracket all;
  for (std::size_t i = viewZ.size() / kBlock * kBlock; i < viewZ.size(); ++i) {
    all.hit += bitsOf(viewZ[i]) < kNothing;
    all.below += bitsOf(viewZ[i]) < bracket.low;
    all.look(&viewZ[i], 1, bracket);
  }
  for (const DepthsInBracket& part : parts) {
    all.hit += part.hit;
    all.below += part.below;
    all.inside.insert(all.inside.end(), part.inside.begin(), part.inside.end());
  }
  return all;
}

// Metres, over the pixels that hit something: exactly the one in the middle.
double medianDepth(const GBuffer& gbuffer) {
  DepthsInBracket depths = sortedOut(gbuffer.viewZ, likelyBracket(gbuffer.viewZ));
  if (depths.hit == 0) return 0.0;
  const std::size_t middle = depths.hit / 2;
  if (middle < depths.below || middle - depths.below >= depths.inside.size())
    depths = sortedOut(gbuffer.viewZ, Bracket());
  const auto found = depths.inside.begin() + static_cast<std::ptrdiff_t>(middle - depths.below);
  std::nth_element(depths.inside.begin(), found, depths.inside.end());
  return static_cast<double>(std::bit_cast<float>(*found));
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
