#include "gbuffer/exr_layout.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// OpenEXR's own bound of coordinates.
constexpr std::int64_t kLargestCoordinate = (1LL << 30) - 1;
// Decoders allocate whole tiles and chunks, several per thread, whatever the file holds.
constexpr std::uint64_t kLargestTileBytes = 256ULL << 20;
// What a file of any size may claim to hold; beyond it the claim is compared with the file's size.
constexpr std::uint64_t kAlwaysPlausibleBytes = 64ULL << 20;
// Deflate cannot shrink below 1 : 1032; DWA stacks it on run lengths of 8x8 blocks.
constexpr std::uint64_t kLargestRatio = 1100, kLargestDwaRatio = 1100 * 128;
constexpr const char* kCompressionNames[] = {"none",  "rle", "zips", "zip",  "piz",
                                             "pxr24", "b44", "b44a", "dwaa", "dwab"};
constexpr int kLinesPerChunk[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// Reads forward, in blocks, and refuses to pass the end.
class Cursor {
 public:
  Cursor(const ExrSource& source, const std::string& path) : source_(source), path_(path) {}
  std::uint64_t at = 0;

  void bytes(void* to, std::size_t count) {
    if (at < blockStart_ || at + count > blockStart_ + block_.size()) {
      block_.resize(
          std::max<std::size_t>(count, std::min<std::uint64_t>(4096, source_.size() - std::min(at, source_.size()))));
      blockStart_ = at;
      if (!source_.readAt(at, block_.data(), block_.size())) cutShort();
    }
    std::memcpy(to, block_.data() + (at - blockStart_), count);
    at += count;
  }
  template <class T>
  T number() {  // little endian, as this machine
    T value{};
    bytes(&value, sizeof value);
    return value;
  }
  std::string name() {  // up to 255 bytes and a zero
    std::string text;
    for (char c = number<char>(); c != 0; c = number<char>()) {
      text += c;
      if (text.size() > 255) throw InputError(path_ + ": damaged header: found a name without end");
    }
    return text;
  }
  [[noreturn]] void cutShort() const {
    throw InputError(
        fmt::format("{}: cut short: the file ends at byte {}, expected more at byte {}", path_, source_.size(), at));
  }

 private:
  const ExrSource& source_;
  const std::string& path_;
  std::vector<char> block_;
  std::uint64_t blockStart_ = 0;
};

struct HeaderReader {
  Cursor& in;
  const std::string& path;
  ExrPartLayout part;
  bool hasChannels = false, hasCompression = false, hasData = false, hasTiles = false;
  std::int64_t chunkCount = -1;

  [[noreturn]] void refuse(const std::string& what) const {
    std::string sentence = part.name.empty() ? what : "part " + part.name + ": " + what;
    for (char& c : sentence)
      if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';  // damaged names hold anything
    throw InputError(fmt::format("{}: {}", path, sentence));
  }

  // One header; false for the empty one that ends a list of parts.
  bool read() {
    bool any = false;
    for (std::string name = in.name(); !name.empty(); name = in.name()) {
      any = true;
      const std::string type = in.name();
      const auto size = in.number<std::int32_t>();
      const std::uint64_t start = in.at;
      if (size < 0) refuse(fmt::format("damaged header: attribute {} has {} bytes", name, size));
      readValue(name, type, size);
      if (in.at > start + static_cast<std::uint64_t>(size))
        refuse(fmt::format("damaged header: attribute {} of type {} has only {} bytes", name, type, size));
      in.at = start + static_cast<std::uint64_t>(size);
    }
    return any;
  }

  void readValue(const std::string& name, const std::string& type, std::int32_t size) {
    if (name == "channels" && type == "chlist") {
      readChannels();
    } else if (name == "compression" && type == "compression") {
      part.compression = in.number<std::uint8_t>();
      hasCompression = true;
      if (part.compression >= static_cast<int>(std::size(kCompressionNames)))
        refuse(fmt::format("found compression number {}, expected 0 to 9", part.compression));
    } else if (name == "dataWindow" && type == "box2i") {
      readDataWindow();
    } else if (name == "tiles" && type == "tiledesc") {
      part.tileWidth = in.number<std::uint32_t>();
      part.tileHeight = in.number<std::uint32_t>();
      const auto mode = in.number<std::uint8_t>();
      part.levelMode = mode & 15;
      part.roundUp = (mode >> 4) == 1;
      hasTiles = true;
      if (part.levelMode > 2 || (mode >> 4) > 1) refuse(fmt::format("damaged header: tile mode {}", mode));
    } else if (name == "chunkCount" && type == "int") {
      chunkCount = in.number<std::int32_t>();
    } else if (name == "envmap" && type == "envmap") {
      if (in.number<std::uint8_t>() == 1) refuse("found a cube map, expected one view of a scene");
    } else if (type == "preview" && size >= 8) {
      const auto width = in.number<std::uint32_t>(), height = in.number<std::uint32_t>();
      if (std::uint64_t{width} * height * 4 + 8 != static_cast<std::uint64_t>(size))
        refuse(fmt::format("damaged header: preview of {} x {} pixels in {} bytes", width, height, size));
    } else if ((name == "type" || name == "name") && type == "string") {
      if (size > 255) refuse(fmt::format("damaged header: {} of {} bytes", name, size));
      std::string& text = name == "type" ? part.type : part.name;
      text.resize(static_cast<std::size_t>(size));
      if (size > 0) in.bytes(text.data(), text.size());
    }
  }

  void readChannels() {
    static constexpr std::uint64_t kBytes[] = {4, 2, 4};
    hasChannels = true;
    for (std::string name = in.name(); !name.empty(); name = in.name()) {
      const auto type = in.number<std::int32_t>();
      in.at += 4;  // linearity hint and padding
      const auto xSampling = in.number<std::int32_t>(), ySampling = in.number<std::int32_t>();
      if (type < 0 || type > 2) refuse(fmt::format("channel {}: found type number {}, expected 0 to 2", name, type));
      if (xSampling != 1 || ySampling != 1)
        refuse(fmt::format("channel {}: found {} x {} sub-sampling{}, expected every pixel", name, xSampling, ySampling,
                           name == "RY" || name == "BY" ? " (luminance-chroma)" : ""));
      // Pixels are read in the order of the names: in another, each channel would have another's values.
      if (!part.channels.empty() && !(part.channels.back().name < name))
        refuse(fmt::format("damaged header: found channel {} after {}, expected them in the order of their names", name,
                           part.channels.back().name));
      part.channels.push_back({name, type});
      part.pixelBytes += kBytes[type];
    }
  }

  void readDataWindow() {
    std::int32_t box[4];
    in.bytes(box, sizeof box);
    hasData = true;
    for (const std::int32_t value : box)
      if (std::abs(std::int64_t{value}) > kLargestCoordinate)
        refuse(fmt::format("data window: found ({} {}) - ({} {}), expected coordinates within +-2^30", box[0], box[1],
                           box[2], box[3]));
    if (box[0] > box[2] || box[1] > box[3])
      refuse(fmt::format("data window: found ({} {}) - ({} {}), expected at least one pixel", box[0], box[1], box[2],
                         box[3]));
    part.data = {box[0], box[1], box[2] + 1, box[3] + 1};
  }

  void finish(bool multiPart, std::uint32_t flags) {
    const bool typed = multiPart || (flags & 0x800);
    part.deep = typed && part.type.starts_with("deep");
    part.tiled = typed ? part.type == "tiledimage" || part.type == "deeptile" : (flags & 0x200) != 0;
    if (typed && part.type != "scanlineimage" && part.type != "tiledimage" && part.type != "deepscanline" &&
        part.type != "deeptile")
      refuse(
          fmt::format("found part type '{}', expected scanlineimage, tiledimage, deepscanline or deeptile", part.type));
    if (!hasChannels || !hasCompression || !hasData || (part.tiled && !hasTiles))
      refuse(fmt::format("damaged header: expected the attribute {}", !hasChannels      ? "channels"
                                                                      : !hasCompression ? "compression"
                                                                      : !hasData        ? "dataWindow"
                                                                                        : "tiles"));
    if (part.channels.empty()) refuse("found no channels, expected at least one");
    if (part.tiled)
      countTiles();
    else
      countLines();
    if (typed && chunkCount >= 0 && static_cast<std::uint64_t>(chunkCount) != part.chunks)
      refuse(fmt::format("damaged header: found {} chunks, expected {}", chunkCount, part.chunks));
  }

  void countLines() {
    const auto lines = static_cast<std::uint64_t>(kLinesPerChunk[part.compression]);
    const auto width = static_cast<std::uint64_t>(part.data.width()),
               height = static_cast<std::uint64_t>(part.data.height());
    part.chunks = (height + lines - 1) / lines;
    if (height < lines && width * lines * part.pixelBytes > kLargestTileBytes)
      refuse(fmt::format("found {} pixels a line for {} lines of {} compression, which cannot be decoded", width,
                         height, kCompressionNames[part.compression]));
  }

  void countTiles() {
    if (part.tileWidth == 0 || part.tileHeight == 0 ||
        std::uint64_t{part.tileWidth} * part.tileHeight >
            kLargestTileBytes / std::max<std::uint64_t>(part.pixelBytes, 1))
      refuse(fmt::format("tiles: found {} x {} pixels of {} bytes, expected at most {} MiB", part.tileWidth,
                         part.tileHeight, part.pixelBytes, kLargestTileBytes >> 20));
    const auto sizes = [&](int size) {
      std::vector<std::uint64_t> levels{static_cast<std::uint64_t>(size)};
      while (levels.back() > 1) levels.push_back(part.roundUp ? (levels.back() + 1) / 2 : levels.back() / 2);
      return levels;
    };
    const auto tiles = [](std::uint64_t size, std::uint64_t tile) { return (size + tile - 1) / tile; };
    const auto widths = sizes(part.data.width()), heights = sizes(part.data.height());
    if (part.levelMode == 0) {
      part.chunks = tiles(widths[0], part.tileWidth) * tiles(heights[0], part.tileHeight);
    } else if (part.levelMode == 1) {
      for (std::size_t i = 0; i < std::max(widths.size(), heights.size()); ++i)
        part.chunks += tiles(i < widths.size() ? widths[i] : 1, part.tileWidth) *
                       tiles(i < heights.size() ? heights[i] : 1, part.tileHeight);
    } else {
      for (const std::uint64_t width : widths)
        for (const std::uint64_t height : heights)
          part.chunks += tiles(width, part.tileWidth) * tiles(height, part.tileHeight);
    }
  }
};

// The head of each chunk: that it lies in the file, belongs to this part and is whole.
void checkChunks(Cursor table, const ExrSource& source, const ExrLayout& layout, const std::string& path) {
  std::uint64_t tableBytes = 0;
  for (const ExrPartLayout& part : layout.parts) tableBytes += part.chunks * 8;
  const std::uint64_t firstChunk = table.at + tableBytes;
  Cursor chunk(source, path);
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const ExrPartLayout& part = layout.parts[p];
    for (std::uint64_t i = 0; i < part.chunks; ++i) {
      const std::string where = layout.multiPart ? fmt::format("part {} ({})", p, part.name) : "the image";
      chunk.at = table.number<std::uint64_t>();
      if (chunk.at == 0)
        throw InputError(
            fmt::format("{}: cut short: chunk {} of {} of {} was never written", path, i, part.chunks, where));
      if (chunk.at < firstChunk || chunk.at >= source.size())
        throw InputError(fmt::format("{}: cut short or damaged: chunk {} of {} of {} at byte {} of {}", path, i,
                                     part.chunks, where, chunk.at, source.size()));
      if (layout.multiPart && chunk.number<std::int32_t>() != static_cast<std::int32_t>(p))
        throw InputError(fmt::format("{}: damaged: chunk {} of {} belongs to another part", path, i, where));
      chunk.at += part.tiled ? 16 : 4;
      std::uint64_t size = 0;
      if (part.deep) {
        const auto counts = chunk.number<std::uint64_t>(), samples = chunk.number<std::uint64_t>();
        chunk.at += 8;
        size = counts > source.size() || samples > source.size() ? source.size() : counts + samples;
      } else {
        const auto bytes = chunk.number<std::int32_t>();
        size = bytes < 0 ? source.size() : static_cast<std::uint64_t>(bytes);
      }
      if (size > source.size() - std::min(chunk.at, source.size()))
        throw InputError(fmt::format("{}: cut short or damaged: chunk {} of {} of {} claims {} bytes at byte {} of {}",
                                     path, i, part.chunks, where, size, chunk.at, source.size()));
    }
  }
}

