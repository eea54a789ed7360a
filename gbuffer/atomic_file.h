// A file that appears whole or not at all: written beside its target under a temporary name, then renamed.
#pragma once
#include <string>

namespace pellucid {

class AtomicFile {
 public:
  explicit AtomicFile(std::string target);  // throws ResourceError when the folder cannot be written
  ~AtomicFile();                            // removes the temporary file unless commit() was called
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  void commit();  // flush to disk, rename onto the target; throws ResourceError

 private:
  std::string target_, temporary_;
  bool committed_ = false;
};

// SIGINT and SIGTERM remove every temporary file in being, then end the process with 130 or 143.
void cleanUpOnSignals();

}  // namespace pellucid
