#include "engine_bridge/scene/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <mutex>

#include "engine_bridge/scene/json_view.h"
#include "gbuffer/errors.h"

namespace pellucid {

// Slots are never freed, so that a handler in any thread may walk the list at any time.
struct MappedFile::Slot {
  std::atomic<std::uintptr_t> begin{0}, end{0};  // empty: nobody's
  std::atomic<bool> taken{true}, broken{false};
  Slot* next = nullptr;
};

namespace {

std::atomic<MappedFile::Slot*> slots{nullptr};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

struct sigaction earlier {};

std::uintptr_t pageSize() {
  static const auto size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  return size;
}

// A page of ours that the file no longer has becomes one of zeros. Anything else goes to whoever came before us.
void onBusError(int, siginfo_t* information, void*) {
  const auto at = reinterpret_cast<std::uintptr_t>(information->si_addr);
  for (MappedFile::Slot* slot = slots.load(); slot; slot = slot->next) {
    if (at < slot->begin.load() || at >= slot->end.load()) continue;
    void* const page = reinterpret_cast<void*>(at / pageSize() * pageSize());
    if (::mmap(page, pageSize(), PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED) break;
    slot->broken = true;
    return;
  }
  ::sigaction(SIGBUS, &earlier, nullptr);  // and the read that failed is tried again
}

void handleBusErrors() {
  static std::once_flag once;
  std::call_once(once, [] {
    pageSize();
    struct sigaction action {};
    action.sa_sigaction = onBusError;
    action.sa_flags = SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGBUS, &action, &earlier);
  });
}

MappedFile::Slot* takeSlot(std::uintptr_t begin, std::uintptr_t end) {
  MappedFile::Slot* slot = slots.load();
  bool taken = false;
  while (slot && !slot->taken.compare_exchange_strong(taken, true)) {
    slot = slot->next;
    taken = false;
  }
  if (!slot) {
    slot = new MappedFile::Slot;
    slot->next = slots.load();
    while (!slots.compare_exchange_weak(slot->next, slot)) {
    }
  }
  slot->broken = false;
  slot->begin = begin;
  slot->end = end;
  return slot;
}

[[noreturn]] void refuseFile(const std::string& whose, const std::string& path, const std::string& what) {
  throw InputError(gltf::printable(fmt::format("{}: {} {}", whose, path, what)));
}

void giveBack(MappedFile::Slot* slot) {
  slot->end = 0;
  slot->begin = 0;
  slot->taken = false;
}

}  // namespace

void PageLedger::letAllGo() {
  for (const MappedFile* file : files_) file->letAnnouncedGo();
  held_ = 0;
}

OpenFile::OpenFile(const std::string& path, const std::string& whose)
    // Not blocking: opening a pipe would wait for its other end.
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)), path_(path) {
  if (descriptor_ < 0)
    refuseFile(whose, path_, errno == ENOENT || errno == ENOTDIR ? "does not exist" : "cannot be opened for reading");
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t OpenFile::size(const std::string& whose) const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) refuseFile(whose, path_, "cannot be opened for reading");
  if (!S_ISREG(status.st_mode)) refuseFile(whose, path_, "is not a regular file");
  return static_cast<std::size_t>(status.st_size);
}

std::vector<std::uint8_t> readWhole(const OpenFile& file, const std::string& whose) {
  std::vector<std::uint8_t> bytes(file.size(whose));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t some = ::read(file.descriptor(), bytes.data() + done, bytes.size() - done);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) refuseFile(whose, file.path(), fmt::format("ends after {} bytes; expected {}", done, bytes.size()));
    done += static_cast<std::size_t>(some);
  }
  return bytes;
}

MappedFile::MappedFile(const std::string& path, const std::string& whose, std::shared_ptr<PageLedger> ledger)
    : MappedFile(OpenFile(path, whose), whose, std::move(ledger)) {}

MappedFile::MappedFile(const OpenFile& file, const std::string& whose, std::shared_ptr<PageLedger> ledger)
    : path_(file.path()), whose_(whose), ledger_(std::move(ledger)) {
  const std::size_t size = file.size(whose);
  if (size == 0) return;
  handleBusErrors();
  void* const mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (mapped == MAP_FAILED) refuseFile(whose, path_, fmt::format("cannot be mapped: {}", strerror(errno)));
  bytes_ = {static_cast<const std::uint8_t*>(mapped), size};
  const auto begin = reinterpret_cast<std::uintptr_t>(mapped);
  slot_ = takeSlot(begin, begin + (size + pageSize() - 1) / pageSize() * pageSize());
  if (!ledger_) return;
  announced_.resize((size - 1) / PageLedger::kWindow + 1, false);
  ledger_->files_.push_back(this);
}

MappedFile::~MappedFile() {
  if (bytes_.empty()) return;
  if (ledger_) std::erase(ledger_->files_, this);
  giveBack(slot_);
  ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

void MappedFile::settle() const {
  if (ledger_ && ledger_->held_ > ledger_->limit_) ledger_->letAllGo();
}

void MappedFile::announce(Bytes part) const {
  if (!ledger_ || part.empty()) return;
  const auto from = static_cast<std::size_t>(part.data() - bytes_.data());
  const std::size_t last = (from + part.size() - 1) / PageLedger::kWindow;
  for (std::size_t window = from / PageLedger::kWindow; window <= last; ++window) {
    if (announced_[window]) continue;
    announced_[window] = true;
    ledger_->held_ += PageLedger::kWindow;
  }
}

void MappedFile::letAnnouncedGo() const {
  for (std::size_t window = 0; window < announced_.size(); ++window) {
    if (!announced_[window]) continue;
    announced_[window] = false;
    const std::size_t first = window * PageLedger::kWindow;
    letGo(bytes_.subspan(first, std::min(PageLedger::kWindow, bytes_.size() - first)));
  }
}

void MappedFile::letGo(Bytes part) const {
  if (part.empty() || bytes_.empty()) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(bytes_.data());
  const auto first = std::max(reinterpret_cast<std::uintptr_t>(part.data()), begin) / pageSize() * pageSize();
  const auto last = std::min(reinterpret_cast<std::uintptr_t>(part.data() + part.size()), begin + bytes_.size());
  if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

void MappedFile::requireWhole() const {
  if (slot_ && slot_->broken)
    throw InputError(gltf::printable(
        fmt::format("{}: {} could not be read to its end: found it cut short or damaged, expected {} bytes as when it "
                    "was opened",
                    whose_, path_, bytes_.size())));
}

}  // namespace pellucid
