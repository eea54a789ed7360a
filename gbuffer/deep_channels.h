// Which channel of a deep part means what, whoever wrote it.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "gbuffer/colour_space.h"

namespace pellucid {

// Colour R G B, depth Z [ZBack], opacity A, or per channel AR AG AB (with A) or RA GA BA (without); in capitals or not,
// of no layer or of one. Files of the `fragments` verb hold the whole record besides, as oit.*.
struct DeepChannels {
  int part = 0;
  std::vector<std::string> names;  // to read; the indices below point into it, -1 where the file has none
  int z = -1, zBack = -1, alpha = -1;
  std::array<int, 3> light{-1, -1, -1}, opacity{-1, -1, -1};  // opacity is alpha's where it is not coloured
  bool colouredOpacity = false;
  int coverage = -1, variance = -1;
  std::array<int, 3> transmission{-1, -1, -1};
  std::array<int, 2> offset{-1, -1};
  std::optional<Chromaticities> chromaticities;  // as the part states them
  bool latLong = false;                          // its pixels are directions all around, which flatten may have
  std::string note;                              // which of several deep parts or views is taken, "" where there is one
  bool hasRecord() const { return coverage >= 0; }
};

// Whether all parts are deep.
bool isDeep(const ExrDocument& document);

// Whether the file tells views apart, or deep parts by their names. One that does not is the same for every eye.
bool tellsViews(const ExrDocument& document);

//   view  what --view says; "" takes the first one
// Throws MeaningError when no part is deep, none is of the view, or a channel is lacking.
DeepChannels resolveDeep(const ExrDocument& document, const std::string& view = "");
// The same of a file. Throws InputError when it cannot be read.
DeepChannels resolveDeep(const std::string& path, const std::string& view = "");

// Throws MeaningError for a lat-long map, which has no place among what a camera sees.
void expectCameraPicture(const DeepChannels& channels, const std::string& path);

}  // namespace pellucid
