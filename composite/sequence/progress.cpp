#include "composite/sequence/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr int kBarWidth = 24;

std::string frameText(const std::string& name) {
  return name.empty() ? "" : "frame " + name + ": ";
}

const char* wordOf(FrameOutcome::State state) {
  switch (state) {
    case FrameOutcome::State::done:
      return "done";
    case FrameOutcome::State::skipped:
      return "skipped";
    case FrameOutcome::State::differs:
      return "differs";
    case FrameOutcome::State::failed:
      return "failed";
  }
  return "";
}

std::string dumped(const nlohmann::json& line) {
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string clockText(double seconds) {
  const long whole = std::lround(std::max(seconds, 0.0));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

Progress::Progress(ProgressForm form, std::vector<std::string> names, std::function<void(const std::string&)> write,
                   std::function<Clock::time_point()> now)
    : form_(form),
      names_(std::move(names)),
      write_(std::move(write)),
      now_(std::move(now)),
      start_(now_()),
      shares_(names_.size(), 0.0) {}

double Progress::share() const {
  double sum = static_cast<double>(over_);
  for (const double share : shares_) sum += share;
  return shares_.empty() ? 1.0 : std::min(sum / static_cast<double>(shares_.size()), 1.0);
}

double Progress::secondsLeft() const {
  double open = 0.0;
  for (const double share : shares_) open += share;
  const double worked = static_cast<double>(worked_) + open;
  if (worked <= 0.0) return -1.0;
  const double seconds = std::chrono::duration<double>(now_() - start_).count();
  return seconds / worked * (static_cast<double>(shares_.size() - over_) - open);
}

std::string Progress::leftText() const {
  const double left = secondsLeft();
  return left < 0.0 ? "" : clockText(left) + " left";
}

void Progress::draw() {
  if (form_ != ProgressForm::bar) return;
  const double done = share();
  const int filled = static_cast<int>(done * kBarWidth);
  std::string line = fmt::format("\r{}[{}{}] {:3.0f}%", frameText(names_.empty() ? "" : names_[shown_]),
                                 std::string(static_cast<std::size_t>(filled), '='),
                                 std::string(static_cast<std::size_t>(kBarWidth - filled), ' '), 100.0 * done);
  if (failed_) line += fmt::format("  {} failed", failed_);
  if (!stage_.empty()) line += "  " + stage_;
  if (const std::string left = leftText(); !left.empty()) line += "  " + left;
  write_(line + "\033[K");
  drawn_ = true;
}

void Progress::lineOfStage(std::size_t frame) {
  const int percent = static_cast<int>(100.0 * share());
  if (form_ == ProgressForm::openjd && percent != lastPercent_)
    write_(fmt::format("openjd_progress: {}\nopenjd_status: {}{}\n", percent, frameText(names_[frame]), stage_));
  if (form_ == ProgressForm::json && percent != lastPercent_)
    write_(
        dumped({{"progress", percent}, {"frame", names_[frame]}, {"stage", stage_}, {"secondsLeft", secondsLeft()}}));
  const bool single = names_.size() == 1;
  if (form_ == ProgressForm::plain && single && percent / 10 != lastPercent_ / 10)
    write_(fmt::format("pellucid: {}{}%, {}{}\n", frameText(names_[frame]), percent, stage_,
                       leftText().empty() ? "" : ", " + leftText()));
  lastPercent_ = percent;
}

void Progress::stage(std::size_t frame, const std::string& stage, double share) {
  shares_[frame] = std::clamp(share, 0.0, 1.0);
  shown_ = frame;
  stage_ = stage;
  draw();
  lineOfStage(frame);
}

void Progress::ended(std::size_t frame, const FrameOutcome& outcome) {
  const bool skipped = outcome.state == FrameOutcome::State::skipped;
  const bool failed = outcome.state == FrameOutcome::State::failed;
  shares_[frame] = 0.0;
  ++over_;
  if (!skipped) ++worked_;
  if (failed) ++failed_;
  shown_ = frame;
  stage_.clear();
  const std::string name = names_[frame];
  const int percent = static_cast<int>(100.0 * share());
  lastPercent_ = percent;
  if (form_ == ProgressForm::plain && !name.empty()) {
    std::string line = fmt::format("pellucid: frame {}: {}", name, wordOf(outcome.state));
    if (skipped)
      line += ", its inputs and flags are the same";
    else
      line += fmt::format(" in {:.2f} s", outcome.seconds);
    line += fmt::format(" ({} of {}", over_, names_.size());
    if (over_ < names_.size() && !leftText().empty()) line += ", " + leftText();
    write_(line + ")\n");
  }
  if (form_ == ProgressForm::openjd)
    write_(fmt::format("openjd_progress: {}\nopenjd_status: {}{}\n", percent, frameText(name), wordOf(outcome.state)));
  if (form_ == ProgressForm::json)
    write_(dumped({{"progress", percent},
                   {"frame", name},
                   {"state", wordOf(outcome.state)},
                   {"seconds", outcome.seconds},
                   {"code", outcome.code},
                   {"secondsLeft", secondsLeft()}}));
  draw();
}

void Progress::tick() {
  if (drawn_) draw();
}

void Progress::finish() {
  if (drawn_) write_("\r\033[K");
  drawn_ = false;
}

void Progress::between(const std::string& lines) {
  const bool bar = drawn_;
  finish();
  write_(lines);
  if (bar) draw();
}

}  // namespace pellucid
