#include "gbuffer/plain_png.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace pellucid {
namespace {

constexpr std::size_t kSignature = 8, kChunkFrame = 12;  // length, name and checksum
constexpr std::uint32_t kMostEdge = 16384;               // as the codec

std::uint32_t numberAt(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

struct Chunk {
  std::string_view name;
  const std::uint8_t* data;
  std::size_t size;
};

// The chunk at `place`, which moves behind it; false where it is not whole.
bool nextChunk(const std::vector<std::uint8_t>& bytes, std::size_t& place, Chunk& chunk) {
  if (bytes.size() - place < kChunkFrame) return false;
  const std::uint8_t* const from = bytes.data() + place;
  chunk.size = numberAt(from);
  if (chunk.size > bytes.size() - place - kChunkFrame) return false;
  chunk.name = {reinterpret_cast<const char*>(from + 4), 4};
  chunk.data = from + 8;
  if (libdeflate_crc32(0, from + 4, chunk.size + 4) != numberAt(chunk.data + chunk.size)) return false;
  place += chunk.size + kChunkFrame;
  return true;
}

// Width, height and channels.
bool readHeader(const Chunk& chunk, StoredImage& image) {
  if (chunk.name != "IHDR" || chunk.size != 13) return false;
  const std::uint32_t width = numberAt(chunk.data), height = numberAt(chunk.data + 4);
  const std::uint8_t depth = chunk.data[8], kind = chunk.data[9];
  const bool plain = chunk.data[10] == 0 && chunk.data[11] == 0 && chunk.data[12] == 0;
  if (!plain || depth != 8 || width < 1 || height < 1 || width > kMostEdge || height > kMostEdge) return false;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.channels = kind == 0 ? 1 : kind == 2 ? 3 : kind == 6 ? 4 : 0;
  image.eightBit = true;
  return image.channels > 0;
}

// All packed rows, from the chunks behind the header. Some chunks change what pixels mean.
bool readPacked(const std::vector<std::uint8_t>& bytes, std::size_t place, std::vector<std::uint8_t>& packed) {
  Chunk chunk{};
  while (nextChunk(bytes, place, chunk)) {
    if (chunk.name == "IEND") return !packed.empty();
    if (chunk.name == "IDAT") {
      packed.insert(packed.end(), chunk.data, chunk.data + chunk.size);
      continue;
    }
    const bool needed = (chunk.name[0] & 0x20) == 0;
    if (needed || chunk.name == "tRNS" || chunk.name == "gAMA" || chunk.name == "sBIT") return false;
  }
  return false;
}

std::uint8_t paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int toLeft = std::abs(guess - left), toAbove = std::abs(guess - above), toCorner = std::abs(guess - corner);
  if (toLeft <= toAbove && toLeft <= toCorner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(toAbove <= toCorner ? above : corner);
}

// Undoes the filter of a row.
//   above  the row before, 0 for none
bool unfilter(int filter, const std::uint8_t* above, std::size_t size, std::size_t channels, std::uint8_t* row) {
  if (filter < 0 || filter > 4) return false;
  for (std::size_t i = 0; i < size && filter != 0; ++i) {
    const int left = i < channels ? 0 : row[i - channels], corner = i < channels ? 0 : above[i - channels];
    const int up = above[i];
    const int guess = filter == 1 ? left : filter == 2 ? up : filter == 3 ? (left + up) / 2 : paeth(left, up, corner);
    row[i] = static_cast<std::uint8_t>(row[i] + guess);
  }
  return true;
}

}  // namespace

bool readPlainPng(const std::vector<std::uint8_t>& bytes, StoredImage& image) {
  constexpr std::string_view kStart("\x89PNG\r\n\x1a\n", kSignature);
  if (bytes.size() < kSignature || std::memcmp(bytes.data(), kStart.data(), kSignature) != 0) return false;
  std::size_t place = kSignature;
  Chunk header{};
  StoredImage made;
  std::vector<std::uint8_t> packed;
  if (!nextChunk(bytes, place, header) || !readHeader(header, made) || !readPacked(bytes, place, packed)) return false;
  const auto channels = static_cast<std::size_t>(made.channels), height = static_cast<std::size_t>(made.height);
  const std::size_t size = static_cast<std::size_t>(made.width) * channels;
  // Deflate packs 1032 bytes into one at most: a header that claims more asks for no memory.
  if (packed.size() < (size + 1) * height / 1032) return false;
  std::vector<std::uint8_t> rows((size + 1) * height), none(size);
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflate || libdeflate_zlib_decompress(inflate.get(), packed.data(), packed.size(), rows.data(), rows.size(),
                                             nullptr) != LIBDEFLATE_SUCCESS)
    return false;
  made.values.resize(size * height);
  const std::uint8_t* above = none.data();
  for (std::size_t y = 0; y < height; ++y) {
    std::uint8_t* const row = rows.data() + y * (size + 1);
    if (!unfilter(row[0], above, size, channels, row + 1)) return false;
    above = row + 1;
    std::transform(above, above + size, made.values.begin() + static_cast<std::ptrdiff_t>(y * size),
                   [](std::uint8_t value) { return static_cast<float>(value) / 255.0f; });
  }
  image = std::move(made);
  return true;
}

}  // namespace pellucid
