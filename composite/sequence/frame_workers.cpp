#include "composite/sequence/frame_workers.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

#include "composite/sequence/worker_lines.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr int kTickMs = 200;

struct Worker {
  pid_t process = -1;
  LineSocket socket{-1};
  std::optional<std::size_t> frame;  // that it is at
};

// What a worker does until nobody has a frame for it any more.
[[noreturn]] void serve(const FrameWork& frames, int descriptor) {
  LineSocket socket(descriptor);
  SocketVoice voice(socket);
  while (const std::optional<nlohmann::json> order = socket.wait()) {
    const auto index = (*order)["frame"].get<std::size_t>();
    socket.send(lineOf(frames.work(index, (*order)["handedOn"].get<std::string>(), voice)));
  }
  ::_exit(0);  // without the ends of what the parent has begun: its buffers and its temporary files
}

class Foreman {
 public:
  Foreman(const FrameWork& frames, FrameListener& listener)
      : frames_(frames), listener_(listener), outcomes_(frames.count) {}
  ~Foreman() {
    for (Worker& worker : workers_) worker.socket.close();
    for (Worker& worker : workers_) ::waitpid(worker.process, nullptr, 0);
  }

  std::vector<FrameOutcome> run() {
    while (ended_ < given_ || mayGive()) {
      while (mayGive() && giveOne()) {
      }
      listen();
    }
    outcomes_.resize(given_);
    return std::move(outcomes_);
  }

 private:
  bool mayGive() const { return !stopped_ && given_ < frames_.count; }

  // False where no worker is free for the next frame, or it has to wait.
  bool giveOne() {
    if (frames_.handsOn && handedOn_.empty() && ended_ < given_) return false;
    auto idle = std::find_if(workers_.begin(), workers_.end(), [](const Worker& worker) { return !worker.frame; });
    if (idle == workers_.end()) {
      if (workers_.size() >= static_cast<std::size_t>(frames_.jobs)) return false;
      start();
      idle = workers_.end() - 1;
    }
    idle->frame = given_;
    idle->socket.send({{"frame", given_}, {"handedOn", handedOn_}});
    ++given_;
    return true;
  }

  void start() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
      throw ResourceError(fmt::format("a process for frames cannot be reached: {}", std::strerror(errno)));
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) {
      ::close(ends[0]);
      ::close(ends[1]);
      throw ResourceError(fmt::format("a process for frames cannot be started: {}", std::strerror(errno)));
    }
    if (process == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (::getppid() != parent) ::_exit(128 + SIGTERM);
      ::close(ends[0]);
      for (Worker& other : workers_) other.socket.close();
      serve(frames_, ends[1]);
    }
    ::close(ends[1]);
    workers_.push_back({process, LineSocket(ends[0]), std::nullopt});
  }

  void listen() {
    std::vector<pollfd> polled;
    for (const Worker& worker : workers_) polled.push_back({worker.socket.descriptor(), POLLIN, 0});
    ::poll(polled.data(), polled.size(), kTickMs);
    for (std::size_t i = polled.size(); i-- > 0;)
      if (polled[i].revents) hear(i);
    listener_.tick();
  }

  void hear(std::size_t place) {
    Worker& worker = workers_[place];
    const bool open = worker.socket.receive();
    while (const std::optional<nlohmann::json> line = worker.socket.next()) {
      if (!worker.frame) continue;
      const std::size_t index = *worker.frame;
      const std::string kind = line->value("kind", "");
      if (kind == "note") listener_.note(index, (*line)["text"]);
      if (kind == "stage") listener_.stage(index, (*line)["stage"], (*line)["share"]);
      if (kind == "ended") {
        worker.frame.reset();
        end(index, outcomeOf(*line));
      }
    }
    if (!open) bury(place);
  }

  void end(std::size_t index, FrameOutcome outcome) {
    if (!outcome.handOn.empty() && handedOn_.empty()) handedOn_ = outcome.handOn;
    if (outcome.state == FrameOutcome::State::failed && outcome.code == 2) stopped_ = true;
    ++ended_;
    outcomes_[index] = std::move(outcome);
    listener_.ended(index, outcomes_[index]);
  }

  void bury(std::size_t place) {
    Worker& worker = workers_[place];
    worker.socket.close();
    int status = 0;
    ::waitpid(worker.process, &status, 0);
    if (worker.frame) {
      FrameOutcome outcome;
      outcome.state = FrameOutcome::State::failed;
      outcome.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
      outcome.message = WIFSIGNALED(status) ? fmt::format("its process was ended by the signal {} ({})",
                                                          WTERMSIG(status), ::strsignal(WTERMSIG(status)))
                                            : fmt::format("its process ended with the code {}", WEXITSTATUS(status));
      end(*worker.frame, std::move(outcome));
    }
    workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(place));
  }

  const FrameWork& frames_;
  FrameListener& listener_;
  std::vector<FrameOutcome> outcomes_;
  std::vector<Worker> workers_;
  std::string handedOn_;
  std::size_t given_ = 0, ended_ = 0;
  bool stopped_ = false;
};

}  // namespace

std::vector<FrameOutcome> runFrames(const FrameWork& frames, FrameListener& listener) {
  return Foreman(frames, listener).run();
}

}  // namespace pellucid
