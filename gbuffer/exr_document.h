// An EXR file as it is: every part, header and channel in its own type, so that what is not changed leaves as it came.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

enum class PixelType { uint32, half, float32 };
constexpr std::size_t bytesOf(PixelType type) {
  return type == PixelType::half ? 2 : 4;
}
const char* nameOf(PixelType type);  // "uint", "half", "float"

struct ExrChannel {
  std::string name;  // within its part, "ViewLayer.Depth.Z"
  PixelType type = PixelType::float32;
  std::vector<std::byte> bytes;  // data window, row by row, native type; never converted; empty in deep parts

  // Value of pixel i (row by row), as float. uint above 2^24 rounds.
  float at(std::size_t i) const;
};

// As the file stores it, known to OpenEXR or not.
struct ExrAttribute {
  std::string type;   // "string", "m44f", "box2i", ...
  std::string bytes;  // little endian
  bool operator==(const ExrAttribute&) const = default;
};

// One part: its OpenEXR header and its flat channels. Deep parts keep no pixels here.
struct ExrPart {
  struct Header;  // wraps Imf::Header, so that OpenEXR stays in few files
  std::shared_ptr<const Header> header;
  std::string from;  // "" in the document's own file, else the file beside it
  std::string name;  // "" in a single-part file without a name
  std::string view;  // "" unless the part says so
  Window display, data;
  double pixelAspect = 1.0;
  bool deep = false, tiled = false;
  int levelMode = 0;        // 0 one level, 1 mip map, 2 rip map: only level 0 is read
  std::string compression;  // "zip", "piz", ...
  std::vector<ExrChannel> channels;
  std::map<std::string, ExrAttribute> attributes;

  const ExrChannel* find(const std::string& channel) const;
  std::optional<std::string> text(const std::string& attribute) const;  // of type string
};

class ExrSource;

struct ExrDocument {
  std::string path;
  bool multiPart = false;
  std::vector<ExrPart> parts;
  std::size_t ownParts = 0;                 // that are written; behind them stand those of files beside it
  std::vector<std::string> views;           // in order, the first is the default; "" or empty when the file has none
  std::vector<std::string> notes;           // one sentence each: what was found that a user may want to know
  std::shared_ptr<const ExrSource> source;  // still open: parts that do not change are copied from it as they are
};

// Reads scanline, tiled and multi-part files with any windows, types and compressions. Throws InputError for what is
// missing, damaged, cut short, or refused by name (sub-sampled channels, cube maps), ResourceError when memory runs
// out.
ExrDocument readExr(const std::string& path);
// A text of the first part's header alone, without any pixels; nothing where it has none by that name. Throws
// InputError.
std::optional<std::string> exrText(const std::string& path, const std::string& name);

// What is to change in a part. Bytes as in ExrChannel.
struct ExrPartEdit {
  std::map<std::string, std::vector<std::byte>> replaced;  // channel of the part -> its new values
  std::vector<ExrChannel> added;
  std::map<std::string, std::string> attributes;  // string attributes, added or replaced
};

// Writes the document with its edits (part index -> edit): same parts, windows, attributes, types, line order and
// tiles. A part whose pixels do not change is copied without decoding, whatever its compression, deep samples included.
// A part whose pixels change keeps its compression if that is lossless for what is written, else becomes ZIP; the
// returned notes say so. Written to a temporary file, then renamed; `path` may be the file that was read. Throws
// ResourceError, or InputError for an edit of a mip-mapped or rip-mapped part: its lower levels would go stale.
std::vector<std::string> writeExr(const std::string& path, const ExrDocument& document,
                                  const std::map<int, ExrPartEdit>& edits = {});

// A new scanline ZIP part, in which `channels` lie.
struct NewExr {
  std::string part;  // its name; needed where there are several
  Window display, data;
  double pixelAspect = 1.0;
  std::vector<ExrChannel> channels;
  std::map<std::string, std::string> attributes;
  std::map<std::string, std::vector<float>> matrices;  // 16 numbers each, row major, as m44f attributes
  std::vector<float> chromaticities;                   // 8 numbers as EXR has them, or none
  // A part whose attributes are copied, but for those of storage and those that are given above; may be null.
  const ExrPart* like = nullptr;
};
void writeNewExr(const std::string& path, const NewExr& file);
// Several parts of one display window, in order.
void writeNewExr(const std::string& path, const std::vector<NewExr>& parts);

}  // namespace pellucid
