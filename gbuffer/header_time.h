// Which frame a picture is, as its EXR header says it.
#pragma once
#include <optional>
#include <string>

#include "gbuffer/exr_document.h"

namespace pellucid {

struct HeaderTime {
  std::optional<int> frame;
  std::string frameBy;                    // "attribute Frame", "attribute timeCode"; "" without a frame
  std::optional<double> framesPerSecond;  // of the attribute of that name, > 0
};

// Of the first part that says it: `Frame`, a text or a number as Blender writes it, else `timeCode` (SMPTE 12M) counted
// in frames from 00:00:00:00 at `framesPerSecond`, else at 24 a second. What is malformed is as if it were absent.
HeaderTime headerTimeOf(const ExrDocument& document);

}  // namespace pellucid
