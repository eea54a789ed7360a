// The GL device of a run, made when the first step asks for it, and what is drawn with it.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "composite/pipeline/journal.h"
#include "engine_bridge/gl/current_context.h"
#include "engine_bridge/gl/resolve_pass.h"
#include "engine_bridge/gl/stochastic_pass.h"

namespace pellucid {

class Device {
 public:
  //   number  of the EGL device; -1 takes the first
  explicit Device(int number) : number_(number) {}
  // While it lives, the context is current on this thread; whatever was so before is put back. So a thread may go on
  // with what another one began, as long as they take turns.
  class Turn {
   public:
    explicit Turn(Device& device) : device_(device) {
      if (!device_.context_) return;
      before_.emplace();
      device_.current_->restore();
    }
    ~Turn() {
      if (!before_ && device_.context_) before_ = CurrentContext::none();
      if (before_) before_->restore();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Device& device_;
    std::optional<CurrentContext> before_;
  };

  GlContext& context(Journal& journal) {
    if (!context_)
      journal.time("GL context", [&] {
        context_ = std::make_unique<GlContext>(number_);
        current_.emplace();
        description_ = context_->description();
      });
    return *context_;
  }
  ResolvePass& resolver(Journal& journal) {
    if (!resolver_) resolver_.emplace(context(journal));
    return *resolver_;
  }
  // "CPU" while nothing has asked for it.
  const std::string& description() const { return description_; }
  // Ends the context, while it is current.
  void close() {
    resolver_.reset();
    context_.reset();
  }

 private:
  int number_;
  std::string description_ = "CPU";
  std::optional<CurrentContext> current_;
  std::unique_ptr<GlContext> context_;
  std::optional<ResolvePass> resolver_;
};

}  // namespace pellucid
