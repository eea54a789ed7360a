#include "composite/sequence/digest.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "gbuffer/errors.h"

namespace pellucid {

namespace {

// Every bit of the word reaches every bit of the result.
std::uint64_t stirred(std::uint64_t word) {
  word = (word ^ word >> 30) * 0xBF58476D1CE4E5B9u;
  word = (word ^ word >> 27) * 0x94D049BB133111EBu;
  return word ^ word >> 31;
}

}  // namespace

void Digest::addWord(std::uint64_t word) {
  halves_[0] = std::rotl(halves_[0] ^ word * 0x9FB21C651E98DF25u, 29) * 0xD6E8FEB86659FD93u;
  halves_[1] = std::rotl(halves_[1] + word, 41) * 0xC4CEB9FE1A85EC53u ^ word >> 32;
}

void Digest::add(std::string_view text) {
  addWord(text.size());  // so that "ab" and "c" are not "a" and "bc"
  for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof(word), text.size() - at));
    addWord(word);
  }
}

std::string Digest::text() const {
  return fmt::format("{:016x}{:016x}", stirred(halves_[0] ^ std::rotl(halves_[1], 32)), stirred(halves_[1]));
}

std::string stampOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return "";
  return fmt::format("{}:{}:{}:{}.{}", status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
                     status.st_mtim.tv_nsec);
}

std::string FileDigests::of(const std::string& path) {
  Known& known = known_[path];
  const std::string stamp = stampOf(path);
  if (!stamp.empty() && stamp == known.stamp) return known.digest;
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  Digest digest;
  std::vector<char> block(std::size_t{1} << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    digest.add({block.data(), static_cast<std::size_t>(in.gcount())});
  if (in.bad()) throw InputError(path + ": cannot be read to its end");
  known = {stamp, digest.text()};
  return known.digest;
}

}  // namespace pellucid
