#include "composite/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {

double relativeSquareError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double t = static_cast<double>(truth[i][c]), d = static_cast<double>(picture[i][c]) - t;
      if (!std::isfinite(d)) continue;
      sum += d * d / (t * t + 0.01);
      ++count;
    }
  return count > 0 ? sum / count : 0.0;
}

bool clearlyFaster(const StudyRow& a, const StudyRow& b) {
  return a.seconds * (1.0 + a.spread) < b.seconds * (1.0 - b.spread);
}

void markFront(std::vector<StudyRow>& rows) {
  for (StudyRow& row : rows)
    row.front = std::none_of(rows.begin(), rows.end(), [&](const StudyRow& other) {
      if (other.error.rmse < row.error.rmse) return !clearlyFaster(row, other);
      return other.error.rmse == row.error.rmse && clearlyFaster(other, row);
    });
}

std::vector<std::string> studyHead() {
  return {"method", "precision", "samples", "mean",  "rmse", "p99",     "max",    "relMSE",
          "FLIP",   "seconds",   "spread",  "first", "MiB",  "bits/px", "passes", "front"};
}

std::vector<std::string> studyCells(const StudyRow& row) {
  return {row.method,
          row.precision,
          std::to_string(row.samples),
          fmt::format("{:.3g}", row.error.mean),
          fmt::format("{:.3g}", row.error.rmse),
          fmt::format("{:.3g}", row.error.p99),
          fmt::format("{:.3g}", row.error.maximum),
          fmt::format("{:.3g}", row.relativeSquare),
          fmt::format("{:.3g}", row.flip),
          fmt::format("{:.3f}", row.seconds),
          fmt::format("{:.1f}%", 100.0 * row.spread),
          fmt::format("{:.3f}", row.firstSeconds),
          row.peakBytes ? std::to_string(row.peakBytes >> 20) : "-",
          row.bits ? std::to_string(row.bits) : "lists",
          std::to_string(row.passes),
          row.front ? "*" : ""};
}

std::vector<std::string> stageNames(const std::vector<StudyRow>& rows) {
  std::vector<std::string> names;
  for (const StudyRow& row : rows)
    for (const auto& [name, seconds] : row.stages)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::vector<std::string> stageCells(const StudyRow& row, const std::vector<std::string>& names) {
  std::vector<std::string> cells{rowName(row)};
  for (const std::string& wanted : names) {
    std::string cell = "-";
    for (const auto& [name, seconds] : row.stages)
      if (name == wanted) cell = fmt::format("{:.3f}", seconds);
    cells.push_back(cell);
  }
  return cells;
}

std::string rowName(const StudyRow& row) {
  std::string name = row.method;
  if (row.precision == "exact" || row.precision == "published") name += " " + row.precision;
  if (row.samples != 1) name += fmt::format(" x{}", row.samples);
  return name;
}

std::string studyText(const std::vector<StudyRow>& rows) {
  std::string text;
  const auto line = [&](const std::vector<std::string>& cells, std::size_t width) {
    std::string out = fmt::format("{:<18}", cells[0]);
    for (std::size_t i = 1; i < cells.size(); ++i) out += fmt::format(" {:>{}}", cells[i], width);
    text += out + "\n";
  };
  constexpr std::size_t kWidth = 9, kStageWidth = 17;
  line(studyHead(), kWidth);
  for (const StudyRow& row : rows) line(studyCells(row), kWidth);
  const std::vector<std::string> stages = stageNames(rows);
  std::vector<std::string> head{"seconds of"};
  head.insert(head.end(), stages.begin(), stages.end());
  text += "\n";
  line(head, kStageWidth);
  for (const StudyRow& row : rows) line(stageCells(row, stages), kStageWidth);
  return text;
}

std::string studyCsv(const std::vector<StudyRow>& rows) {
  std::string text =
      "method,precision,samples,mean,rmse,p99,max,relative_mse,flip,seconds,spread,first_seconds,peak_bytes,bits_per_"
      "pixel,passes,pareto_front";
  const std::vector<std::string> stages = stageNames(rows);
  for (const std::string& stage : stages) text += ",seconds: " + stage;
  text += "\n";
  for (const StudyRow& row : rows) {
    text += fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6f},{:.4f},{:.6f},{},{},{},{}",
                        row.method, row.precision, row.samples, row.error.mean, row.error.rmse, row.error.p99,
                        row.error.maximum, row.relativeSquare, row.flip, row.seconds, row.spread, row.firstSeconds,
                        row.peakBytes, row.bits, row.passes, row.front ? 1 : 0);
    for (const std::string& wanted : stages) {
      text += ",";
      for (const auto& [name, seconds] : row.stages)
        if (name == wanted) text += fmt::format("{:.6f}", seconds);
    }
    text += "\n";
  }
  return text;
}

}  // namespace pellucid
