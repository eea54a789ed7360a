// The GL device of a run, made when the first step asks for it, and what is drawn with it.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "composite/pipeline/journal.h"
#include "engine_bridge/gl/resolve_pass.h"
#include "engine_bridge/gl/stochastic_pass.h"

namespace pellucid {

class Device {
 public:
  //   number  of the EGL device; -1 takes the first
  explicit Device(int number) : number_(number) {}
  GlContext& context(Journal& journal) {
    if (!context_) journal.time("GL context", [&] { context_ = std::make_unique<GlContext>(number_); });
    return *context_;
  }
  ResolvePass& resolver(Journal& journal) {
    if (!resolver_) resolver_.emplace(context(journal));
    return *resolver_;
  }
  // "CPU" while nothing has asked for it.
  std::string description() const { return context_ ? context_->description() : "CPU"; }

 private:
  int number_;
  std::unique_ptr<GlContext> context_;
  std::optional<ResolvePass> resolver_;
};

}  // namespace pellucid
