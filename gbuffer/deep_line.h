// One scanline of a deep EXR as the file stores it, decoded without OpenEXR's pointer per pixel.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"

namespace pellucid {

// What all lines of a part share.
struct DeepLineFormat {
  bool zips = false;  // else the line is stored as it is
  std::size_t width = 0;
  std::vector<PixelType> types;   // of all channels of the file, in its order
  std::vector<int> wanted;        // per channel of the file: which of the results it is, -1 for none
  std::vector<std::size_t> size;  // bytes of a value, per channel
};

// A chunk as DeepScanLineInputPart::rawPixelData gives it: y, three sizes, the packed counts, the packed samples.
struct DeepLine {
  std::vector<char> chunk;
  std::vector<std::uint32_t> counts;  // of each pixel
  std::uint64_t samples = 0;

  // Unpacks the counts. False when the chunk is damaged.
  bool readCounts(const DeepLineFormat& format);
  // Unpacks the wanted channels, as floats: channel c to channels[c], `samples` of them each. False for damage.
  bool readSamples(const DeepLineFormat& format, const std::vector<float*>& channels) const;
};

}  // namespace pellucid
