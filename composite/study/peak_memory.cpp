#include "composite/study/peak_memory.h"

#include <fstream>
#include <string>

namespace pellucid {

// proc(5): 5 resets the high water mark of the resident set.
bool forgetPeakMemory() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}

std::size_t peakMemory() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (std::size_t kilobytes = 0; word == "VmHWM:" && file >> kilobytes) return kilobytes * 1024;
  return 0;
}

}  // namespace pellucid
