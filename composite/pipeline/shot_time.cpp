#include "composite/pipeline/shot_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kUsualFramesPerSecond = 24.0;
constexpr double kMostSeconds = 1e9;  // beyond it a double no longer tells frames from each other

void expectSeconds(const std::optional<double>& value, const char* flag) {
  if (value && !(std::abs(*value) <= kMostSeconds))
    throw UsageError(fmt::format("{}: found {:g}, expected seconds from -1e9 to 1e9", flag, *value));
}

}  // namespace

std::optional<ShotMoment> momentOf(const ShotTime& time, const HeaderTime& header) {
  if (time.none()) return std::nullopt;
  ShotMoment moment;
  moment.framesPerSecond = time.framesPerSecond.value_or(header.framesPerSecond.value_or(kUsualFramesPerSecond));
  if (time.seconds) {
    moment.seconds = *time.seconds;
    moment.origin = fmt::format("{:g} s (--time)", moment.seconds);
    return moment;
  }
  if (header.stated && !time.frame && !time.framesPerSecond && !time.offset) {
    moment.frame = header.frame;
    moment.seconds = header.stated->seconds;
    moment.framesPerSecond = header.stated->framesPerSecond;
    moment.origin = fmt::format("{:.6f} s at {:g} frames a second (attribute {})", moment.seconds,
                                moment.framesPerSecond, kTimeAttribute);
    return moment;
  }
  moment.frame = time.frame ? time.frame : header.frame;
  if (!moment.frame) return std::nullopt;
  const double offset = time.offset.value_or(0.0);
  moment.seconds = static_cast<double>(*moment.frame) / moment.framesPerSecond + offset;
  moment.origin = fmt::format("{:.6f} s, frame {} ({}) at {:g} frames a second ({}){}", moment.seconds, *moment.frame,
                              time.frame ? "--frame" : header.frameBy, moment.framesPerSecond,
                              time.framesPerSecond     ? "--fps"
                              : header.framesPerSecond ? "attribute framesPerSecond"
                                                       : "--fps sets it",
                              offset != 0.0 ? fmt::format(" and {:g} s (--time-offset)", offset) : "");
  return moment;
}

std::optional<StatedTime> timeToState(const ShotTime& time) {
  const std::optional<ShotMoment> moment = momentOf(time, {});
  if (!moment || !(time.seconds || time.framesPerSecond || time.offset)) return std::nullopt;
  return StatedTime{moment->seconds, moment->framesPerSecond};
}

void checkShutter(const Shutter& shutter) {
  if (!(std::abs(shutter.open) <= kLongestShutter && std::abs(shutter.close) <= kLongestShutter &&
        shutter.open <= shutter.close))
    throw UsageError(
        fmt::format("--shutter: found {:g}:{:g}, expected OPEN:CLOSE in frames from -1e4 to 1e4, the first "
                    "not above the second",
                    shutter.open, shutter.close));
}

void checkTime(const ShotTime& time) {
  if (time.seconds && time.frame)
    throw UsageError("--time: found it with --frame, expected one of them: each says when the shot is taken");
  if (time.seconds && time.offset)
    throw UsageError("--time-offset: found it with --time, expected a frame: it is added to a frame's time");
  expectSeconds(time.seconds, "--time");
  expectSeconds(time.offset, "--time-offset");
  if (time.framesPerSecond && !(*time.framesPerSecond >= 1e-3 && *time.framesPerSecond <= 1e6))
    throw UsageError(
        fmt::format("--fps: found {:g}, expected frames a second from 0.001 to 1e6", *time.framesPerSecond));
  const bool word = std::any_of(time.animations.begin(), time.animations.end(),
                                [](const std::string& name) { return name == "all" || name == "none"; });
  if (word && time.animations.size() > 1)
    throw UsageError("--animation: found all or none beside others, expected names alone, or one of the two words");
  if (time.none() && (time.seconds || time.frame || time.framesPerSecond || time.offset))
    throw UsageError(
        "--animation: found none with a time, expected --frame, --time, --fps or --time-offset without it");
}

}  // namespace pellucid
