#include "composite/look/flow_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <sstream>

#include "composite/compare/page.h"

namespace pellucid {
namespace {

constexpr double kWidth = 900, kGap = 30, kPad = 10, kLine = 16;
constexpr double kLetter = 6.6;  // mean width of one at this size

std::vector<std::string> broken(const std::string& text, double width) {
  const auto most = static_cast<std::size_t>((width - 2 * kPad) / kLetter);
  std::vector<std::string> lines{""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > most) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

struct Drawn {
  std::string svg;
  double height;
};

Drawn boxSvg(const FlowBox& box, double x, double y, double width) {
  std::vector<std::string> lines;
  for (const std::string& line : box.lines)
    for (const std::string& piece : broken(line, width)) lines.push_back(piece);
  const double height = 2 * kPad + kLine * static_cast<double>(lines.size() + 1);
  std::string svg = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"6\" fill=\"#eef3fa\" "
      "stroke=\"#4677b0\"/>"
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>",
      x, y, width, height, x + kPad, y + kPad + 12, escapedHtml(box.title));
  for (std::size_t i = 0; i < lines.size(); ++i)
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x + kPad,
                       y + kPad + 12 + kLine * static_cast<double>(i + 1), escapedHtml(lines[i]));
  return {svg, height};
}

std::string arrowSvg(double fromX, double fromY, double toX, double toY) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#222\" marker-end=\"url(#tip)\"/>", fromX,
                     fromY, toX, toY - 2);
}

}  // namespace

std::string flowSvg(const std::vector<FlowBox>& sources, const std::vector<FlowBox>& steps) {
  const auto count = static_cast<double>(std::max<std::size_t>(sources.size(), 1));
  const double each = (kWidth - kGap * (count - 1)) / count, middle = kWidth / 2;
  std::string svg;
  double y = 1, bottom = y;
  std::vector<glm::dvec2> ends;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const double x = static_cast<double>(i) * (each + kGap);
    const Drawn box = boxSvg(sources[i], x, y, each);
    svg += box.svg;
    ends.emplace_back(x + each / 2, y + box.height);
    bottom = std::max(bottom, y + box.height);
  }
  for (const FlowBox& step : steps) {
    y = bottom + kGap;
    for (const glm::dvec2& end : ends) svg += arrowSvg(end.x, end.y, middle + (end.x - middle) / 4, y);
    const Drawn box = boxSvg(step, kWidth / 6, y, kWidth * 2 / 3);
    svg += box.svg;
    bottom = y + box.height;
    ends = {{middle, bottom}};
  }
  return fmt::format(
             "<svg class=\"flow\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" "
             "viewBox=\"-1 0 {2} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\"><defs><marker id=\"tip\" "
             "viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\">"
             "<path d=\"M0 0L8 4L0 8z\"/></marker></defs>",
             kWidth, bottom + 2, kWidth + 2) +
         svg + "</svg>\n";
}

}  // namespace pellucid
