// Files as OpenEXR reads and writes them, with errors told apart: a short file is the file's fault, a full disk is not.
#pragma once
#include <OpenEXR/ImfIO.h>

#include <string>
#include <vector>

namespace pellucid {

// An open file. Stays the same file when its path is replaced, so that parts can be copied from it at any time.
class ExrSource : public OPENEXR_IMF_NAMESPACE::IStream {
 public:
  explicit ExrSource(const std::string& path);  // throws InputError: missing, not a regular file, not permitted
  ExrSource(const ExrSource& same);             // the same open file, its own position
  ExrSource& operator=(const ExrSource&) = delete;
  ~ExrSource() override;

  std::uint64_t size() const { return size_; }
  bool changed() const;  // written to since it was opened
  // Bytes [at, at + count) into `to`, false when the file does not hold them. Leaves the position alone.
  bool readAt(std::uint64_t at, void* to, std::size_t count) const;

  bool read(char to[], int count) override;  // throws Iex::InputExc at the end of the file
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0, position_ = 0;
  std::int64_t modified_ = 0;  // nanoseconds
};

// Writes to an existing file. After an error nothing more is written, and finish() says why: OpenEXR swallows errors in
// its destructors, and not all of its threaded code bears an exception from a stream.
class ExrSink : public OPENEXR_IMF_NAMESPACE::OStream {
 public:
  //   path    the file to open, which is there
  //   target  the name that errors speak of
  ExrSink(const std::string& path, const std::string& target);
  ~ExrSink() override;

  void write(const char from[], int count) override;
  std::uint64_t tellp() override { return bufferStart_ + buffer_.size(); }
  void seekp(std::uint64_t position) override;
  void finish();  // writes out and closes; throws ResourceError for any error up to here

 private:
  void flush();

  std::string target_;
  int descriptor_ = -1;
  int error_ = 0;
  std::uint64_t bufferStart_ = 0;
  std::vector<char> buffer_;
};

}  // namespace pellucid
