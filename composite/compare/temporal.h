// What flickers: how differently two sequences change from one frame to the next.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "composite/compare/compare.h"

namespace pellucid {

// Of one layer, between the frame before and this one. With a and b the values of both sequences, each value errs by
// (a(t) - a(t-1)) - (b(t) - b(t-1)): 0 where both change alike, whatever they differ by. Against a picture that stands
// still it is how much the first sequence changes.
struct TemporalLayer {
  std::string name;         // "" for channels without a layer
  std::size_t values = 0;   // that are finite in both sequences and both frames
  std::size_t changed = 0;  // of them, whose error is not 0
  double rms = 0.0;         // of the error
  double largest = 0.0;     // of its magnitude
};

// Takes the frames of two sequences in order. Holds what one frame of them differs by.
class TemporalError {
 public:
  // The layers that both frames have and the settings ask for; of deep parts nothing. Empty for the first frame, and
  // without those whose windows or channels are not the same as in the frame before.
  std::vector<TemporalLayer> next(const ExrDocument& a, const ExrDocument& b, const CompareSettings& settings);
  // A frame is missing: the next one has none before it.
  void forget() { before_.clear(); }

 private:
  struct Values {
    Window window;                   // that both sequences have
    std::vector<double> difference;  // a - b, row by row; NaN where either is not finite
  };
  std::map<std::string, Values> before_;  // by channel
};

}  // namespace pellucid
