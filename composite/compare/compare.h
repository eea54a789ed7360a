// A regression gate for EXR files: idiff's thresholds, and what idiff lets pass (NaN, infinity, windows, channels,
// metadata).
#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"

namespace pellucid {

// A channel value differs when |a - b| > max(absolute, relative * max(|a|, |b|)); a pixel differs when one of its
// channels does. A layer is over when more than `percent` of its pixels and more than `allowed` pixels differ, or one
// value differs by more than `hard`.
struct CompareLimit {
  double absolute = 1e-6;  // >= 0, in the channel's unit
  double relative = 0.0;   // >= 0
  double percent = 0.0;    // [0,100]
  double hard = std::numeric_limits<double>::infinity();
};

enum class MetadataRule { fail, warn, ignore };

struct CompareSettings {
  CompareLimit fail, warn;
  std::size_t allowedFailures = 0;  // pixels of a layer
  MetadataRule metadata = MetadataRule::fail;
  std::vector<std::string>
      ignoredAttributes;  // beside the clock's (capDate, utcOffset, DateTime, Date, RenderTime) and pellucid:digest
  std::vector<std::string> layers;  // compare only these; empty compares all. "" is the layer without a name
  bool finiteOnly = false;          // infinity and NaN fail even where both files agree on them
};

enum class Verdict { same, warned, failed };

struct WorstValue {
  int x = 0, y = 0;  // display coordinates, y down
  std::string channel;
  double a = 0, b = 0, difference = 0;  // +inf for a number against NaN or infinity
};

// Over the pixels that both data windows hold. Sums over finite pairs only.
struct LayerReport {
  std::string name;  // "" for channels without a layer; with its part where there are several
  std::vector<std::string> channels;
  std::size_t pixels = 0, failing = 0, warning = 0;
  std::size_t notFinite = 0;        // values where one file holds NaN or infinity and the other something else
  std::size_t notFiniteInBoth = 0;  // values where both hold the same of them
  double mean = 0, rms = 0;         // of |a - b| over values
  std::optional<WorstValue> worst;  // nothing when all values are equal
  Verdict verdict = Verdict::same;
};

struct CompareReport {
  std::vector<std::string> structure;  // one sentence each: parts, windows, channel sets, types. Always a failure
  std::vector<std::string> metadata;   // one sentence each: attributes that differ
  std::vector<LayerReport> layers;
  Verdict verdict = Verdict::same;
};

// Deep parts are compared sample by sample in the order stored. Throws InputError when samples cannot be read,
// UsageError for a layer of the settings that neither file has.
CompareReport compareExr(const ExrDocument& a, const ExrDocument& b, const CompareSettings& settings);

// The report as people read it, one line per finding.
std::string reportText(const CompareReport& report, const std::string& a, const std::string& b);

}  // namespace pellucid
