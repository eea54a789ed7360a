// What a sequence says while it runs, and what it has come to at its end.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "composite/cli/over_frames.h"

namespace pellucid::cli {

class FrameReport : public FrameListener {
 public:
  //   json  results are one document, at the end; else they are printed frame by frame, in order
  FrameReport(const std::vector<int>& frames, ProgressForm form, bool json);

  // A sentence that several frames have in common is said once.
  void note(std::size_t index, const std::string& sentence) override;
  void stage(std::size_t index, const std::string& stage, double share) override;
  void ended(std::size_t index, const FrameOutcome& outcome) override;
  void tick() override { progress_.tick(); }

  // Prints what is left, the verb's table and that of the frames which failed. Throws as overFrames() does.
  void end(const std::vector<FrameOutcome>& outcomes, const FrameTable& table);
  // Frames have one weight, that of the first one which is made: said when it is known.
  void tellWeight() { tellsWeight_ = true; }

 private:
  std::string nameOf(std::size_t index) const { return std::to_string(frames_[index]); }
  void printInOrder();
  void printDocument(const std::vector<FrameRow>& rows) const;
  void failures(const std::vector<FrameRow>& rows);

  const std::vector<int>& frames_;
  Progress progress_;
  ProgressForm form_;
  bool json_, tellsWeight_ = false;
  std::set<std::string> said_;
  std::vector<std::string> outs_;  // of frames that have ended
  std::vector<bool> over_;
  std::size_t printed_ = 0;
};

}  // namespace pellucid::cli
