#include "composite/study/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "composite/compare/page.h"
#include "gbuffer/loaded_part.h"

namespace pellucid {
namespace {

constexpr double kLeastSeconds = 1e-6;

double axis(double value, double low, double high, double from, double to) {
  return from + (std::log10(value) - low) / (high - low) * (to - from);
}

// Labels in a column beside the plot, as near to the height of their dots as others leave room for, with lines to them.
void label(const std::vector<StudyRow>& rows, Plot& plot) {
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return plot.dots[a].y < plot.dots[b].y; });
  std::vector<double> y;
  for (const std::size_t i : order)
    y.push_back(std::max(plot.dots[i].y, y.empty() ? 0.0 : y.back() + PlotLayout::textSize));
  double lowest = plot.bottom;
  for (std::size_t k = y.size(); k-- > 0; lowest = y[k] - PlotLayout::textSize) y[k] = std::min(y[k], lowest);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const PlotDot& dot = plot.dots[order[k]];
    plot.lines.push_back({dot.x, dot.y, PlotLayout::labels - 4, y[k], PlotLine::leader});
    plot.texts.push_back({PlotLayout::labels, y[k] + 4, rowName(rows[order[k]]), -1});
  }
}

}  // namespace

Plot studyPlot(const std::vector<StudyRow>& rows) {
  double slow = 1e-3, fast = 1e9, worst = 1e-4, least = 1e9;
  bool exact = false;
  for (const StudyRow& row : rows) {
    slow = std::max(slow, row.seconds);
    fast = std::min(fast, std::max(row.seconds, kLeastSeconds));
    worst = std::max(worst, row.error.rmse);
    if (row.error.rmse > 0.0)
      least = std::min(least, row.error.rmse);
    else
      exact = true;
  }
  least = std::min(least, worst);
  // Whole decades, one at least; below them the errors of 0.
  const double x0 = std::floor(std::log10(fast)), x1 = std::max(std::ceil(std::log10(slow)), x0 + 1);
  const double y1 = std::ceil(std::log10(worst)),
               y0 = std::min(std::floor(std::log10(least)), y1 - 1) - (exact ? 1 : 0);
  const double lowest = std::pow(10, y0);
  Plot plot;
  plot.bottom = std::max(plot.bottom, PlotLayout::textSize * static_cast<double>(rows.size() + 1));
  plot.height += static_cast<int>(plot.bottom - PlotLayout::leastBottom);
  const auto px = [&](double s) {
    return axis(std::max(s, kLeastSeconds), x0, x1, PlotLayout::left, PlotLayout::right);
  };
  const auto py = [&](double e) { return axis(std::max(e, lowest), y0, y1, plot.bottom, PlotLayout::top); };
  for (double d = x0; d <= x1; ++d) {
    plot.lines.push_back({px(std::pow(10, d)), PlotLayout::top, px(std::pow(10, d)), plot.bottom, PlotLine::grid});
    plot.texts.push_back({px(std::pow(10, d)), plot.bottom + 16, fmt::format("1e{:.0f}", d), 0});
  }
  for (double d = y0; d <= y1; ++d) {
    plot.lines.push_back(
        {PlotLayout::left, py(std::pow(10, d)), PlotLayout::right, py(std::pow(10, d)), PlotLine::grid});
    plot.texts.push_back(
        {PlotLayout::left - 6, py(std::pow(10, d)) + 4, exact && d == y0 ? "0" : fmt::format("1e{:.0f}", d), 1});
  }
  plot.texts.push_back({0.5 * (PlotLayout::left + PlotLayout::right), plot.bottom + 36, "seconds", 0});
  const PlotText upright{16, 0.5 * (PlotLayout::top + plot.bottom), "RMSE against sorted over", 0, true};
  plot.texts.push_back(upright);
  std::vector<const StudyRow*> front;
  for (const StudyRow& row : rows)
    if (row.front) front.push_back(&row);
  std::sort(front.begin(), front.end(), [](const StudyRow* a, const StudyRow* b) { return a->seconds < b->seconds; });
  for (std::size_t i = 0; i + 1 < front.size(); ++i)
    plot.lines.push_back({px(front[i]->seconds), py(front[i]->error.rmse), px(front[i + 1]->seconds),
                          py(front[i + 1]->error.rmse), PlotLine::front});
  for (const StudyRow& row : rows) plot.dots.push_back({px(row.seconds), py(row.error.rmse), row.front});
  label(rows, plot);
  return plot;
}

std::string plotSvg(const Plot& plot) {
  static constexpr const char* kLineColours[] = {"#ddd", "#bbc", "#c33"};
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"{2}\"><rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      plot.width, plot.height, PlotLayout::textSize);
  for (const PlotLine& line : plot.lines)
    svg += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", line.x0,
                       line.y0, line.x1, line.y1, kLineColours[line.kind]);
  for (const PlotDot& dot : plot.dots)
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", dot.x, dot.y, PlotLayout::dot,
                       dot.front ? "#c33" : "#456");
  for (const PlotText& text : plot.texts)
    svg += fmt::format("<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"{2}\"{3}>{4}</text>\n", text.x, text.y,
                       text.anchor < 0   ? "start"
                       : text.anchor > 0 ? "end"
                                         : "middle",
                       text.upright ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", text.x, text.y) : "",
                       escapedHtml(text.text));
  return svg + "</svg>\n";
}

bool writePlotPng(const std::string& path, const Plot& plot) {
  return partFunction<PlotPngWriter*()>("pellucid_plots.so", "pellucidPlotPngWriter")()(path, plot);
}

}  // namespace pellucid
