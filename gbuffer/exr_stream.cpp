#include "gbuffer/exr_stream.h"

#include <OpenEXR/Iex.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {
constexpr std::size_t kBufferBytes = 1 << 20;

std::int64_t modifiedAt(const struct stat& info) {
  return std::int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec;
}
}  // namespace

ExrSource::ExrSource(const std::string& path) : IStream(path.c_str()) {
  // Without O_NONBLOCK a named pipe would wait for a writer that never comes.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0)
    throw InputError(fmt::format("{}: cannot be read: {}, expected an OpenEXR file", path, strerror(errno)));
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode)) {
    ::close(descriptor_);
    throw InputError(fmt::format("{}: found a {}, expected an OpenEXR file", path,
                                 S_ISDIR(info.st_mode) ? "folder" : "device or pipe"));
  }
  size_ = static_cast<std::uint64_t>(info.st_size);
  modified_ = modifiedAt(info);
}

ExrSource::ExrSource(const ExrSource& same) : IStream(same.fileName()), size_(same.size_), modified_(same.modified_) {
  descriptor_ = ::fcntl(same.descriptor_, F_DUPFD_CLOEXEC, 0);
  if (descriptor_ < 0) throw ResourceError(fmt::format("{}: cannot be opened again: {}", fileName(), strerror(errno)));
}

ExrSource::~ExrSource() {
  ::close(descriptor_);
}

bool ExrSource::changed() const {
  struct stat info {};
  return ::fstat(descriptor_, &info) != 0 || static_cast<std::uint64_t>(info.st_size) != size_ ||
         modifiedAt(info) != modified_;
}

bool ExrSource::readAt(std::uint64_t at, void* to, std::size_t count) const {
  if (at > size_ || count > size_ - at) return false;
  auto* bytes = static_cast<char*>(to);
  while (count > 0) {
    const ssize_t got = ::pread(descriptor_, bytes, count, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    at += static_cast<std::uint64_t>(got);
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

bool ExrSource::read(char to[], int count) {
  if (count < 0 || !readAt(position_, to, static_cast<std::size_t>(count)))
    throw IEX_NAMESPACE::InputExc("the file ends early");
  position_ += static_cast<std::uint64_t>(count);
  return position_ < size_;
}

ExrSink::ExrSink(const std::string& path, const std::string& target) : OStream(target.c_str()), target_(target) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (descriptor_ < 0) throw ResourceError(fmt::format("{}: cannot be written: {}", target_, strerror(errno)));
  buffer_.reserve(kBufferBytes);
}

ExrSink::~ExrSink() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ExrSink::flush() {
  std::size_t done = 0;
  while (!error_ && done < buffer_.size()) {
    const ssize_t wrote =
        ::pwrite(descriptor_, buffer_.data() + done, buffer_.size() - done, static_cast<off_t>(bufferStart_ + done));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote > 0)
      done += static_cast<std::size_t>(wrote);
    else
      error_ = wrote < 0 ? errno : ENOSPC;
  }
  bufferStart_ += buffer_.size();
  buffer_.clear();
}

void ExrSink::write(const char from[], int count) {
  std::size_t left = static_cast<std::size_t>(std::max(count, 0));
  while (left > 0) {
    const std::size_t fits = std::min(left, kBufferBytes - buffer_.size());
    buffer_.insert(buffer_.end(), from, from + fits);
    from += fits;
    left -= fits;
    if (buffer_.size() == kBufferBytes) flush();
  }
}

void ExrSink::seekp(std::uint64_t position) {
  if (position == tellp()) return;
  flush();
  bufferStart_ = position;
}

void ExrSink::finish() {
  flush();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && !error_) error_ = errno;
  if (error_) throw ResourceError(fmt::format("{}: cannot be written: {}", target_, strerror(error_)));
}

}  // namespace pellucid
