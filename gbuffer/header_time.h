// Which frame a picture is, as its EXR header says it.
#pragma once
#include <optional>
#include <string>

#include "gbuffer/exr_document.h"

namespace pellucid {

// What our own producers write: "OPEN:CLOSE", as --shutter takes it. No other producer is known that says when the
// shutter opens and closes.
constexpr const char* kShutterAttribute = "pellucid:shutter";
constexpr double kLongestShutter = 1e4;  // frames away from the frame

// "SECONDS:RATE", where gbuffer was told more than a frame: a time, a rate, or an offset.
constexpr const char* kTimeAttribute = "pellucid:time";

// When the scene stood as the picture shows it.
struct StatedTime {
  double seconds = 0.0, framesPerSecond = 0.0;  // the second above 0
};
std::string timeText(const StatedTime& time);  // reads back to the same bits

// In frames around the frame, the first not above the second.
struct OpenShutter {
  double open = 0.0, close = 0.0;
};
std::string shutterText(const OpenShutter& shutter);  // reads back to the same bits

struct HeaderTime {
  std::optional<int> frame;
  std::string frameBy;                    // "attribute Frame", "attribute timeCode"; "" without a frame
  std::optional<double> framesPerSecond;  // of the attribute of that name, in either case of its first letter, > 0
  std::optional<StatedTime> stated;       // of kTimeAttribute
  std::optional<OpenShutter> shutter;     // of kShutterAttribute
  std::optional<double> exposure;         // seconds, of the attribute expTime: how long, but not when
};

// Of the first part that says it: `Frame`, a text or a number as Blender writes it, else `timeCode` (SMPTE 12M) counted
// in frames from 00:00:00:00 at `framesPerSecond`, else at 24 a second. What is malformed is as if it were absent.
HeaderTime headerTimeOf(const ExrDocument& document);

}  // namespace pellucid
