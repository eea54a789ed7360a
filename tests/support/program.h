// Runs the program as a user does, and says how it ended.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace pellucid::test {

struct Ended {
  int code = -1;  // exit code; 128 + signal when killed
  std::string out, err;
  double seconds = 0;         // wall clock
  double cpuSeconds = 0;      // of all its threads
  std::size_t peakBytes = 0;  // most that was resident, libraries included
};

struct RunOptions {
  std::string program = "pellucid";       // in build/bin
  std::string folder;                     // working directory; "" keeps ours
  std::vector<std::string> environment;   // "NAME=value", added
  long maxFileBytes = -1;                 // RLIMIT_FSIZE with SIGXFSZ ignored: a disk that fills up
  int interruptAfterMs = -1, signal = 0;  // sends `signal` after so long
};

// `build/bin/PROGRAM ARGS...`
Ended runProgram(const std::vector<std::string>& arguments, const RunOptions& options = {});

std::string freshFolder(const std::string& name);  // empty, below the build folder, one per test
std::string slurp(const std::string& path);
std::vector<std::string> filesIn(const std::string& folder);
std::string assets();  // ../shared/assets, or "" when absent

}  // namespace pellucid::test
