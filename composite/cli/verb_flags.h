// The flags of each verb that other skins offer too: python/ parses its keywords with the very same registrations, so
// that a flag added to a verb is a keyword there.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/model_flag.h"
#include "composite/cli/preview_flags.h"
#include "composite/cli/render_flags.h"
#include "composite/compare/compare.h"
#include "composite/deep/flatten.h"
#include "composite/pipeline/resolve_planes.h"
#include "composite/pipeline/study_run.h"

namespace pellucid::cli {

// addTo() registers everything but what runs the verb.
struct CompositeFlags {
  std::string output;
  RenderFlags render;
  PreviewFlags preview;
  ModelFlag model;
  RunFlags run;
  bool explain = false;
  std::string explainPage;  // of the program alone: other skins have the plan as data
  //   allViews  --view all is taken
  void addTo(CLI::App& verb, bool allViews = true);
};

struct AccumulateFlags {
  std::string output;
  std::vector<std::string> heldOutBy;
  RenderFlags render;
  RunFlags run;
  void addTo(CLI::App& verb);
  Request request() const;  // throws UsageError
};

struct ResolveFlags {
  std::string opaque, output;
  std::vector<std::string> planes, layers;
  ReadFlags read;
  RunFlags run;
  LookupFlags lookup;
  SelfModulationFlag selfModulation;
  RimFlags rims;
  ColourFlags colour;
  PreviewFlags preview;
  void addTo(CLI::App& verb);
  PlanesRequest request() const;  // throws UsageError
};

struct FlattenFlags {
  std::vector<std::string> files;
  std::string output, view, budget = "16M", type = "float";
  RunFlags run;
  ColourFlags colour;
  PreviewFlags preview;
  void addTo(CLI::App& verb);
};
// Flattens, and writes what the flags name. Throws UsageError and what the readers throw.
//   told        the share of the files that is done; may be null
//   attributes  for the header of the output
FlatPicture flattenFiles(const FlattenFlags& flags, Stages& stages, const std::function<void(double)>& told = nullptr,
                         const std::map<std::string, std::string>& attributes = {});

struct CompareFlags {
  std::string a, b, html, metadata = "fail";
  CompareSettings thresholds;
  bool json = false;
  PageDisplayFlags shown;
  void addTo(CLI::App& verb);
  CompareSettings settings() const;
  // Before any file is opened. Throws UsageError.
  void check() const { shown.check(!html.empty()); }
  // The page, where it is wanted.
  void writeHtml(const ExrDocument& a, const ExrDocument& b, const CompareReport& report) const;
};

struct StudyFlags {
  std::string folder;
  std::vector<std::string> methods{"phenomenological", "sum",        "average",   "blended",   "weighted",
                                   "unsorted",         "front+tail", "wavelet:2", "moments:4", "mlab:4"};
  RenderFlags render;
  RunFlags run;
  std::vector<int> passes{1};
  std::vector<std::string> precisions{"float"};
  int repeats = 3;
  DisplayFlags shown;  // of study.html
  void addTo(CLI::App& verb);
  Request base() const;                                               // throws UsageError
  std::vector<StudyCandidate> candidates(const Request& base) const;  // throws UsageError
  // What study.html is shown by, before any file is opened. Throws UsageError, and what ColourConfig::read throws.
  void checkShown() const;
  // What the verb leaves in its folder, which is there. Throws ResourceError.
  void write(const OpaqueFile& picture, const StudyOutcome& outcome) const;
};

}  // namespace pellucid::cli
