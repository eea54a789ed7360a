// The study's plot: rmse against seconds, both logarithmic, with the Pareto front as a line.
#pragma once
#include <string>
#include <vector>

#include "composite/study/study.h"

namespace pellucid {

// Where the plot's parts lie, in pixels of its picture.
struct PlotLayout {
  static constexpr double left = 70, right = 660, top = 20, leastBottom = 400, labels = 710;
  static constexpr double textSize = 12, dot = 4;
};

struct PlotLine {
  enum Kind { grid, leader, front };  // a leader runs from a dot to its label
  double x0, y0, x1, y1;
  Kind kind;
};
struct PlotDot {
  double x, y;
  bool front;
};
struct PlotText {
  double x, y;  // of the baseline
  std::string text;
  int anchor;  // -1 begins at x, 0 has its middle there, 1 ends there
  bool upright = false;
};

// What is drawn, in pixels of a picture of this size: as high as its labels need it.
struct Plot {
  int width = 900, height = 450;
  double bottom = PlotLayout::leastBottom;  // of the axes
  std::vector<PlotLine> lines;
  std::vector<PlotDot> dots;
  std::vector<PlotText> texts;
};

Plot studyPlot(const std::vector<StudyRow>& rows);
std::string plotSvg(const Plot& plot);  // self-contained
using PlotPngWriter = bool(const std::string& path, const Plot& plot);
// Throws ResourceError when it cannot be written. Without a font on the machine labels are left out; then false.
bool writePlotPng(const std::string& path, const Plot& plot);

}  // namespace pellucid
