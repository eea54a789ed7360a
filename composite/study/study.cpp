#include "composite/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

// Errors below this are drawn at it: the truth itself has none.
constexpr double kLeastError = 1e-7;

double axis(double value, double low, double high, double from, double to) {
  return from + (std::log10(value) - low) / (high - low) * (to - from);
}

}  // namespace

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

void markFront(std::vector<StudyRow>& rows) {
  for (StudyRow& row : rows)
    row.front = std::none_of(rows.begin(), rows.end(), [&](const StudyRow& other) {
      return other.seconds <= row.seconds && other.error.rmse <= row.error.rmse &&
             (other.seconds < row.seconds || other.error.rmse < row.error.rmse);
    });
}

std::vector<std::string> studyHead() {
  return {"method", "mean", "rmse", "p99", "max", "relMSE", "seconds", "bits/px", "passes", "front"};
}

std::vector<std::string> studyCells(const StudyRow& row) {
  return {row.method,
          fmt::format("{:.3g}", row.error.mean),
          fmt::format("{:.3g}", row.error.rmse),
          fmt::format("{:.3g}", row.error.p99),
          fmt::format("{:.3g}", row.error.maximum),
          fmt::format("{:.3g}", row.relativeSquare),
          fmt::format("{:.3f}", row.seconds),
          row.bits ? std::to_string(row.bits) : "lists",
          std::to_string(row.passes),
          row.front ? "*" : ""};
}

std::string studyText(const std::vector<StudyRow>& rows) {
  std::string text;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string out = fmt::format("{:<18}", cells[0]);
    for (std::size_t i = 1; i < cells.size(); ++i) out += fmt::format("{:>10}", cells[i]);
    text += out + "\n";
  };
  line(studyHead());
  for (const StudyRow& row : rows) line(studyCells(row));
  return text;
}

std::string studyCsv(const std::vector<StudyRow>& rows) {
  std::string text = "method,mean,rmse,p99,max,relative_mse,seconds,bits_per_pixel,passes,pareto_front\n";
  for (const StudyRow& row : rows)
    text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6f},{},{},{}\n", row.method, row.error.mean,
                        row.error.rmse, row.error.p99, row.error.maximum, row.relativeSquare, row.seconds, row.bits,
                        row.passes, row.front ? 1 : 0);
  return text;
}

std::string studySvg(const std::vector<StudyRow>& rows) {
  constexpr double kLeft = 70, kRight = 700, kTop = 20, kBottom = 400;
  double slow = 1e-3, fast = 1e9, worst = 1e-4, least = 1e9;
  for (const StudyRow& row : rows) {
    slow = std::max(slow, row.seconds);
    fast = std::min(fast, std::max(row.seconds, 1e-6));
    worst = std::max(worst, row.error.rmse);
    least = std::min(least, std::max(row.error.rmse, kLeastError));
  }
  // Whole decades, one at least.
  const double x0 = std::floor(std::log10(fast)), x1 = std::max(std::ceil(std::log10(slow)), x0 + 1);
  const double y0 = std::floor(std::log10(least)), y1 = std::max(std::ceil(std::log10(worst)), y0 + 1);
  const auto px = [&](double s) { return axis(std::max(s, 1e-6), x0, x1, kLeft, kRight); };
  const auto py = [&](double e) { return axis(std::max(e, kLeastError), y0, y1, kBottom, kTop); };
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 450\" width=\"900\" height=\"450\" "
      "font-family=\"sans-serif\" font-size=\"12\"><rect width=\"900\" height=\"450\" fill=\"white\"/>\n";
  for (double d = x0; d <= x1; ++d) {
    const double x = px(std::pow(10, d));
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" "
        "y=\"{3}\" text-anchor=\"middle\">1e{4:.0f}</text>\n",
        x, kTop, kBottom, kBottom + 16, d);
  }
  for (double d = y0; d <= y1; ++d) {
    const double y = py(std::pow(10, d));
    svg += fmt::format(
        "<line x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\" stroke=\"#ddd\"/><text x=\"{3}\" "
        "y=\"{4:.1f}\" text-anchor=\"end\">1e{5:.0f}</text>\n",
        y, kLeft, kRight, kLeft - 6, y + 4, d);
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">seconds</text><text x=\"16\" y=\"{}\" "
      "text-anchor=\"middle\" transform=\"rotate(-90 16 {})\">RMSE against sorted over</text>\n",
      0.5 * (kLeft + kRight), kBottom + 36, 0.5 * (kTop + kBottom), 0.5 * (kTop + kBottom));
  std::vector<const StudyRow*> front;
  for (const StudyRow& row : rows)
    if (row.front) front.push_back(&row);
  std::sort(front.begin(), front.end(), [](const StudyRow* a, const StudyRow* b) { return a->seconds < b->seconds; });
  svg += "<polyline fill=\"none\" stroke=\"#c33\" points=\"";
  for (const StudyRow* row : front) svg += fmt::format("{:.1f},{:.1f} ", px(row->seconds), py(row->error.rmse));
  svg += "\"/>\n";
  for (const StudyRow& row : rows)
    svg += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"4\" fill=\"{2}\"/><text x=\"{3:.1f}\" "
        "y=\"{4:.1f}\">{5}</text>\n",
        px(row.seconds), py(row.error.rmse), row.front ? "#c33" : "#456", px(row.seconds) + 7, py(row.error.rmse) + 4,
        row.method);
  return svg + "</svg>\n";
}

}  // namespace pellucid
