// What `compare` shows of a sequence: the error of every frame, and how it changes from one to the next.
#pragma once
#include "composite/cli/over_frames.h"
#include "composite/compare/temporal.h"

namespace pellucid::cli {

// A row for each layer: name, rms and largest difference within the frame, and against the frame before where there is
// one.
nlohmann::json summaryOf(const CompareReport& report, const std::vector<TemporalLayer>& flicker);

// Of the frames that were compared: those rows, and the worst frame of each kind of error.
void printCompareTable(const std::vector<FrameRow>& rows);

}  // namespace pellucid::cli
