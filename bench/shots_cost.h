// What whole runs of the program cost, beside copies of their pictures and beside themselves.
#pragma once
#include <string>
#include <vector>

#include "bench/processes.h"
#include "bench/ratios.h"

namespace pellucid::bench {

struct Place {
  std::string program, generator;  // pellucid, pellucid_samples
  std::string folder;              // of what is written
  int runs = 5;
};

// `composite` over the samples, against type-preserving copies by oiiotool: processor time and memory.
std::vector<Ratio> shotRatios(const Place& place);
// Flattening deep files, against oiiotool.
std::vector<Ratio> deepRatios(const Place& place, const std::string& deepFile);
// Cost against covered area, layers, passes, resolution and lights.
std::vector<Scaling> scalingsOf(const Place& place);

}  // namespace pellucid::bench
