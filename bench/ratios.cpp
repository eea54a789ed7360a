#include "bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace pellucid::bench {
namespace {

const Ratio* find(const std::vector<Ratio>& ratios, const std::string& name) {
  const auto found = std::find_if(ratios.begin(), ratios.end(), [&](const Ratio& one) { return one.name == name; });
  return found == ratios.end() ? nullptr : &*found;
}

}  // namespace

double exponentOf(const std::vector<double>& sizes, const std::vector<double>& costs) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, n = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!(sizes[i] > 0.0) || !(costs[i] > 0.0)) continue;
    const double u = std::log(sizes[i]), v = std::log(costs[i]);
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
    n += 1.0;
  }
  const double across = n * xx - x * x;
  return across > 0.0 ? (n * xy - x * y) / across : 0.0;
}

std::vector<Ratio> readRatios(const std::string& path) {
  std::ifstream file(path);
  std::vector<Ratio> ratios;
  if (!file) return ratios;
  const nlohmann::json text = nlohmann::json::parse(file, nullptr, false);
  if (!text.is_object()) throw std::runtime_error(path + ": found no JSON object, expected ratios by name");
  for (const auto& [name, value] : text.items()) {
    if (!value.is_number()) throw std::runtime_error(path + ": " + name + ": found no number, expected a ratio");
    Ratio ratio;
    ratio.name = name;
    ratio.value = value.get<double>();
    ratios.push_back(ratio);
  }
  return ratios;
}

void writeRatios(const std::string& path, const std::vector<Ratio>& ratios) {
  nlohmann::ordered_json text = nlohmann::ordered_json::object();
  for (const Ratio& ratio : ratios) text[ratio.name] = std::round(ratio.value * 1000.0) / 1000.0;
  std::ofstream file(path);
  file << text.dump(2) << "\n";
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

std::vector<std::string> worse(const std::vector<Ratio>& now, const std::vector<Ratio>& before, double part) {
  std::vector<std::string> sentences;
  for (const Ratio& ratio : now) {
    const Ratio* old = find(before, ratio.name);
    if (old && ratio.value > old->value * (1.0 + part))
      sentences.push_back(fmt::format("{}: found {:.2f}, expected {:.2f} at most, 15% more than {:.2f}", ratio.name,
                                      ratio.value, old->value * (1.0 + part), old->value));
  }
  return sentences;
}

std::string pageOf(const std::vector<Ratio>& now, const std::vector<Ratio>& before,
                   const std::vector<Scaling>& scalings, const std::string& machine) {
  std::string page =
      "# What things cost\n\nWritten by `./dev bench --table`; nothing here is typed by hand. " + machine +
      "\n\nCosts are processor time of whole processes, all threads, medians of runs in turn, unless the "
      "figures say\notherwise. The last column is that of `ratios.json`, the last release.\n\n"
      "| what | against | ratio | spread | figures | aim | last release |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Ratio& ratio : now) {
    const Ratio* old = find(before, ratio.name);
    page += fmt::format("| {} | {} | {:.2f} | {:.0f}% | {} | {} | {} |\n", ratio.name, ratio.against, ratio.value,
                        100.0 * ratio.spread, ratio.figures, ratio.aim > 0.0 ? fmt::format("{:g}", ratio.aim) : "",
                        old ? fmt::format("{:.2f}", old->value) : "");
  }
  page +=
      "\n## How costs grow\n\nProcessor seconds of `composite` less those of a picture without layers in view, and the "
      "exponent of their fit.\n\n| of | sizes | seconds | exponent |\n| --- | --- | --- | --- |\n";
  for (const Scaling& scaling : scalings) {
    std::string sizes, costs;
    for (std::size_t i = 0; i < scaling.sizes.size(); ++i) {
      sizes += fmt::format("{}{:g}", i ? ", " : "", scaling.sizes[i]);
      costs += fmt::format("{}{:.2f}", i ? ", " : "", scaling.costs[i]);
    }
    page += fmt::format("| {} | {} | {} | {:.2f} |\n", scaling.of, sizes, costs, scaling.exponent);
  }
  return page;
}

}  // namespace pellucid::bench
