#include "composite/cli/messages.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace pellucid::cli {
namespace {

thread_local std::vector<std::string>* heard = nullptr;  // by the Listener of this thread, or null

}  // namespace

Listener::Listener(std::vector<std::string>& notes) : before_(heard) {
  heard = &notes;
}

Listener::~Listener() {
  heard = before_;
}

void setUpMessages() {
  if (!spdlog::get("pellucid")) spdlog::set_default_logger(spdlog::stderr_logger_mt("pellucid"));
  spdlog::set_pattern("pellucid: %v");
}

void say(const std::string& note) {
  if (heard)
    heard->push_back(note);
  else
    spdlog::info("{}", note);
}

void say(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say(note);
}

}  // namespace pellucid::cli
