// Error against cost: what each method pays to miss the truth, as a table; plot.h draws it.
#pragma once
#include <string>
#include <vector>

#include "composite/error.h"
#include "gbuffer/image.h"

namespace pellucid {

struct StudyRow {
  std::string method;
  std::string precision = "float";  // tier of the sums
  std::string weight = {};          // of methods that weigh, as headers have it
  int samples = 1;                  // a pixel, --aa
  ErrorStatistics error;            // against the sorted truth at the most samples
  double relativeSquare = 0;        // mean of (picture - truth)^2 / (truth^2 + 0.01)
  double flip = 0;                  // mean FLIP, [0,1]
  double seconds = 0;               // of compositing, without reading and writing: the median of the repeats
  double spread = 0;                // half of what lies between the least and the most of them, as a part of the median
  double firstSeconds = 0;    // what the first run, which no repeat is, took more: shaders compile, memory is claimed
  std::size_t peakBytes = 0;  // resident while the repeats ran; 0 where the system does not say
  std::vector<std::pair<std::string, double>> stages = {};  // of the median run, which they add up to
  int bits = 0;                                             // of sums a pixel; 0 where lists are kept
  int passes = 0;                                           // of geometry
  bool front = false;                                       // on the Pareto front of rmse against seconds
};

// Relative MSE over R, G, B of pixels where both are finite.
double relativeSquareError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth);

// Whether two costs differ by more than the rows' spreads.
bool clearlyFaster(const StudyRow& a, const StudyRow& b);
// Marks the rows that no other beats: in rmse at a cost that is not clearly more, or in cost, clearly, at the same
// rmse.
void markFront(std::vector<StudyRow>& rows);

std::vector<std::string> studyHead();
std::vector<std::string> studyCells(const StudyRow& row);
std::string rowName(const StudyRow& row);  // "weighted", "weighted exact x8"
std::vector<std::string> stageNames(const std::vector<StudyRow>& rows);
std::vector<std::string> stageCells(const StudyRow& row, const std::vector<std::string>& names);
std::string studyText(const std::vector<StudyRow>& rows);  // aligned columns
std::string studyCsv(const std::vector<StudyRow>& rows);
}  // namespace pellucid
