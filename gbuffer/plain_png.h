// PNG as exporters mostly write it, without the many libraries of the codec that knows all images.
#pragma once
#include <cstdint>
#include <vector>

#include "gbuffer/image_codec.h"

namespace pellucid {

// As ImageCodec::read. False where the file is anything else than 8 bits a channel, grey, RGB or RGBA, row after row,
// or where anything is wrong with it: the codec reads those, and says what is wrong.
bool readPlainPng(const std::vector<std::uint8_t>& bytes, StoredImage& image);

}  // namespace pellucid
