#include "composite/cli/study_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::cli {
namespace {

// One method along the shot.
struct Along {
  std::string name;
  std::size_t frames = 0;
  double rmse = 0.0, seconds = 0.0;  // sums
  double worst = -1.0, slowest = 0.0;
  int worstFrame = 0;
};

std::string nameOf(const nlohmann::json& row) {
  const int samples = row["samples"];
  return fmt::format("{} {}{}", row["method"].get<std::string>(), row["precision"].get<std::string>(),
                     samples == 1 ? "" : fmt::format(" x{}", samples));
}

Along& alongOf(std::vector<Along>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Along& each) { return each.name == name; });
  if (found != all.end()) return *found;
  all.push_back({name});
  return all.back();
}

}  // namespace

void printStudyTable(const std::vector<FrameRow>& rows) {
  std::vector<Along> all;
  for (const FrameRow& frame : rows) {
    if (!frame.outcome.summary.is_array()) continue;
    for (const nlohmann::json& row : frame.outcome.summary) {
      Along& method = alongOf(all, nameOf(row));
      const double rmse = row["rmse"], seconds = row["seconds"];
      ++method.frames;
      method.rmse += rmse;
      method.seconds += seconds;
      method.slowest = std::max(method.slowest, seconds);
      if (rmse > method.worst) method.worst = rmse, method.worstFrame = frame.number;
    }
  }
  fmt::print("{:<28} {:>6} {:>12} {:>12} {:>11} {:>10} {:>10}\n", "method", "frames", "mean rmse", "worst rmse",
             "worst frame", "mean s", "slowest s");
  for (const Along& method : all) {
    const auto frames = static_cast<double>(method.frames);
    fmt::print("{:<28} {:>6} {:>12.4g} {:>12.4g} {:>11} {:>10.3f} {:>10.3f}\n", method.name, method.frames,
               method.rmse / frames, method.worst, method.worstFrame, method.seconds / frames, method.slowest);
  }
}

}  // namespace pellucid::cli
