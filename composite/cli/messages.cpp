#include "composite/cli/messages.h"

#include <fmt/chrono.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>

namespace pellucid::cli {
namespace {

bool asJson = false;
std::function<void(const std::string&)> listening;
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
  // Lines are whole as messageLine() makes them.
  spdlog::default_logger()->set_formatter(
      std::make_unique<spdlog::pattern_formatter>("%v", spdlog::pattern_time_type::local, std::string()));
}

std::string messageLine(const std::string& level, const std::string& sentence, const std::string& frame) {
  if (!asJson) {
    const std::string who = frame.empty() ? "" : "frame " + frame + ": ";
    return "pellucid: " + (level == "info" ? "" : level + ": ") + who + sentence + "\n";
  }
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  nlohmann::json line{
      {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))}, {"level", level}, {"message", sentence}};
  if (!frame.empty()) line["frame"] = frame;
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void say(const std::string& note) {
  if (heard)
    heard->push_back(note);
  else if (listening)
    listening(note);
  else
    spdlog::info("{}", messageLine("info", note));
}

void say(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say(note);
}

void sayError(const std::string& sentence) {
  std::fputs(messageLine("error", sentence).c_str(), stderr);
}

void sayAsJson() {
  asJson = true;
}

bool saysJson() {
  return asJson;
}

void hearNotes(std::function<void(const std::string&)> ear) {
  listening = std::move(ear);
}

}  // namespace pellucid::cli
