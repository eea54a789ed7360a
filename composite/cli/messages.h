// Messages go to stderr, results to stdout.
#pragma once
#include <spdlog/spdlog.h>

#include <chrono>
#include <string>
#include <vector>

namespace pellucid::cli {

void setUpMessages();
inline void say(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) spdlog::info(note);
}

// Seconds of each stage, in the order they ran, for --stats.
class Stages {
 public:
  template <class Work>
  auto time(const std::string& name, Work&& work) {
    struct Stop {
      Stages& stages;
      const std::string& name;
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      ~Stop() { stages.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()); }
    } stop{*this, name};
    return work();
  }
  void add(const std::string& name, double seconds) {
    for (auto& [known, total] : seconds_)
      if (known == name) {
        total += seconds;
        return;
      }
    seconds_.emplace_back(name, seconds);
  }
  const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace pellucid::cli
