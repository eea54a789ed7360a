#include "composite/cli/explain_page.h"

#include <algorithm>

#include "composite/compare/page.h"
#include "composite/look/flow_diagram.h"

namespace pellucid::cli {
namespace {

// Which lines stand together in a box, in the order of a run. Lines that no row names follow in the last box.
struct Step {
  const char* title;
  std::vector<std::string> words;
};

std::vector<std::string> linesOf(const std::vector<std::string>& described, const std::vector<std::string>& words) {
  std::vector<std::string> lines;
  for (const std::string& word : words)
    for (const std::string& line : described)
      if (line.rfind(word + " ", 0) == 0) lines.push_back(line);
  return lines;
}

}  // namespace

void writeExplainPage(const std::string& page, const std::vector<std::string>& described, const std::string& opaque,
                      const std::vector<std::string>& inputs, const std::string& output) {
  const std::vector<Step> rows{{"Opaque picture", {"picture", "edges"}},
                               {"Transparent things", {"layers"}},
                               {"Passes", {"passes", "filter"}},
                               {"Method", {"method", "painted by", "tier", "weight", "memory"}},
                               {"Notes", {"note"}}};
  std::vector<FlowBox> boxes;
  std::vector<std::string> told;
  for (const Step& row : rows) {
    boxes.push_back({row.title, linesOf(described, row.words)});
    told.insert(told.end(), boxes.back().lines.begin(), boxes.back().lines.end());
  }
  for (const std::string& line : described)
    if (std::find(told.begin(), told.end(), line) == told.end()) boxes[3].lines.push_back(line);
  boxes[0].lines.insert(boxes[0].lines.begin(), opaque);
  boxes[1].lines.insert(boxes[1].lines.begin(), inputs.begin(), inputs.end());
  Page explained;
  explained.title = "What would be done for " + output;
  explained.lines = boxes[4].lines;
  explained.plotSvg = flowSvg({boxes[0], boxes[1]}, {boxes[2], boxes[3], {"Picture", {output}}});
  writePage(page, explained);
}

}  // namespace pellucid::cli
