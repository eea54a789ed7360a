// What `study` shows of a sequence: error and cost of every method along it.
#pragma once
#include "composite/cli/over_frames.h"

namespace pellucid::cli {

// Of the frames that were studied, whose summaries are the rows of their tables: for each method the mean and the
// largest error and time, and the frame where it errs most.
void printStudyTable(const std::vector<FrameRow>& rows);

}  // namespace pellucid::cli
