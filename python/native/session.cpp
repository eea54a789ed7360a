#include "python/native/session.h"

#include <utility>

#include "composite/cli/results.h"
#include "composite/cli/verb_outputs.h"
#include "python/native/same_shot.h"

namespace pellucid::python {

Session::Session(const Words& words, std::shared_ptr<const GBuffer> picture, std::optional<Camera> camera)
    : picture_(std::move(picture)), camera_(std::move(camera)) {
  const cli::Listener listener(notes_);
  load(requestOf(flagsOf(words)));
}

const OneViewFlags& Session::flagsOf(const Words& words) {
  if (parsed_ && words == words_) {
    cli::checkVerbOutputs(parsed_->verb);
    return parsed_->flags;
  }
  parsed_.reset();
  saidOfWords_.clear();
  const cli::Listener listener(saidOfWords_);
  parsed_ = std::make_unique<const Parsed<OneViewFlags>>("composite", words, picture_ != nullptr);
  words_ = words;
  return parsed_->flags;
}

Request Session::requestOf(const OneViewFlags& flags) const {
  Request request = flags.render.request();
  request.shot.memory = picture_;
  if (camera_) request.shot.camera = *camera_;
  flags.preview.check(request.shot.colour, request.shot.scene.assetRoot);
  return request;
}

void Session::load(const Request& request) {
  const bool traced = meetsRays(request);
  if (compositor_ && sameShot(loaded_, request.shot) && (traced_ || !traced)) return;
  compositor_.reset();
  compositor_ = std::make_unique<Compositor>(request, [](const std::string& note) { cli::say(note); });
  loaded_ = request.shot;
  traced_ = traced;
  ++loads_;
}

Outcome Session::run(const Words& words) {
  const std::lock_guard lock(mutex_);
  const cli::Listener listener(notes_);
  const OneViewFlags& flags = flagsOf(words);
  std::optional<cli::Threads> threads;
  if (flags.run.threads > 0) threads.emplace(flags.run.threads);
  const Request request = requestOf(flags);
  load(request);
  Outcome outcome;
  outcome.result = compositor_->run(request);
  outcome.facts = compositor_->facts();
  outcome.space = compositor_->shot().opaque.space.name;
  if (!flags.output.empty()) cli::say(compositor_->write(flags.output, outcome.result));
  flags.preview.write(request.shot.colour, request.shot.scene.assetRoot, compositor_->shot().opaque.space,
                      outcome.result.picture.rgba);
  outcome.notes = saidOfWords_;
  outcome.notes.insert(outcome.notes.end(), notes_.begin(), notes_.end());
  notes_.clear();
  return outcome;
}

std::pair<Plan, ShotFacts> Session::plan(const Words& words) {
  const std::lock_guard lock(mutex_);
  const cli::Listener listener(notes_);
  const Request request = requestOf(flagsOf(words));
  load(request);
  Plan plan = compositor_->plan(request);
  return {std::move(plan), compositor_->facts()};
}

std::pair<std::uintptr_t, std::uintptr_t> Session::addresses() {
  const std::lock_guard lock(mutex_);
  const GBuffer& gbuffer = compositor_->shot().opaque.gbuffer;
  return {reinterpret_cast<std::uintptr_t>(gbuffer.beauty.data()),
          reinterpret_cast<std::uintptr_t>(gbuffer.viewZ.data())};
}

int Session::loads() {
  const std::lock_guard lock(mutex_);
  return loads_;
}

}  // namespace pellucid::python