void checkSizes(std::uint64_t tableStart, const ExrSource& source, const ExrLayout& layout, const std::string& path) {
  std::uint64_t room = source.size() - std::min(tableStart, source.size()), raw = 0;
  for (const ExrPartLayout& part : layout.parts) {
    // Every chunk has a table entry and at least a head of 8 bytes.
    if (part.chunks > room / 16)
      throw InputError(fmt::format("{}: cut short or damaged: {} x {} pixels need {} chunks, but {} bytes are left",
                                   path, part.data.width(), part.data.height(), part.chunks, room));
    room -= part.chunks * 16;
    if (part.deep) continue;
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(part.data.width()) * static_cast<std::uint64_t>(part.data.height());
    const std::uint64_t bytes = pixels > (1ULL << 60) / part.pixelBytes ? 1ULL << 60 : pixels * part.pixelBytes;
    const std::uint64_t ratio = part.compression == 0 ? 1 : part.compression >= 8 ? kLargestDwaRatio : kLargestRatio;
    if (bytes > kAlwaysPlausibleBytes && bytes / ratio > source.size())
      throw InputError(fmt::format(
          "{}: damaged: {} x {} pixels of {} bytes cannot come from {} bytes of {} compression", path,
          part.data.width(), part.data.height(), part.pixelBytes, source.size(), kCompressionNames[part.compression]));
    raw += bytes;
  }
  const auto memory =
      static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  if (raw > memory)
    throw ResourceError(fmt::format("{}: needs {} MiB of memory, found {} MiB", path, raw >> 20, memory >> 20));
}

}  // namespace

ExrLayout checkLayout(const ExrSource& source, const std::string& path) {
  Cursor in(source, path);
  if (source.size() < 8)
    throw InputError(fmt::format("{}: found {} bytes, expected an OpenEXR file", path, source.size()));
  if (in.number<std::uint32_t>() != 20000630U)
    throw InputError(path + ": found something else, expected an OpenEXR file");
  const auto version = in.number<std::uint32_t>();
  if ((version & 0xff) != 2 || (version & ~0x1effU))
    throw InputError(fmt::format("{}: found OpenEXR version and flags {:#x}, expected version 2", path, version));
  ExrLayout layout;
  layout.multiPart = (version & 0x1000) != 0;
  for (bool more = true; more;) {
    HeaderReader header{in, path, {}, false, false, false, false, -1};
    if (!header.read()) {
      if (layout.multiPart && !layout.parts.empty()) break;
      throw InputError(path + ": damaged: found an empty header");
    }
    header.finish(layout.multiPart, version);
    layout.parts.push_back(std::move(header.part));
    more = layout.multiPart;
  }
  checkSizes(in.at, source, layout, path);
  checkChunks(in, source, layout, path);
  return layout;
}

}  // namespace pellucid
