// When a shot is taken: the frame or the time, and which of the glTF's animations are played.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/header_time.h"

namespace pellucid {

struct ShotTime {
  std::optional<int> frame;               // --frame; of a sequence each frame in turn; else the picture's header
  std::optional<double> seconds;          // --time: of the glTF, instead of a frame
  std::optional<double> framesPerSecond;  // --fps; else the header's, else 24
  std::optional<double> offset;           // --time-offset: seconds added to a frame's time
  std::vector<std::string> animations;    // --animation: names, or "all", or "none"; empty leaves it to the file
  bool none() const { return animations.size() == 1 && animations[0] == "none"; }
};

// While the shutter is open, in frames around the frame.
struct Shutter {
  double open = 0.0, close = 0.0;
  bool holdsCamera = false;  // only what the camera sees moves
  bool opens() const { return open != 0.0 || close != 0.0; }
};

// Throws UsageError for what is not finite, longer than a minute of film, or closes before it opens.
void checkShutter(const Shutter& shutter);

// A point in the glTF's time.
struct ShotMoment {
  double seconds = 0.0;
  double framesPerSecond = 24.0;
  std::optional<int> frame;
  std::string origin;  // for messages: "frame 1003 (attribute Frame) at 24 frames a second"
  // Away from it by a part of a frame: what shutters are given in.
  double at(double frames) const { return seconds + frames / framesPerSecond; }
};

// time = frame / fps + offset, as Blender's exporter writes it; a header that states the time itself wins over its
// frame. Nothing where neither the request nor the header says when: the glTF then stands as it is stored.
std::optional<ShotMoment> momentOf(const ShotTime& time, const HeaderTime& header);

// What a header has to say of it: nothing where a frame at the usual rate says all.
std::optional<StatedTime> timeToState(const ShotTime& time);

// Throws UsageError for what contradicts itself.
void checkTime(const ShotTime& time);

}  // namespace pellucid
