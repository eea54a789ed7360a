// How far a run is: a bar on a terminal, lines for people, farms or programs.
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "composite/sequence/frame_workers.h"

namespace pellucid {

enum class ProgressForm {
  none,
  bar,     // one line that is drawn again and again: frame, stage, percentage, time left
  plain,   // a line for every frame, and for every tenth of a single picture
  openjd,  // openjd_progress and openjd_status, as Open Job Description has them
  json,    // an object a line
};

// Writes what it is told of to a stream, as whole lines but for the bar.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  //   names  of the frames, in order; one that is empty is a picture outside of a sequence
  //   write  takes text for the stream
  //   now    for tests
  Progress(ProgressForm form, std::vector<std::string> names, std::function<void(const std::string&)> write,
           std::function<Clock::time_point()> now = Clock::now);

  void stage(std::size_t frame, const std::string& stage, double share);
  void ended(std::size_t frame, const FrameOutcome& outcome);
  void tick();    // draws the bar again, for the time goes on
  void finish();  // takes the bar away
  // Writes whole lines between what it shows.
  void between(const std::string& lines);

  double share() const;        // of the whole run that is done, [0,1]
  double secondsLeft() const;  // by the time that this run's own work has taken; negative while nothing is known

 private:
  std::string leftText() const;
  void draw();
  void lineOfStage(std::size_t frame);

  ProgressForm form_;
  std::vector<std::string> names_;
  std::function<void(const std::string&)> write_;
  std::function<Clock::time_point()> now_;
  Clock::time_point start_;
  std::vector<double> shares_;
  std::size_t worked_ = 0, over_ = 0, failed_ = 0;
  std::size_t shown_ = 0;  // the frame whose stage the bar tells
  std::string stage_;
  int lastPercent_ = -1;
  bool drawn_ = false;
};

// "0:07", "12:03", "1:02:03".
std::string clockText(double seconds);

}  // namespace pellucid
