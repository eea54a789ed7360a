// Boxes with arrows between them: what a run would do, from its inputs to its output.
#pragma once
#include <string>
#include <vector>

namespace pellucid {

struct FlowBox {
  std::string title;
  std::vector<std::string> lines;  // broken where they are long
};

// Sources stand beside one another and lead to the first step; each step leads to the next one below it.
std::string flowSvg(const std::vector<FlowBox>& sources, const std::vector<FlowBox>& steps);  // self-contained

}  // namespace pellucid
