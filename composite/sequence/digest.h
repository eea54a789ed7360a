// A number that says whether a picture would come out the same: of the bytes of its inputs, and of what was asked.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace pellucid {

inline constexpr const char* kDigestAttribute = "pellucid:digest";  // of an output's header

// 128 bits of texts, in the order given. It tells changes, and does not keep anyone from forging one.
class Digest {
 public:
  void add(std::string_view text);
  std::string text() const;  // 32 hexadecimal digits

 private:
  void addWord(std::uint64_t word);

  std::uint64_t halves_[2] = {0x9E3779B97F4A7C15u, 0xC2B2AE3D27D4EB4Fu};
};

// Digests of whole files, each read once while it stays the same file of the same size and time.
class FileDigests {
 public:
  // Throws InputError for a file that cannot be read.
  std::string of(const std::string& path);

 private:
  struct Known {
    std::string stamp, digest;
  };
  std::map<std::string, Known> known_;
};

// Which file of which size and time a path names, "" for none: another text where the file has changed.
std::string stampOf(const std::string& path);

}  // namespace pellucid
