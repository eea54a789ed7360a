// Which frames a command line is about, and its flags as each of them has them.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/cli/verb_paths.h"

namespace pellucid::cli {

// Whether the verb is to run for frames: --frames is given, or an input is named by a pattern.
bool isSequence(const CLI::App& verb);

// The frames of a verb for which isSequence() holds, and what they put into its flags.
class FrameChoice {
 public:
  // Notes which frames were found where none were asked for, and those that were given twice. Throws UsageError for
  // outputs that all frames would share and what parseFrames() throws, InputError where no file fits the pattern.
  FrameChoice(const CLI::App& verb, const std::string& framesFlag);

  const std::vector<int>& frames() const { return frames_; }
  // Gives the verb's flags the values that they have for a frame.
  void put(int frame) const;
  const std::vector<VerbPath>& paths() const { return paths_; }

 private:
  void findFrames(const std::string& framesFlag);
  void expectOneEach() const;  // of every output

  const CLI::App& verb_;
  std::vector<VerbPath> paths_;
  std::vector<std::vector<std::string>> values_;  // as they were given, of each path
  std::vector<int> frames_;
};

// Gives a flag of the verb another value, as if it had been on the command line; nothing where the verb lacks it.
void giveFlag(const CLI::App& verb, const std::string& flag, const std::vector<std::string>& values);

}  // namespace pellucid::cli
