// Frames of a shot as they are written on the command line: "1001-1100x2,1200".
#pragma once
#include <string>
#include <vector>

namespace pellucid {

struct FrameRange {
  std::vector<int> frames;      // in the order given, each once
  std::vector<int> duplicates;  // those that were given more than once, each once
};

// Parts between commas: N, FIRST-LAST or FIRST-LASTxSTEP. FIRST may be the larger number: the frames then go down. A
// number may be negative: "-5--2". Frames lie within a million of 0, and so many are allowed at most. Throws UsageError
// that names the flag.
FrameRange parseFrames(const std::string& text, const std::string& flag);

// "1001-1008, 1012": what a person reads. Neighbours that follow one another upwards become a range.
std::string framesText(const std::vector<int>& frames);

}  // namespace pellucid
