// The structure of an EXR file, checked before any decoder or allocation trusts it.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gbuffer/exr_stream.h"
#include "gbuffer/image.h"

namespace pellucid {

struct ExrChannelLayout {
  std::string name;
  int type = 0;  // 0 uint, 1 half, 2 float
};

struct ExrPartLayout {
  std::string name, type;  // type as the attribute says; "" when there is none
  Window data;
  int compression = 0;  // as stored
  bool deep = false, tiled = false;
  std::uint32_t tileWidth = 0, tileHeight = 0;
  int levelMode = 0;  // 0 one level, 1 mip map, 2 rip map
  bool roundUp = false;
  std::uint64_t chunks = 0;
  std::uint64_t pixelBytes = 0;  // of all channels of one pixel
  std::vector<ExrChannelLayout> channels;
};

struct ExrLayout {
  bool multiPart = false;
  std::vector<ExrPartLayout> parts;
};

// Walks headers, chunk tables and the head of every chunk. Throws InputError for what is damaged, cut short, of an
// unknown kind, or refused by name (sub-sampled channels, cube maps), and for sizes that the file cannot hold;
// ResourceError for an honest file larger than the machine's memory.
ExrLayout checkLayout(const ExrSource& source, const std::string& path);

}  // namespace pellucid
