// Image files other than EXR, by OpenImageIO, which is loaded when the first of them is met.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/colour_space.h"

namespace pellucid {

// An image as it is stored, integers divided by their largest value. Alpha is straight, except in WebP.
struct StoredImage {
  int width = 0, height = 0, channels = 0;  // at most 4 of them
  bool floats = false, eightBit = false;
  std::optional<Chromaticities> chromaticities;  // of EXR
  std::vector<float> values;                     // width * height * channels, row by row from the top
};

struct ImageCodec {
  // Returns what is wrong, as "is damaged: ...", or "".
  //   format  an extension, as "png"; "" is refused as no known format
  std::string (*read)(const std::vector<std::uint8_t>& bytes, const std::string& format, StoredImage& image);
  // Writes width * height * 3 bytes as a PNG. Returns what went wrong, or "".
  std::string (*writePng)(const std::string& path, int width, int height, const std::uint8_t* rgb);
};

// Throws ResourceError where the part cannot be loaded.
const ImageCodec& imageCodec();

}  // namespace pellucid
