// A file in the address space, and bytes that keep what they lie in alive: the one thing glTF readers hand around.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

using Bytes = std::span<const std::uint8_t>;

class MappedFile;

// A file that is open for reading; closed with the last of its owners.
class OpenFile {
 public:
  // Throws InputError when it is missing or unreadable.
  //   whose  begins the sentence: "scene.gltf: buffers[0]"
  OpenFile(const std::string& path, const std::string& whose);
  // Takes an open descriptor.
  //   path  for messages
  OpenFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept : descriptor_(other.descriptor_), path_(std::move(other.path_)) {
    other.descriptor_ = -1;
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }
  // Throws InputError unless it is a regular file: a device or a pipe has no size to check against.
  std::size_t size(const std::string& whose) const;

 private:
  int descriptor_;
  std::string path_;
};

// All of a regular file. Throws InputError.
std::vector<std::uint8_t> readWhole(const OpenFile& file, const std::string& whose);

// Bounds the pages of several mapped files that are in memory at once, to the limit and what is announced at a time:
// what is read is announced beforehand, and when that has come to more than the limit, the next settle() lets all of it
// go. Between two of them nothing leaves: a page let go while it is still read would come back without an entry. One
// thread at a time.
class PageLedger {
 public:
  // The most that a kernel brings in around a byte that is read: Linux 6.18 maps whole folios of its page cache.
  static constexpr std::size_t kWindow = std::size_t{2} << 20;

  explicit PageLedger(std::size_t limit) : limit_(limit) {}
  std::size_t limit() const { return limit_; }

 private:
  friend class MappedFile;
  void letAllGo();
  std::size_t limit_, held_ = 0;
  std::vector<const MappedFile*> files_;
};

// Read-only. Pages come into memory as they are read and leave when they are let go, so a file may be larger than
// memory. When the file is cut short or its disk fails while it is mapped, reading goes on with zeros and
// requireWhole() throws: whoever used what was read asks it before anybody believes the result.
class MappedFile {
 public:
  // Throws InputError when the file is missing, not a regular file or unreadable.
  //   whose   begins the sentence: "scene.gltf: buffers[0]"
  //   ledger  null: pages stay until they are let go
  MappedFile(const std::string& path, const std::string& whose, std::shared_ptr<PageLedger> ledger = nullptr);
  MappedFile(const OpenFile& file, const std::string& whose, std::shared_ptr<PageLedger> ledger = nullptr);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  Bytes bytes() const { return bytes_; }
  const std::string& path() const { return path_; }
  // What was announced to the ledger so far is read no more.
  void settle() const;
  // These bytes are about to be read.
  void announce(Bytes part) const;
  // The pages that lie in these bytes leave memory; reading them again brings them back. Any bytes may be named.
  void letGo(Bytes part) const;
  // Throws InputError when some of the file could not be read.
  void requireWhole() const;

  struct Slot;  // one entry of the list that the handler of bus errors walks

 private:
  friend class PageLedger;
  void letAnnouncedGo() const;

  std::string path_, whose_;
  Bytes bytes_;
  Slot* slot_ = nullptr;
  std::shared_ptr<PageLedger> ledger_;
  mutable std::vector<bool> announced_;  // by window
};

// Bytes of a file, or decoded ones that lie in memory.
class SharedBytes {
 public:
  SharedBytes() = default;
  explicit SharedBytes(std::shared_ptr<const MappedFile> file) : bytes_(file->bytes()), file_(std::move(file)) {}
  explicit SharedBytes(std::vector<std::uint8_t> decoded)
      : memory_(std::make_shared<const std::vector<std::uint8_t>>(std::move(decoded))) {
    bytes_ = *memory_;
  }

  Bytes bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  SharedBytes part(std::size_t offset, std::size_t length) const {
    SharedBytes some = *this;
    some.bytes_ = bytes_.subspan(offset, length);
    return some;
  }
  // The file they lie in; null for bytes in memory.
  const std::shared_ptr<const MappedFile>& file() const { return file_; }

 private:
  Bytes bytes_;
  std::shared_ptr<const MappedFile> file_;
  std::shared_ptr<const std::vector<std::uint8_t>> memory_;
};

}  // namespace pellucid
