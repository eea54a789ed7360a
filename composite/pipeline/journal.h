// What a run says and how long its stages take. Whoever runs the pipeline decides where notes go.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {

// Seconds of each stage, in the order in which they first ran.
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

class Journal {
 public:
  //   sink   takes one sentence at a time: what was inferred, left out or clamped
  //   watch  is told what is done now, and which share of the whole is done, [0,1]; it may be told often
  explicit Journal(std::function<void(const std::string&)> sink = nullptr,
                   std::function<void(const std::string&, double)> watch = nullptr)
      : sink_(std::move(sink)), watch_(std::move(watch)) {}
  void note(const std::string& sentence) const {
    if (sink_) sink_(sentence);
  }
  void note(const std::vector<std::string>& sentences) const {
    for (const std::string& sentence : sentences) note(sentence);
  }
  template <class Work>
  auto time(const std::string& stage, Work&& work) {
    if (watch_) watch_(stage, share_);
    return stages.time(stage, std::forward<Work>(work));
  }
  // What comes next is known to be this far on.
  void reached(double share) { share_ = share; }
  // The same sink, with stages of its own.
  Journal beside() const { return Journal(sink_, watch_); }

  Stages stages;

 private:
  std::function<void(const std::string&)> sink_;
  std::function<void(const std::string&, double)> watch_;
  double share_ = 0.0;
};

}  // namespace pellucid
