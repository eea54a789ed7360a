// What a process and its workers say to each other: a line of JSON each.
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "composite/sequence/frame_workers.h"

namespace pellucid {

// One end of a stream socket. It is closed by close() alone, for it is kept by value.
class LineSocket {
 public:
  explicit LineSocket(int descriptor) : descriptor_(descriptor) {}
  int descriptor() const { return descriptor_; }
  void send(const nlohmann::json& line) const;  // nothing where the other end has gone
  bool receive();                               // takes in what is there; false when the other end has gone
  std::optional<nlohmann::json> next();         // a whole line of it
  std::optional<nlohmann::json> wait();         // the next line, nothing when the other end has gone
  void close();

 private:
  int descriptor_;
  std::string held_;
};

nlohmann::json lineOf(const FrameOutcome& outcome);
FrameOutcome outcomeOf(const nlohmann::json& line);

class SocketVoice : public FrameVoice {
 public:
  explicit SocketVoice(const LineSocket& socket) : socket_(socket) {}
  void note(const std::string& sentence) override;
  void stage(const std::string& stage, double share) override;  // ten a second at most

 private:
  const LineSocket& socket_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace pellucid
