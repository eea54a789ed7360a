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

// `composite` over a sample, against a type-preserving copy by oiiotool: processor time and memory.
//   aim  of the default flags' time
std::vector<Ratio> sampleRatios(const Place& place, const std::string& name, double aim);
// The same of a large picture of which little is covered.
std::vector<Ratio> largeRatios(const Place& place);
// What edges of the picture and its renderer's filter cost.
std::vector<Ratio> edgeRatios(const Place& place);
// Light that reaches layers by rays, against the same picture without shadows.
std::vector<Ratio> shadowRatios(const Place& place);
// Flattening deep files, against oiiotool.
std::vector<Ratio> deepRatios(const Place& place, const std::string& deepFile);
// Cost against covered area, layers, passes, resolution and lights.
std::vector<Scaling> scalingsOf(const Place& place);

}  // namespace pellucid::bench
