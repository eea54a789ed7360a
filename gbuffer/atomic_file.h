// A file that appears whole or not at all: written beside its target under a temporary name, then renamed.
#pragma once
#include <string>

namespace pellucid {

// The temporary file exists, empty, from construction on. A target that is a symbolic link keeps being one: what it
// points to is replaced. An existing target keeps its permissions.
class AtomicFile {
 public:
  // Throws ResourceError when the folder cannot be written, or the target is something other than a regular file.
  explicit AtomicFile(std::string target);
  ~AtomicFile();  // removes the temporary file unless commit() was called
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& target() const { return target_; }
  const std::string& temporary() const { return temporary_; }
  void commit();  // flush to disk, rename onto the target; throws ResourceError

  struct Slot;  // one entry of the list that the signal handler walks

 private:
  std::string target_, destination_, temporary_;
  Slot* slot_ = nullptr;
  bool committed_ = false;
};

// SIGINT and SIGTERM remove every temporary file in being, then end the process with 130 or 143 (unless they were
// ignored at the start, as under nohup). SIGXFSZ is ignored, so that a file size limit is an error like a full disk.
void cleanUpOnSignals();

}  // namespace pellucid
