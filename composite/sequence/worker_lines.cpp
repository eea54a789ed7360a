#include "composite/sequence/worker_lines.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace pellucid {

void LineSocket::send(const nlohmann::json& line) const {
  // Names of files need not be UTF-8.
  const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::send(descriptor_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

bool LineSocket::receive() {
  char block[1 << 16];
  ssize_t count = 0;
  do count = ::recv(descriptor_, block, sizeof(block), 0);
  while (count < 0 && errno == EINTR);
  if (count > 0) held_.append(block, static_cast<std::size_t>(count));
  return count > 0;
}

std::optional<nlohmann::json> LineSocket::next() {
  const auto end = held_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  nlohmann::json line = nlohmann::json::parse(held_.substr(0, end));
  held_.erase(0, end + 1);
  return line;
}

std::optional<nlohmann::json> LineSocket::wait() {
  std::optional<nlohmann::json> line = next();
  while (!line && receive()) line = next();
  return line;
}

void LineSocket::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

nlohmann::json lineOf(const FrameOutcome& outcome) {
  return {{"kind", "ended"},
          {"state", static_cast<int>(outcome.state)},
          {"code", outcome.code},
          {"message", outcome.message},
          {"seconds", outcome.seconds},
          {"out", outcome.out},
          {"summary", outcome.summary},
          {"handOn", outcome.handOn}};
}

FrameOutcome outcomeOf(const nlohmann::json& line) {
  FrameOutcome outcome;
  outcome.state = static_cast<FrameOutcome::State>(line["state"].get<int>());
  outcome.code = line["code"];
  outcome.message = line["message"];
  outcome.seconds = line["seconds"];
  outcome.out = line["out"];
  outcome.summary = line["summary"];
  outcome.handOn = line["handOn"];
  return outcome;
}

void SocketVoice::note(const std::string& sentence) {
  socket_.send({{"kind", "note"}, {"text", sentence}});
}

void SocketVoice::stage(const std::string& stage, double share) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  socket_.send({{"kind", "stage"}, {"stage", stage}, {"share", share}});
}

}  // namespace pellucid
