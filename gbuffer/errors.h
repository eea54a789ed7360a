// What can be wrong with an input or the machine, as exceptions that carry the documented exit code.
// what() is one sentence that names the file, the plane, what was found and what was expected. Our own mistakes are
// asserts or std::logic_error; plain absence is std::optional.
#pragma once
#include <stdexcept>
#include <string>

namespace pellucid {

class Error : public std::runtime_error {
 public:
  Error(int exitCode, const std::string& sentence) : std::runtime_error(sentence), exitCode_(exitCode) {}
  int exitCode() const { return exitCode_; }

 private:
  int exitCode_;
};

struct UsageError : Error {  // a flag that is unknown, malformed or cannot be honoured
  explicit UsageError(const std::string& sentence) : Error(2, sentence) {}
};
struct InputError : Error {  // missing, unreadable or damaged
  explicit InputError(const std::string& sentence) : Error(3, sentence) {}
};
struct MeaningError : Error {  // contradicts itself, or lacks what is needed (no depth, no camera)
  explicit MeaningError(const std::string& sentence) : Error(4, sentence) {}
};
struct ResourceError : Error {  // disk, memory or GL device ran out
  explicit ResourceError(const std::string& sentence) : Error(6, sentence) {}
};

}  // namespace pellucid
