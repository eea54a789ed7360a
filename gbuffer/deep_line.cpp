#include "gbuffer/deep_line.h"

#include <Imath/half.h>
#include <libdeflate.h>

#include <bit>
#include <cstring>
#include <memory>

namespace pellucid {
namespace {

constexpr std::size_t kHead = 4 + 3 * 8;

std::uint64_t sizeAt(const std::vector<char>& chunk, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, chunk.data() + at, sizeof value);
  return value;
}

struct Inflater {
  std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> deflate{libdeflate_alloc_decompressor(),
                                                                                       libdeflate_free_decompressor};
  std::vector<char> packed, plain;
};

// Sums of the differences that EXR stores, each 128 too much, modulo 256: eight bytes at a time.
void sumDifferences(char* bytes, std::uint64_t size) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::uint64_t kLow = 0x00ff00ff00ff00ff, kEach = 0x0001000100010001, kOddOnes = 0x8000800080008000;
  std::uint64_t before = 0;  // sum of all bytes before, in every lane of 16 bits
  std::uint64_t at = 0;
  for (; at + 8 <= size; at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, sizeof word);
    const std::uint64_t odd = (word >> 8) & kLow;
    const std::uint64_t pairs = ((word & kLow) + odd) * kEach;  // sums up to each pair's end, at most 8 * 255
    const std::uint64_t ends = ((pairs & kLow) + before) & kLow;
    const std::uint64_t begins = (ends + (kLow + kEach) - odd) & kLow;  // without the pair's second byte
    before = (ends >> 48) * kEach;
    word = (begins | ends << 8) ^ kOddOnes;  // 128 too much for each byte but the first: for the odd ones
    std::memcpy(bytes + at, &word, sizeof word);
  }
  unsigned last = static_cast<unsigned>(before & 255u);
  for (; at < size; ++at) {
    last = (last + static_cast<unsigned char>(bytes[at])) & 255u;
    bytes[at] = static_cast<char>(last ^ (at % 2 ? 128u : 0u));
  }
}

// The first half are the even bytes, the second half the odd ones.
void interleave(const char* from, std::uint64_t size, char* to) {
  const char *even = from, *odd = from + (size + 1) / 2;
  constexpr std::uint64_t kAtOnce = 16;
  const std::uint64_t pairs = size / 2;
  std::uint64_t i = 0;
  for (; i + kAtOnce <= pairs; i += kAtOnce)
    for (std::uint64_t k = 0; k < kAtOnce; ++k) {
      to[2 * (i + k)] = even[i + k];
      to[2 * (i + k) + 1] = odd[i + k];
    }
  for (; i < pairs; ++i) {
    to[2 * i] = even[i];
    to[2 * i + 1] = odd[i];
  }
  if (size % 2) to[size - 1] = even[pairs];
}

// ZIPS: deflated differences of bytes, the even ones before the odd ones. A block that would not shrink is stored.
bool unpack(bool zips, const char* from, std::uint64_t packed, std::uint64_t size, Inflater& inflater) {
  inflater.plain.resize(size);
  if (packed == size) {
    if (size > 0) std::memcpy(inflater.plain.data(), from, size);
    return true;
  }
  if (!zips || packed > size || !inflater.deflate) return false;
  inflater.packed.resize(size);
  std::size_t got = 0;
  if (libdeflate_zlib_decompress(inflater.deflate.get(), from, packed, inflater.packed.data(), size, &got) !=
          LIBDEFLATE_SUCCESS ||
      got != size)
    return false;
  sumDifferences(inflater.packed.data(), size);
  interleave(inflater.packed.data(), size, inflater.plain.data());
  return true;
}

void toFloats(PixelType type, const char* from, std::uint64_t count, float* to) {
  if (count == 0) return;
  if (type == PixelType::float32) {
    std::memcpy(to, from, count * sizeof(float));
  } else if (type == PixelType::half) {
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint16_t bits = 0;
      std::memcpy(&bits, from + 2 * i, sizeof bits);
      to[i] = imath_half_to_float(bits);
    }
  } else {
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint32_t value = 0;
      std::memcpy(&value, from + 4 * i, sizeof value);
      to[i] = static_cast<float>(value);
    }
  }
}

}  // namespace

bool DeepLine::readCounts(const DeepLineFormat& format) {
  if (chunk.size() < kHead) return false;
  const std::uint64_t packed = sizeAt(chunk, 4), table = format.width * sizeof(std::uint32_t);
  if (packed > chunk.size() - kHead) return false;
  thread_local Inflater inflater;
  if (!unpack(format.zips, chunk.data() + kHead, packed, table, inflater)) return false;
  counts.resize(format.width);
  std::uint32_t before = 0;
  for (std::size_t x = 0; x < format.width; ++x) {
    std::uint32_t sum = 0;  // of this pixel and those before it
    std::memcpy(&sum, inflater.plain.data() + sizeof sum * x, sizeof sum);
    if (sum < before) return false;
    counts[x] = sum - before;
    before = sum;
  }
  samples = before;
  std::uint64_t bytes = 0;
  for (const std::size_t size : format.size) bytes += size * samples;
  return sizeAt(chunk, 20) == bytes && sizeAt(chunk, 12) <= chunk.size() - kHead - packed;
}

bool DeepLine::readSamples(const DeepLineFormat& format, const std::vector<float*>& channels) const {
  thread_local Inflater inflater;
  const std::uint64_t counted = sizeAt(chunk, 4), packed = sizeAt(chunk, 12), size = sizeAt(chunk, 20);
  if (!unpack(format.zips, chunk.data() + kHead + counted, packed, size, inflater)) return false;
  const char* from = inflater.plain.data();
  for (std::size_t c = 0; c < format.types.size(); ++c) {
    if (format.wanted[c] >= 0)
      toFloats(format.types[c], from, samples, channels[static_cast<std::size_t>(format.wanted[c])]);
    from += format.size[c] * samples;
  }
  return true;
}

}  // namespace pellucid
