#include "bench/processes.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace pellucid::bench {
namespace {

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string textOf(const Command& command) {
  std::string text;
  for (const std::string& word : command) text += (text.empty() ? "" : " ") + word;
  return text;
}

[[noreturn]] void become(const Command& command) {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execvp(words[0], words.data());
  ::_exit(127);
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

Cost costOf(const Command& command) {
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start " + textOf(command));
  if (child == 0) become(command);
  int status = 0;
  rusage used{};
  if (::wait4(child, &status, 0, &used) != child) throw std::runtime_error("lost " + textOf(command));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("failed: " + textOf(command));
  return {secondsOf(used.ru_utime) + secondsOf(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024.0};
}

std::vector<Measured> inTurn(const std::vector<Command>& commands, int runs) {
  std::vector<std::vector<Cost>> costs(commands.size());
  for (int run = 0; run < runs; ++run)
    for (std::size_t i = 0; i < commands.size(); ++i) costs[i].push_back(costOf(commands[i]));
  std::vector<Measured> measured;
  for (const std::vector<Cost>& all : costs) {
    std::vector<double> seconds, megabytes;
    for (const Cost& one : all) {
      seconds.push_back(one.cpuSeconds);
      megabytes.push_back(one.megabytes);
    }
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    Measured result;
    result.median = {medianOf(seconds), medianOf(megabytes)};
    result.spread = 0.5 * (*most - *least) / std::max(result.median.cpuSeconds, 1e-9);
    measured.push_back(result);
  }
  return measured;
}

}  // namespace pellucid::bench
