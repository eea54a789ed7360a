#include "composite/cli/sequence_flags.h"

#include <unistd.h>

namespace pellucid::cli {

void SequenceFlags::addTo(CLI::App& verb, const SequenceVerb& what) {
  verb.add_option("--frames", frames,
                  "Frames of a shot, such as 1001-1100x2,1200: they take the place of ####, %04d, @@@@ and $F4 in the "
                  "names of files. Without it those that the first such name has on disk");
  if (what.sideBySide)
    verb.add_option("--jobs", jobs, "Frames side by side, which share --budget and --threads")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
  if (what.resumes)
    verb.add_flag("--skip-existing", skipExisting,
                  "Leave out what is there already, made from the same inputs by the same flags: its header says so");
  verb.add_option("--progress", progress,
                  "How far it is, on stderr: a bar on a terminal, else a line for every frame, is auto; openjd is for "
                  "farms that know Open Job Description, json for programs")
      ->check(CLI::IsMember({"auto", "none", "plain", "openjd", "json"}))
      ->capture_default_str();
  verb.add_flag("--log-json", logJson, "Messages on stderr as JSON, one object a line");
}

ProgressForm SequenceFlags::form(bool sequence) const {
  if (progress == "none") return ProgressForm::none;
  if (progress == "plain") return ProgressForm::plain;
  if (progress == "openjd") return ProgressForm::openjd;
  if (progress == "json") return ProgressForm::json;
  if (logJson) return ProgressForm::none;
  const char* terminal = std::getenv("TERM");
  if (::isatty(STDERR_FILENO) && terminal && std::string(terminal) != "dumb") return ProgressForm::bar;
  return sequence ? ProgressForm::plain : ProgressForm::none;
}

}  // namespace pellucid::cli
