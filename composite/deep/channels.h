// What a deep file's channels mean, whoever wrote it.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "composite/deep/tidy.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/fragments.h"

namespace pellucid {

// Colour R G B, depth Z [ZBack], opacity A, or per channel AR AG AB (with A) or RA GA BA (without). Files of the
// `fragments` verb hold the whole record besides, as oit.*.
struct DeepChannels {
  int part = 0;
  std::vector<std::string> names;  // to read; the indices below point into it, -1 where the file has none
  int z = -1, zBack = -1, alpha = -1;
  std::array<int, 3> light{-1, -1, -1}, opacity{-1, -1, -1};  // opacity is alpha's where it is not coloured
  bool colouredOpacity = false;
  int coverage = -1, variance = -1;
  std::array<int, 3> transmission{-1, -1, -1};
  std::array<int, 2> offset{-1, -1};
  bool hasRecord() const { return coverage >= 0; }
};

// Throws InputError when the file cannot be read, MeaningError when no part is deep or a channel is lacking.
DeepChannels resolveDeep(const std::string& path);

// What was wrong with samples and how they were read, for a note.
struct DeepOddities {
  std::size_t notFinite = 0;   // skipped
  std::size_t outOfRange = 0;  // opacity outside [0,1], clamped
  void add(const DeepOddities& other) {
    notFinite += other.notFinite;
    outOfRange += other.outOfRange;
  }
};

// Sample i of the rows. False when it is not finite, and so is nothing.
bool sampleAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double metresPerUnit,
              DeepSample& sample, DeepOddities& oddities);

// A piece of opacity and light at one depth, as a record: coverage (1 - t) gives the opacity back.
Fragment fragmentAt(const DeepSample& sample, double z);

// One name per channel of the file that the `fragments` verb writes, and the record's values in the same order.
const std::vector<std::string>& recordChannels();
std::array<float, 16> recordValues(const Fragment& fragment);
Fragment recordAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double metresPerUnit);

}  // namespace pellucid
