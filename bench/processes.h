// Whole processes and what they cost: processor time, which says the same on a machine that others use, and memory.
#pragma once
#include <string>
#include <vector>

namespace pellucid::bench {

using Command = std::vector<std::string>;

struct Cost {
  double cpuSeconds = 0.0;  // user and system, all threads
  double megabytes = 0.0;   // most that was resident, 2^20 bytes
};

// Runs a program to its end, its output thrown away. Throws std::runtime_error when it cannot be started or fails.
Cost costOf(const Command& command);

struct Measured {
  Cost median;
  double spread = 0.0;  // half of what lies between the least and the most processor time, as a part of the median
};

// Each of the commands `runs` times, in turn, so that what changes in the machine meets all of them.
std::vector<Measured> inTurn(const std::vector<Command>& commands, int runs);

}  // namespace pellucid::bench
