// Error against cost of many requests on one shot: the loop behind `study`.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "composite/pipeline/compositor.h"
#include "composite/study/study.h"

namespace pellucid {

// One row to be.
struct StudyCandidate {
  std::string name, precision;  // as the table shows them
  Request request;
};

// The truth (sorted) and every method at every number of passes; tiers are those of the sums alone.
//   base     what all share; its weight and normalisation go to those that read them
//   methods  as --method takes them. Throws UsageError for one that is unknown
//   paintOf  what a method's name means
std::vector<StudyCandidate> studyCandidates(const Request& base, const std::vector<std::string>& methods,
                                            const std::vector<int>& passes, const std::vector<Tier>& tiers,
                                            const std::function<Paint(const std::string& method, int passes)>& paintOf);

struct StudyOutcome {
  std::vector<StudyRow> rows;              // in the order of the candidates
  std::vector<Image<glm::vec3>> pictures;  // of each
  std::string machine;                     // the device and the threads that rows were timed on, and how
};
// Errors are against the sorted candidate of most passes. The picture of each is that of Compositor::run(): where its
// weight is fitted, to what it draws itself. Its seconds are without the fit.
//   repeats  timed runs of each after one that is not counted, >= 1
//   begins   is told before each candidate how many are done, of how many; may be null
StudyOutcome runStudy(Compositor& compositor, const std::vector<StudyCandidate>& candidates, int repeats,
                      const std::function<void(std::size_t done, std::size_t all)>& begins = nullptr);

}  // namespace pellucid
