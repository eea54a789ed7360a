// --method auto: the cheapest method that stays within a tolerance on a shot. On a CPU every method that keeps lists
// costs what sorting them does, so two are left: the sums, and the truth. Probes tell whether the sums may do; if so
// they are drawn, and held against the truth on every pixel.
#pragma once
#include "composite/pipeline/result.h"

namespace pellucid {

// Where fewer layers lie in the mean of all pixels, sorting them is no dearer than resolving sums of the whole picture.
// Sorting eight panes that fill a picture takes 0.84 times as long as their sums, so that one is on the safe side.
inline constexpr double kLayersOfSums = 1.0;

// The request by the phenomenological sums, and by the truth.
Request bySums(const Request& request);
Request byTruth(const Request& request);

// Whether the sums are to be drawn, after the probes; and whether they stay, after they were measured.
bool sumsMayDo(const Choice& choice);
bool sumsDo(const Choice& choice);
// What was chosen and why, in one sentence: for messages.
std::string reasonOf(const Choice& choice);

}  // namespace pellucid
