#include "gbuffer/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "gbuffer/errors.h"
#include "gbuffer/writable.h"

namespace pellucid {

// Slots are never freed and their paths never move, so that a handler in any thread may read the list at any time.
struct AtomicFile::Slot {
  char path[PATH_MAX];
  std::atomic<bool> taken{true};    // by an AtomicFile
  std::atomic<bool> exists{false};  // path is whole and the file may be there
  Slot* next = nullptr;
};

namespace {

std::atomic<AtomicFile::Slot*> slots{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<AtomicFile::Slot*>::is_always_lock_free);

AtomicFile::Slot* takeSlot() {
  for (AtomicFile::Slot* slot = slots.load(); slot; slot = slot->next) {
    bool free = false;
    if (slot->taken.compare_exchange_strong(free, true)) return slot;
  }
  auto* slot = new AtomicFile::Slot;
  slot->next = slots.load();
  while (!slots.compare_exchange_weak(slot->next, slot)) {
  }
  return slot;
}

void giveBack(AtomicFile::Slot* slot) {
  slot->exists = false;
  slot->taken = false;
}

[[noreturn]] void removeAllAndEnd(int signal) {
  for (AtomicFile::Slot* slot = slots.load(); slot; slot = slot->next)
    if (slot->exists.load()) ::unlink(slot->path);
  ::_exit(128 + signal);
}

std::string folderOf(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string resolveLinks(const std::string& path) {
  struct stat link {};
  if (::lstat(path.c_str(), &link) != 0 || !S_ISLNK(link.st_mode)) return path;
  char* real = ::realpath(path.c_str(), nullptr);
  if (!real) return path;  // dangling: the link itself is replaced
  std::string resolved = real;
  std::free(real);
  return resolved;
}

std::string temporaryName(const std::string& destination) {
  static std::atomic<unsigned> counter{0};
  const auto slash = destination.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : destination.substr(0, slash + 1);
  // Short whatever the target's name, so that the longest possible name still has a temporary beside it. The clock
  // keeps apart processes of two containers with the same id.
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return fmt::format("{}.pellucid-{}-{}-{:x}.tmp", folder, ::getpid(), counter++, now.tv_nsec);
}

void syncPath(const std::string& path, const std::string& target, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  // Some file systems cannot sync (EINVAL); that loses nothing but the promise against a power cut.
  if (!synced && error != EINVAL)
    throw ResourceError(fmt::format("{}: cannot be written: {}", target, strerror(error)));
}

struct Existing {
  bool found = false;
  mode_t mode = 0;
};

// What stands at the target, whose links lead to `destination`. Throws ResourceError when it cannot be replaced.
Existing existingAt(const std::string& target, std::string& destination) {
  if (target.empty()) throw ResourceError("cannot write a file without a name, expected a path");
  destination = resolveLinks(target);
  struct stat existing {};
  if (::stat(destination.c_str(), &existing) != 0) return {};
  if (!S_ISREG(existing.st_mode))
    throw ResourceError(fmt::format("{}: cannot be written: found a {}, expected a file or nothing", target,
                                    S_ISDIR(existing.st_mode) ? "folder" : "device"));
  if (::access(destination.c_str(), W_OK) != 0)
    throw ResourceError(fmt::format("{}: cannot be written: {}", target, strerror(errno)));
  return {true, existing.st_mode};
}

}  // namespace

void expectWritable(const std::string& target) {
  std::string destination;
  existingAt(target, destination);
  const std::string folder = folderOf(destination);
  struct stat status {};
  int error = ::stat(folder.c_str(), &status) != 0 ? errno : S_ISDIR(status.st_mode) ? 0 : ENOTDIR;
  if (error == 0 && ::access(folder.c_str(), W_OK | X_OK) != 0) error = errno;
  if (error != 0)
    throw ResourceError(fmt::format("{}: cannot be written in folder {}: {}", target, folder, strerror(error)));
}

AtomicFile::AtomicFile(std::string target) : target_(std::move(target)) {
  const Existing existing = existingAt(target_, destination_);
  temporary_ = temporaryName(destination_);
  if (temporary_.size() >= PATH_MAX) throw ResourceError(fmt::format("{}: the path is too long", target_));
  slot_ = takeSlot();
  std::memcpy(slot_->path, temporary_.c_str(), temporary_.size() + 1);
  slot_->exists = true;
  const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const int error = errno;
    giveBack(slot_);
    throw ResourceError(
        fmt::format("{}: cannot be written in folder {}: {}", target_, folderOf(destination_), strerror(error)));
  }
  // Owner and permissions are a courtesy: a file system that cannot keep them still takes the picture.
  if (existing.found && ::fchmod(descriptor, existing.mode & 07777) != 0) errno = 0;
  ::close(descriptor);
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
  giveBack(slot_);
}

void AtomicFile::commit() {
  syncPath(temporary_, target_, O_RDONLY);
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0)
    throw ResourceError(fmt::format("{}: cannot be replaced: {}", target_, strerror(errno)));
  committed_ = true;
  slot_->exists = false;
  const int folder = ::open(folderOf(destination_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);  // the file is whole either way; this makes the rename survive a power cut
    ::close(folder);
  }
}

void cleanUpOnSignals() {
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = removeAllAndEnd;
    sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace pellucid
