#include "composite/cli/frame_turn.h"

#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <new>

#include "composite/cli/frame_digest.h"
#include "composite/cli/messages.h"
#include "composite/pipeline/weight_file.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"

namespace pellucid::cli {
namespace {

// What this process prints to stdout, kept in memory.
class KeptOutput {
 public:
  KeptOutput() : file_(::memfd_create("pellucid-stdout", MFD_CLOEXEC)) {
    if (file_ < 0 || ::dup2(file_, STDOUT_FILENO) < 0) throw ResourceError("stdout cannot be kept in memory");
  }
  // All of it since the last call.
  std::string take() {
    std::fflush(stdout);
    std::string text;
    char block[1 << 16];
    ::lseek(file_, 0, SEEK_SET);
    for (ssize_t count = 0; (count = ::read(file_, block, sizeof(block))) > 0;)
      text.append(block, static_cast<std::size_t>(count));
    if (::ftruncate(file_, 0) == 0) ::lseek(file_, 0, SEEK_SET);
    return text;
  }

 private:
  int file_;
};

std::string outputOf(const CLI::App& verb) {
  const CLI::Option* option = verb.get_option_no_throw("--output");
  return option && option->count() > 0 ? option->results().back() : "";
}

}  // namespace

FrameTurn::FrameTurn(const CLI::App& verb, const FrameChoice& choice, const SequenceFlags& flags, const VerbRun& run)
    : verb_(verb), choice_(choice), flags_(flags), run_(run), fitsWeight_(run.fits && run.fits()) {}

FrameOutcome::State FrameTurn::carryOut(FrameRun& run) {
  if (verb_.get_option_no_throw("--skip-existing")) {
    const std::string weight = run.weightFrom.empty() ? "" : exrText(run.weightFrom, kWeightAttribute).value_or("");
    const std::string digest = frameDigest(verb_, choice_.paths(), weight, files_);
    if (flags_.skipExisting && isFinished(choice_.paths(), digest)) return FrameOutcome::State::skipped;
    run.attributes[kDigestAttribute] = digest;
  }
  run_.work(run);
  return FrameOutcome::State::done;
}

FrameOutcome FrameTurn::take(std::size_t index, const std::string& weightFrom, FrameVoice& voice) {
  static KeptOutput output;
  hearNotes([&](const std::string& sentence) { voice.note(sentence); });
  const auto start = std::chrono::steady_clock::now();
  FrameOutcome outcome;
  const auto fail = [&](int code, const std::string& sentence) {
    outcome.state = code == 1 ? FrameOutcome::State::differs : FrameOutcome::State::failed;
    outcome.code = code;
    outcome.message = sentence;
  };
  FrameRun run;
  try {
    choice_.put(choice_.frames()[index]);
    run.number = choice_.frames()[index];
    run.weightFrom = weightFrom;
    run.voice = &voice;
    outcome.state = carryOut(run);
    if (fitsWeight_) outcome.handOn = outputOf(verb_);
  } catch (const Error& error) {
    fail(error.exitCode(), error.what());
  } catch (const CLI::Error& error) {
    fail(2, error.what());
  } catch (const std::bad_alloc&) {
    fail(6, "memory ran out");
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.out = output.take();
  outcome.summary = std::move(run.summary);
  return outcome;
}

SingleVoice::SingleVoice(ProgressForm form)
    : progress_(form, {""}, [](const std::string& text) { std::fputs(text.c_str(), stderr); }) {
  if (form == ProgressForm::bar)
    hearNotes([this](const std::string& sentence) { progress_.between(messageLine("info", sentence)); });
}

SingleVoice::~SingleVoice() {
  progress_.finish();
  hearNotes(nullptr);
}

void SingleVoice::note(const std::string& sentence) {
  say(sentence);
}

void SingleVoice::stage(const std::string& stage, double share) {
  progress_.stage(0, stage, share);
}

void SingleVoice::ended() {
  progress_.ended(0, {});
}

}  // namespace pellucid::cli
