// Samples of deep files as numbers to composite, and as records.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "composite/deep/tidy.h"
#include "gbuffer/deep_channels.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/depth_kind.h"
#include "gbuffer/fragments.h"

namespace pellucid {

// Deeper than any: where a sample at infinity stands, so that arithmetic with it stays finite.
inline constexpr double kFarthest = static_cast<double>(std::numeric_limits<float>::max());

// What was wrong with samples and how they were read, for a note.
struct DeepOddities {
  std::size_t notFinite = 0;   // skipped
  std::size_t outOfRange = 0;  // opacity outside [0,1], clamped
  void add(const DeepOddities& other) {
    notFinite += other.notFinite;
    outOfRange += other.outOfRange;
  }
};

// Sample i of the rows. False when it is not a number, and so is nothing. Infinitely far is far: kFarthest.
//   depth  from the file's numbers
//   x, y   its pixel, in display coordinates
bool sampleAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, const DepthConverter& depth, int x,
              int y, DeepSample& sample, DeepOddities& oddities);

// A piece of opacity and light at one depth, as a record: coverage (1 - t) gives the opacity back.
Fragment fragmentAt(const DeepSample& sample, double z);

// One name per channel of the file that the `fragments` verb writes, and the record's values in the same order.
const std::vector<std::string>& recordChannels();
std::array<float, 16> recordValues(const Fragment& fragment);
//   z  of the sample, planar metres
Fragment recordAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double z);

}  // namespace pellucid
