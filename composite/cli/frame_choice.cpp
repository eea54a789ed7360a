#include "composite/cli/frame_choice.h"

#include <fmt/format.h>

#include "composite/cli/messages.h"
#include "composite/sequence/frame_pattern.h"
#include "composite/sequence/frame_range.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

void give(CLI::Option& option, const std::vector<std::string>& values) {
  option.clear();
  for (const std::string& value : values) option.add_result(value);
  if (!values.empty()) option.run_callback();
}

FramePattern patternOf(const VerbPath& path, const std::string& value) {
  if (path.written) return FramePattern(value);
  return inputPattern(fileNamedIn(path.flag, value)).any() ? FramePattern(value) : FramePattern("");
}

}  // namespace

bool isSequence(const CLI::App& verb) {
  const CLI::Option* frames = verb.get_option_no_throw("--frames");
  if (!frames) return false;
  if (frames->count() > 0) return true;
  for (const VerbPath& path : pathsOf(verb))
    for (const std::string& value : path.option->results()) {
      const FramePattern pattern = patternOf(path, value);
      if (!path.written && pattern.any()) return true;
      if (path.written && pattern.any() && pattern.unmistakable())
        throw UsageError(
            fmt::format("{}: found '{}' and no input that is named so, expected --frames with it", path.flag, value));
    }
  return false;
}

void giveFlag(const CLI::App& verb, const std::string& flag, const std::vector<std::string>& values) {
  if (const CLI::Option* option = verb.get_option_no_throw(flag)) give(const_cast<CLI::Option&>(*option), values);
}

FrameChoice::FrameChoice(const CLI::App& verb, const std::string& framesFlag) : verb_(verb), paths_(pathsOf(verb)) {
  for (const VerbPath& path : paths_) values_.push_back(path.option->results());
  if (const CLI::Option* frame = verb.get_option_no_throw("--frame"); frame && frame->count() > 0)
    throw UsageError("--frame: found it with several frames, expected --frames alone: each frame has its own number");
  findFrames(framesFlag);
  expectOneEach();
}

void FrameChoice::findFrames(const std::string& framesFlag) {
  if (!framesFlag.empty()) {
    const FrameRange range = parseFrames(framesFlag, "--frames");
    if (!range.duplicates.empty())
      note("--frames: found {} more than once, each is made once", framesText(range.duplicates));
    frames_ = range.frames;
    return;
  }
  for (std::size_t i = 0; i < paths_.size() && frames_.empty(); ++i)
    for (const std::string& value : values_[i]) {
      if (paths_[i].written || !patternOf(paths_[i], value).any()) continue;
      const FramePattern pattern(fileNamedIn(paths_[i].flag, value));
      frames_ = pattern.onDisk();
      if (frames_.empty())
        throw InputError(fmt::format("{}: found no file of that pattern, expected one for each frame", pattern.text()));
      note("frames {}: the {} files of {}; --frames says which", framesText(frames_), frames_.size(), pattern.text());
      break;
    }
}

void FrameChoice::expectOneEach() const {
  // study makes a folder for each frame within its own.
  const bool ownFolders = verb_.get_name() == "study";
  if (frames_.size() < 2 || ownFolders) return;
  for (std::size_t i = 0; i < paths_.size(); ++i)
    for (const std::string& value : values_[i])
      if (paths_[i].written && !FramePattern(value).any())
        throw UsageError(fmt::format(
            "{}: found '{}' for {} frames, expected the place of their numbers in it: ####, %04d, @@@@ or $F4",
            paths_[i].flag, value, frames_.size()));
}

void FrameChoice::put(int frame) const {
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (values_[i].empty()) continue;
    std::vector<std::string> values;
    for (const std::string& value : values_[i]) {
      const FramePattern pattern = patternOf(paths_[i], value);
      const bool folder = paths_[i].written == OutputKind::folder && !FramePattern(value).any();
      const auto fileOf = [&](const std::string& given) { return fileNamedIn(paths_[i].flag, given); };
      values.push_back(folder              ? value + "/" + std::to_string(frame)
                       : !pattern.any()    ? value
                       : paths_[i].written ? pattern.at(frame)
                                           : pattern.inputAt(frame, fileOf));
    }
    give(*paths_[i].option, values);
  }
  // What stands as it is stored has no time.
  const CLI::Option* animation = verb_.get_option_no_throw("--animation");
  if (animation && animation->count() == 1 && animation->results()[0] == "none") return;
  giveFlag(verb_, "--frame", {std::to_string(frame)});
}

}  // namespace pellucid::cli
