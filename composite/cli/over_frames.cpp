#include "composite/cli/over_frames.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>

#include "composite/cli/budget.h"
#include "composite/cli/frame_choice.h"
#include "composite/cli/frame_digest.h"
#include "composite/cli/frame_report.h"
#include "composite/cli/frame_turn.h"
#include "composite/cli/freed_memory.h"
#include "composite/cli/messages.h"
#include "composite/cli/verb_outputs.h"
#include "composite/pipeline/default_weight.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

void runAlone(const CLI::App& verb, const SequenceFlags& flags, const std::function<void(FrameRun&)>& work) {
  SingleVoice voice(flags.form(false));
  FrameRun run;
  run.voice = &voice;
  if (flags.skipExisting) {
    FileDigests files;
    const std::vector<VerbPath> paths = pathsOf(verb);
    const std::string digest = frameDigest(verb, paths, "", files);
    if (isFinished(paths, digest)) {
      say("nothing to do: the output is there already, made from the same inputs by the same flags");
      return;
    }
    run.attributes[kDigestAttribute] = digest;
  }
  work(run);
  voice.ended();
}

// Each of several workers has its part of the memory and of the cores; neither changes a bit.
void shareOut(const CLI::App& verb, int jobs) {
  if (jobs < 2) return;
  constexpr std::size_t kLeast = std::size_t{1} << 20;  // of --budget
  if (const CLI::Option* budget = verb.get_option_no_throw("--budget")) {
    const std::size_t all = parseBudget(budget->as<std::string>());
    giveFlag(verb, "--budget", {std::to_string(std::max(all / static_cast<std::size_t>(jobs), kLeast))});
  }
  if (const CLI::Option* threads = verb.get_option_no_throw("--threads")) {
    const int asked = threads->as<int>(), all = asked > 0 ? asked : tbb::info::default_concurrency();
    giveFlag(verb, "--threads", {std::to_string(std::max(all / jobs, 1))});
  }
}

}  // namespace

Request FrameRun::weighed(Request request) const {
  if (weightFrom.empty() || !fitsWeight(request)) return request;
  request.sums.fitWeight = false;
  request.sums.weight.reset();
  request.sums.weightFrom = weightFrom;
  return request;
}

std::map<std::string, std::string> FrameRun::with(std::map<std::string, std::string> own) const {
  own.insert(attributes.begin(), attributes.end());
  return own;
}

std::function<void(const std::string&, double)> FrameRun::watcher() const {
  return [voice = voice](const std::string& stage, double share) { voice->stage(stage, share); };
}

void overFrames(const CLI::App& verb, const SequenceFlags& flags, const VerbRun& run) {
  if (!isSequence(verb)) {
    if (flags.jobs > 1) throw UsageError("--jobs: found it with a single picture, expected --frames: frames run so");
    runAlone(verb, flags, run.work);
    return;
  }
  const FrameChoice choice(verb, flags.frames);
  for (const int frame : choice.frames()) {
    choice.put(frame);
    checkVerbOutputs(verb);
  }
  const int jobs = std::min<int>(flags.jobs, static_cast<int>(choice.frames().size()));
  shareOut(verb, jobs);
  choice.put(choice.frames().front());
  keepPlanes();
  FrameTurn turn(verb, choice, flags, run);
  FrameWork frames;
  frames.count = choice.frames().size();
  frames.jobs = jobs;
  frames.handsOn = turn.fitsWeight();
  frames.work = [&](std::size_t index, const std::string& handedOn, FrameVoice& voice) {
    return turn.take(index, handedOn, voice);
  };
  FrameReport report(choice.frames(), flags.form(true), run.json);
  if (turn.fitsWeight()) report.tellWeight();
  std::fflush(stdout);
  report.end(runFrames(frames, report), run.table);
}

}  // namespace pellucid::cli
