#include "composite/cli/frame_report.h"

#include <fmt/format.h>

#include <sstream>

#include "composite/cli/messages.h"
#include "composite/sequence/frame_range.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

std::vector<std::string> namesOf(const std::vector<int>& frames) {
  std::vector<std::string> names;
  for (const int frame : frames) names.push_back(std::to_string(frame));
  return names;
}

void toStderr(const std::string& text) {
  std::fputs(text.c_str(), stderr);
}

std::vector<int> thoseThat(const std::vector<FrameRow>& rows, FrameOutcome::State state) {
  std::vector<int> frames;
  for (const FrameRow& row : rows)
    if (row.outcome.state == state) frames.push_back(row.number);
  return frames;
}

}  // namespace

FrameReport::FrameReport(const std::vector<int>& frames, ProgressForm form, bool json)
    : frames_(frames),
      progress_(form, namesOf(frames), toStderr),
      form_(form),
      json_(json),
      outs_(frames.size()),
      over_(frames.size(), false) {}

void FrameReport::note(std::size_t index, const std::string& sentence) {
  if (said_.insert(sentence).second) progress_.between(messageLine("info", sentence, nameOf(index)));
}

void FrameReport::stage(std::size_t index, const std::string& stage, double share) {
  progress_.stage(index, stage, share);
}

void FrameReport::ended(std::size_t index, const FrameOutcome& outcome) {
  // A usage error is the run's, and tables tell what differs.
  if (outcome.state == FrameOutcome::State::failed && outcome.code != 2)
    progress_.between(messageLine("error", outcome.message, nameOf(index)));
  if (tellsWeight_ && !outcome.handOn.empty()) {
    tellsWeight_ = false;
    if (frames_.size() > 1)
      note(index, "the weight fitted to this frame is that of all frames, so that nothing flickers");
  }
  progress_.ended(index, outcome);
  over_[index] = true;
  outs_[index] = outcome.out;
  if (!json_) printInOrder();
}

void FrameReport::printInOrder() {
  for (; printed_ < over_.size() && over_[printed_]; ++printed_) {
    std::istringstream lines(outs_[printed_]);
    std::string text;
    for (std::string line; std::getline(lines, line);) text += nameOf(printed_) + "  " + line + "\n";
    outs_[printed_].clear();
    if (!text.empty()) progress_.finish();
    fmt::print("{}", text);
    std::fflush(stdout);
  }
}

void FrameReport::printDocument(const std::vector<FrameRow>& rows) const {
  nlohmann::json frames = nlohmann::json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FrameOutcome& outcome = rows[i].outcome;
    constexpr const char* kStates[] = {"done", "skipped", "differs", "failed"};
    nlohmann::json entry{
        {"frame", rows[i].number}, {"state", kStates[static_cast<int>(outcome.state)]}, {"seconds", outcome.seconds}};
    if (!outcome.message.empty()) entry["error"] = {{"code", outcome.code}, {"message", outcome.message}};
    if (!outcome.summary.is_null()) entry["summary"] = outcome.summary;
    const nlohmann::json report = nlohmann::json::parse(outs_[i], nullptr, false);
    if (!report.is_discarded()) entry["report"] = report;
    frames.push_back(std::move(entry));
  }
  fmt::print("{}\n", nlohmann::json{{"frames", frames}}.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void FrameReport::failures(const std::vector<FrameRow>& rows) {
  const std::vector<int> failed = thoseThat(rows, FrameOutcome::State::failed);
  for (const FrameRow& row : rows)
    if (row.outcome.state == FrameOutcome::State::failed && row.outcome.code == 2)
      throw UsageError(row.outcome.message);
  if (!failed.empty()) {
    if (form_ != ProgressForm::json && form_ != ProgressForm::openjd && !saysJson()) {
      toStderr("frame  code  what failed\n");
      for (const FrameRow& row : rows)
        if (row.outcome.state == FrameOutcome::State::failed)
          toStderr(fmt::format("{:<7}{:<6}{}\n", row.number, row.outcome.code, row.outcome.message));
    }
    const std::string what =
        fmt::format("{} of {} frames failed: {}", failed.size(), frames_.size(), framesText(failed));
    if (form_ == ProgressForm::openjd) toStderr("openjd_fail: " + what + "\n");
    // One frame alone, as a farm runs it, ends with the code of what is wrong with it.
    throw Error(frames_.size() == 1 ? rows[0].outcome.code : 5, what);
  }
  const std::vector<int> differ = thoseThat(rows, FrameOutcome::State::differs);
  if (!differ.empty())
    throw Error(1, fmt::format("{} of {} frames differ: {}", differ.size(), frames_.size(), framesText(differ)));
}

void FrameReport::end(const std::vector<FrameOutcome>& outcomes, const FrameTable& table) {
  progress_.finish();
  std::vector<FrameRow> rows;
  for (std::size_t i = 0; i < outcomes.size(); ++i) rows.push_back({frames_[i], outcomes[i]});
  if (json_)
    printDocument(rows);
  else if (table)
    table(rows);
  failures(rows);
}

}  // namespace pellucid::cli
