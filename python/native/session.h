// A shot that stays loaded while options change.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "composite/pipeline/compositor.h"
#include "python/native/words.h"

namespace pellucid::python {

// What one run hands back.
struct Outcome {
  Result result;
  std::vector<std::string> notes;
  ShotFacts facts;
  std::string space;  // that the colours are in
};

// Any thread may call it; calls wait for each other. All of it works without
// Python's lock.
class Session {
 public:
  //   planes  the opaque picture, or null for a file, which then is the first
  //   of the words' files camera  as matrices, or nothing for what the words
  //   say
  Session(const Words& words, std::shared_ptr<const GBuffer> picture, std::optional<Camera> camera);

  // As these words say. The shot is loaded anew where they ask it of other
  // files, or read otherwise. Throws Error.
  Outcome run(const Words& words);
  std::pair<Plan, ShotFacts> plan(const Words& words);
  // Where the picture's colours and depths lie that a run reads.
  std::pair<std::uintptr_t, std::uintptr_t> addresses();
  int loads();  // how often a shot was loaded

 private:
  // What the words say; those of the call before are not parsed again, but their outputs are checked. Throws UsageError
  // and ResourceError.
  const OneViewFlags& flagsOf(const Words& words);
  Request requestOf(const OneViewFlags& flags) const;
  void load(const Request& request);

  std::mutex mutex_;
  std::shared_ptr<const GBuffer> picture_;
  std::optional<Camera> camera_;
  std::unique_ptr<const Parsed<OneViewFlags>> parsed_;
  Words words_;                           // that were parsed
  std::vector<std::string> saidOfWords_;  // by the parsing
  std::vector<std::string> notes_;        // for the next outcome
  std::unique_ptr<Compositor> compositor_;
  ShotRequest loaded_;
  bool traced_ = false;
  int loads_ = 0;
};

}  // namespace pellucid::python
