// A frame's turn in a worker process: its flags, what is there of it already, and what came of it.
#pragma once
#include "composite/cli/frame_choice.h"
#include "composite/cli/over_frames.h"
#include "composite/sequence/digest.h"

namespace pellucid::cli {

class FrameTurn {
 public:
  // All of it outlives the turn.
  FrameTurn(const CLI::App& verb, const FrameChoice& choice, const SequenceFlags& flags, const VerbRun& run);

  // Whether the first frame fits a weight, which the others take.
  bool fitsWeight() const { return fitsWeight_; }
  // From here on this process prints into the outcome, and its notes go to the voice.
  //   weightFrom  the output of a frame that has fitted its weight, or ""
  FrameOutcome take(std::size_t index, const std::string& weightFrom, FrameVoice& voice);

 private:
  FrameOutcome::State carryOut(FrameRun& run);

  const CLI::App& verb_;
  const FrameChoice& choice_;
  const SequenceFlags& flags_;
  const VerbRun& run_;
  bool fitsWeight_ = false;
  FileDigests files_;
};

// What a single picture says while it is made: progress on stderr, and notes between it.
class SingleVoice : public FrameVoice {
 public:
  explicit SingleVoice(ProgressForm form);
  ~SingleVoice() override;
  void note(const std::string& sentence) override;
  void stage(const std::string& stage, double share) override;
  void ended();

 private:
  Progress progress_;
};

}  // namespace pellucid::cli
