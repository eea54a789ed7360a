// The flags of frames: which ones, how many side by side, which are left out, and what is said meanwhile.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/sequence/progress.h"

namespace pellucid::cli {

// What a verb can do with frames.
struct SequenceVerb {
  bool sideBySide = true;  // --jobs
  bool resumes = true;     // --skip-existing: its outputs have headers
};

struct SequenceFlags {
  std::string frames, progress = "auto";
  int jobs = 1;
  bool skipExisting = false, logJson = false;
  void addTo(CLI::App& verb, const SequenceVerb& what = {});
  // auto is a bar on a terminal, else lines of a sequence and nothing of a single picture.
  ProgressForm form(bool sequence) const;
};

}  // namespace pellucid::cli
