// A verb carried out once, or for every frame of a shot.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/sequence_flags.h"
#include "composite/pipeline/request.h"

namespace pellucid::cli {

// One frame, or the only picture, as a verb sees it. Its flags have the frame's values already.
struct FrameRun {
  std::optional<int> number;                      // none outside of a sequence
  std::map<std::string, std::string> attributes;  // for the header of its output, beside the verb's own
  std::string weightFrom;                         // an output whose weight it takes instead of a fit of its own, or ""
  FrameVoice* voice = nullptr;                    // never null
  nlohmann::json summary;                         // for the table of the sequence

  bool inSequence() const { return number.has_value(); }
  // The request with the weight that all frames have, where each would fit its own.
  Request weighed(Request request) const;
  // The verb's own attributes with the frame's.
  std::map<std::string, std::string> with(std::map<std::string, std::string> own) const;
  // For Compositor and Journal: they say how far the frame is.
  std::function<void(const std::string&, double)> watcher() const;
};

// A frame that was carried out, for the table at the end.
struct FrameRow {
  int number = 0;
  FrameOutcome outcome;
};
using FrameTable = std::function<void(const std::vector<FrameRow>&)>;

// What a verb does for each frame.
struct VerbRun {
  bool json = false;                    // it prints its results as JSON
  std::function<void(FrameRun&)> work;  // for the frame whose values its flags have
  FrameTable table = nullptr;           // prints what a sequence shows at its end, as text
  // Whether a frame would fit a weight of its own: the first one does then, and the others take it.
  std::function<bool()> fits = nullptr;
};

// Runs the work for the only picture, or in worker processes for each frame, and throws what the run has come to: a
// usage error, or an Error of code 5 that names the frames which failed, or of code 1 those which differ. With --json
// the results of all frames are one document.
void overFrames(const CLI::App& verb, const SequenceFlags& flags, const VerbRun& run);

}  // namespace pellucid::cli
