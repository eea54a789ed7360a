// Error against cost: what each method pays to miss the truth, as a table; plot.h draws it.
#pragma once
#include <string>
#include <vector>

#include "composite/error.h"
#include "gbuffer/image.h"

namespace pellucid {

struct StudyRow {
  std::string method;
  std::string precision = "float";                          // tier of the sums
  std::string weight = {};                                  // of methods that weigh, as headers have it
  int samples = 1;                                          // a pixel, --aa
  ErrorStatistics error;                                    // against the sorted truth at the most samples
  double relativeSquare = 0;                                // mean of (picture - truth)^2 / (truth^2 + 0.01)
  double flip = 0;                                          // mean FLIP, [0,1]
  double seconds = 0;                                       // of compositing, without reading and writing
  std::vector<std::pair<std::string, double>> stages = {};  // the same by stage
  int bits = 0;                                             // of sums a pixel; 0 where lists are kept
  int passes = 0;                                           // of geometry
  bool front = false;                                       // on the Pareto front of rmse against seconds
};

// Relative MSE over R, G, B of pixels where both are finite.
double relativeSquareError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth);

// Marks the rows that no other beats in both seconds and rmse.
void markFront(std::vector<StudyRow>& rows);

std::vector<std::string> studyHead();
std::vector<std::string> studyCells(const StudyRow& row);
std::string rowName(const StudyRow& row);  // "weighted", "weighted exact x8"
std::vector<std::string> stageNames(const std::vector<StudyRow>& rows);
std::vector<std::string> stageCells(const StudyRow& row, const std::vector<std::string>& names);
std::string studyText(const std::vector<StudyRow>& rows);  // aligned columns
std::string studyCsv(const std::vector<StudyRow>& rows);
}  // namespace pellucid
