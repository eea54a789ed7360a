// Frames carried out in processes of their own, one after another or side by side: what breaks one of them is an error
// of that frame.
#pragma once
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pellucid {

// What became of a frame.
struct FrameOutcome {
  enum class State { done, skipped, differs, failed };
  State state = State::done;
  int code = 0;         // exit code of what failed or differs
  std::string message;  // one sentence, of the same
  double seconds = 0.0;
  std::string out;         // what it would print to stdout
  nlohmann::json summary;  // what a table of the whole sequence shows of it
  std::string handOn;      // for the frames after it, "" for nothing
};

// What a worker says while it is at a frame.
class FrameVoice {
 public:
  virtual ~FrameVoice() = default;
  virtual void note(const std::string& sentence) = 0;
  //   share  of the frame's work that is done, [0,1]
  virtual void stage(const std::string& stage, double share) = 0;
};

// What the process that waits hears; all of it on its only thread.
class FrameListener {
 public:
  virtual ~FrameListener() = default;
  virtual void note(std::size_t index, const std::string& sentence) = 0;
  virtual void stage(std::size_t index, const std::string& stage, double share) = 0;
  virtual void ended(std::size_t index, const FrameOutcome& outcome) = 0;
  virtual void tick() = 0;  // a few times a second
};

struct FrameWork {
  std::size_t count = 0;  // frames, known by their index
  int jobs = 1;           // processes side by side
  bool handsOn = false;   // until a frame has handed something on, one runs at a time
  // Carried out by a worker, frame after frame; what it keeps between them is its own. Throws nothing.
  //   handedOn  by an earlier frame, or ""
  std::function<FrameOutcome(std::size_t index, const std::string& handedOn, FrameVoice& voice)> work;
};

// Returns what became of each frame. Frames begin in order. A frame whose process dies has failed with the code 128 +
// signal. A usage error (code 2), which all frames would meet, stops the rest: they are left out of the result's end.
// The workers end when this process does, whatever ends it. It must have no other threads yet, and no GL context.
std::vector<FrameOutcome> runFrames(const FrameWork& frames, FrameListener& listener);

}  // namespace pellucid
