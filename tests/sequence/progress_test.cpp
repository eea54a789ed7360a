// What is said of how far a run is, with a clock of its own.
#include "composite/sequence/progress.h"

#include <gtest/gtest.h>

#include <sstream>

namespace pellucid {
namespace {

using State = FrameOutcome::State;

struct Watched {
  explicit Watched(ProgressForm form, std::vector<std::string> names = {"1001", "1002", "1003", "1004"})
      : progress(
            form, std::move(names), [this](const std::string& text) { said += text; },
            [this] { return Progress::Clock::time_point(std::chrono::milliseconds(milliseconds)); }) {}
  void end(std::size_t frame, State state, double seconds = 0.0) {
    FrameOutcome outcome;
    outcome.state = state;
    outcome.seconds = seconds;
    progress.ended(frame, outcome);
  }
  long milliseconds = 0;
  std::string said;
  Progress progress;
};

TEST(Progress, ClockText) {
  EXPECT_EQ(clockText(7.4), "0:07");
  EXPECT_EQ(clockText(723), "12:03");
  EXPECT_EQ(clockText(3723), "1:02:03");
}

TEST(Progress, ShareAndTimeLeft) {
  Watched run(ProgressForm::none);
  EXPECT_LT(run.progress.secondsLeft(), 0.0) << "nothing is known yet";
  run.milliseconds = 10000;
  run.end(0, State::done);
  EXPECT_DOUBLE_EQ(run.progress.share(), 0.25);
  EXPECT_DOUBLE_EQ(run.progress.secondsLeft(), 30.0);
  run.progress.stage(1, "passes", 0.5);
  EXPECT_DOUBLE_EQ(run.progress.share(), 0.375);
  run.milliseconds = 15000;
  EXPECT_DOUBLE_EQ(run.progress.secondsLeft(), 25.0);
  // What was skipped took no time, and says nothing of what the others take.
  run.end(2, State::skipped);
  EXPECT_DOUBLE_EQ(run.progress.secondsLeft(), 15.0);
  EXPECT_EQ(run.said, "");
}

TEST(Progress, ALinePerFrame) {
  Watched run(ProgressForm::plain);
  run.milliseconds = 2000;
  run.progress.stage(0, "passes", 0.5);
  run.end(0, State::done, 2.0);
  run.end(1, State::skipped);
  run.end(2, State::failed, 0.5);
  EXPECT_EQ(run.said,
            "pellucid: frame 1001: done in 2.00 s (1 of 4, 0:06 left)\n"
            "pellucid: frame 1002: skipped, its inputs and flags are the same (2 of 4, 0:04 left)\n"
            "pellucid: frame 1003: failed in 0.50 s (3 of 4, 0:01 left)\n");
}

TEST(Progress, OpenJobDescription) {
  Watched run(ProgressForm::openjd, {"1001", "1002"});
  run.progress.stage(0, "transparent pass", 0.5);
  run.end(0, State::done);
  EXPECT_EQ(run.said,
            "openjd_progress: 25\nopenjd_status: frame 1001: transparent pass\n"
            "openjd_progress: 50\nopenjd_status: frame 1001: done\n");
}

TEST(Progress, JsonLines) {
  Watched run(ProgressForm::json, {"1001", "1002"});
  run.progress.stage(0, "passes", 0.5);
  run.end(0, State::done, 1.5);
  std::istringstream lines(run.said);
  std::vector<nlohmann::json> parsed;
  for (std::string line; std::getline(lines, line);) parsed.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(parsed.size(), 2u);
  EXPECT_EQ(parsed[0]["progress"], 25);
  EXPECT_EQ(parsed[0]["stage"], "passes");
  EXPECT_EQ(parsed[1]["state"], "done");
  EXPECT_EQ(parsed[1]["seconds"], 1.5);
}

TEST(Progress, TheBarIsOneLine) {
  Watched run(ProgressForm::bar);
  run.milliseconds = 1000;
  run.progress.stage(0, "passes", 0.5);
  EXPECT_EQ(run.said, "\rframe 1001: [===                     ]  12%  passes  0:07 left\033[K");
  run.said.clear();
  run.progress.between("a note\n");
  EXPECT_EQ(run.said.substr(0, 11), "\r\033[Ka note\n") << "the note stands on a line of its own";
  run.said.clear();
  run.progress.finish();
  EXPECT_EQ(run.said, "\r\033[K");
  run.said.clear();
  run.progress.tick();
  EXPECT_EQ(run.said, "") << "it stays away";
}

TEST(Progress, ASinglePictureByTenths) {
  Watched run(ProgressForm::plain, {""});
  run.milliseconds = 1000;
  for (int i = 0; i <= 4; ++i) run.progress.stage(0, "passes", 0.05 * i);
  EXPECT_EQ(run.said, "pellucid: 10%, passes, 0:09 left\npellucid: 20%, passes, 0:04 left\n");
}

}  // namespace
}  // namespace pellucid
