// Error against cost: what each method pays to miss the truth, as a table, a plot and a page.
#pragma once
#include <string>
#include <vector>

#include "composite/error.h"
#include "gbuffer/image.h"

namespace pellucid {

struct StudyRow {
  std::string method;
  ErrorStatistics error;      // against the sorted truth
  double relativeSquare = 0;  // mean of (picture - truth)^2 / (truth^2 + 0.01)
  double seconds = 0;         // of compositing, without reading and writing
  int bits = 0;               // of sums a pixel; 0 where lists are kept
  int passes = 0;             // of geometry
  bool front = false;         // on the Pareto front of rmse against seconds
};

// Relative MSE over R, G, B of pixels where both are finite.
double relativeSquareError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth);

// Marks the rows that no other beats in both seconds and rmse.
void markFront(std::vector<StudyRow>& rows);

std::vector<std::string> studyHead();
std::vector<std::string> studyCells(const StudyRow& row);
std::string studyText(const std::vector<StudyRow>& rows);  // aligned columns
std::string studyCsv(const std::vector<StudyRow>& rows);
// rmse against seconds, both logarithmic, with the front as a line. Self-contained SVG.
std::string studySvg(const std::vector<StudyRow>& rows);

}  // namespace pellucid
