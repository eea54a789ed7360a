// An EXR file as it is: every part, header and channel in its own type, so that what is not changed leaves as it came.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

enum class PixelType { uint32, half, float32 };

struct ExrChannel {
  std::string name;  // within its part, "ViewLayer.Depth.Z"
  PixelType type = PixelType::float32;
  std::vector<std::byte> bytes;  // data window, row by row, native type; never converted
};

// One part: its OpenEXR header (all attributes, known or not) and its flat channels. Deep parts keep no pixels here.
struct ExrPart {
  struct Header;  // wraps Imf::Header, so that OpenEXR stays in one file
  std::shared_ptr<Header> header;
  std::string name;  // "" in a single-part file without a name
  Window display, data;
  bool deep = false;
  std::string compression;  // "zip", "piz", ... as exrheader prints it
  std::vector<ExrChannel> channels;

  const ExrChannel* find(const std::string& channel) const;
};

struct ExrDocument {
  std::string path;
  std::vector<ExrPart> parts;
  std::vector<std::string> notes;  // one sentence each: what was found that a user may want to know
};
