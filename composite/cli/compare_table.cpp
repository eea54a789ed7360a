#include "composite/cli/compare_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid::cli {
namespace {

// The frame with the largest value under a key, over all layers.
struct Worst {
  double value = 0.0;
  int frame = 0;
  void see(int number, double candidate) {
    if (candidate > value) value = candidate, frame = number;
  }
  std::string text() const { return value > 0.0 ? fmt::format("{:.6g} in frame {}", value, frame) : "0"; }
};

std::string cell(const nlohmann::json& layer, const char* key) {
  return layer.contains(key) ? fmt::format("{:.6g}", layer[key].get<double>()) : "-";
}

}  // namespace

nlohmann::json summaryOf(const CompareReport& report, const std::vector<TemporalLayer>& flicker) {
  nlohmann::json layers = nlohmann::json::array();
  for (const LayerReport& layer : report.layers) {
    const double largest = layer.worst ? layer.worst->difference : 0.0;
    nlohmann::json row{{"layer", layer.name}, {"rms", layer.rms}};
    if (std::isfinite(largest)) row["largest"] = largest;  // JSON has no infinity
    const auto found = std::find_if(flicker.begin(), flicker.end(),
                                    [&](const TemporalLayer& each) { return each.name == layer.name; });
    if (found != flicker.end()) {
      row["temporalRms"] = found->rms;
      row["temporalLargest"] = found->largest;
      row["temporalChanged"] = found->changed;
      row["values"] = found->values;
    }
    layers.push_back(std::move(row));
  }
  return layers;
}

void printCompareTable(const std::vector<FrameRow>& rows) {
  Worst spatial, temporal;
  std::size_t changed = 0, values = 0;
  fmt::print("{:<7} {:<24} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "frame", "layer", "rms", "largest", "temporal rms",
             "largest", "changed");
  for (const FrameRow& row : rows) {
    if (!row.outcome.summary.is_array()) continue;
    for (const nlohmann::json& layer : row.outcome.summary) {
      const auto name = layer["layer"].get<std::string>();
      fmt::print("{:<7} {:<24} {:>12} {:>12} {:>12} {:>12} {:>10}\n", row.number, name.empty() ? "(no name)" : name,
                 cell(layer, "rms"), cell(layer, "largest"), cell(layer, "temporalRms"), cell(layer, "temporalLargest"),
                 cell(layer, "temporalChanged"));
      spatial.see(row.number, layer["rms"].get<double>());
      temporal.see(row.number, layer.value("temporalRms", 0.0));
      changed += layer.value("temporalChanged", std::size_t{0});
      values += layer.value("values", std::size_t{0});
    }
  }
  fmt::print("spatial error: rms at most {}\ntemporal error: rms at most {}; {} of {} values change otherwise\n",
             spatial.text(), temporal.text(), changed, values);
}

}  // namespace pellucid::cli
