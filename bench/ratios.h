// One number for each thing that is measured: what ours costs as a multiple of what it is held against. Less is better.
#pragma once
#include <string>
#include <vector>

namespace pellucid::bench {

struct Ratio {
  std::string name;     // what is measured; the key in ratios.json
  std::string against;  // what it is held against
  double value = 0.0;
  double spread = 0.0;  // as a part of the value
  double aim = 0.0;     // 0 for none
  std::string figures;  // the two numbers, with their unit
};

// A power that costs follow: log cost against log size, by least squares.
struct Scaling {
  std::string of;                    // "covered area, pixels"
  std::vector<double> sizes, costs;  // costs in CPU seconds, what size 0 would cost taken away
  double exponent = 0.0;
};
double exponentOf(const std::vector<double>& sizes, const std::vector<double>& costs);

// Ratios of an earlier run; those that it lacks are not compared.
//   path  ratios.json; an absent file holds none
std::vector<Ratio> readRatios(const std::string& path);
void writeRatios(const std::string& path, const std::vector<Ratio>& ratios);

// Of those that are worse than the earlier ones by more than `part`, a sentence each.
std::vector<std::string> worse(const std::vector<Ratio>& now, const std::vector<Ratio>& before, double part);

// The whole page, Markdown.
std::string pageOf(const std::vector<Ratio>& now, const std::vector<Ratio>& before,
                   const std::vector<Scaling>& scalings, const std::string& machine);

}  // namespace pellucid::bench
