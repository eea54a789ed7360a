#include "tests/support/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace pellucid::test {

Ended runProgram(const std::vector<std::string>& arguments, const RunOptions& options) {
  const std::string program = PELLUCID_BINARY_DIR "/bin/" + options.program;
  char outName[] = "/tmp/pellucid-test-out-XXXXXX", errName[] = "/tmp/pellucid-test-err-XXXXXX";
  const int out = mkstemp(outName), err = mkstemp(errName);
  if (out < 0 || err < 0) throw std::runtime_error("cannot make a temporary file");
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    dup2(out, 1);
    dup2(err, 2);
    if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(125);
    for (const std::string& entry : options.environment) putenv(const_cast<char*>(entry.c_str()));
    if (options.maxFileBytes >= 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{static_cast<rlim_t>(options.maxFileBytes), static_cast<rlim_t>(options.maxFileBytes)};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(program.c_str(), argv.data());
    _exit(126);
  }
  if (options.interruptAfterMs >= 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(options.interruptAfterMs));
    kill(child, options.signal);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  Ended ended;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  ended.cpuSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  ended.peakBytes = static_cast<std::size_t>(usage.ru_maxrss) << 10;
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  close(out);
  close(err);
  ended.out = slurp(outName);
  ended.err = slurp(errName);
  unlink(outName);
  unlink(errName);
  return ended;
}

std::string freshFolder(const std::string& name) {
  // Named after the test too: tests run side by side.
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string own = test ? std::string("-") + test->test_suite_name() + "." + test->name() : "";
  const std::filesystem::path folder = std::filesystem::path(PELLUCID_BINARY_DIR) / "test-files" / (name + own);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string assets() {
  const std::string path = PELLUCID_SOURCE_DIR "/../shared/assets";
  return std::filesystem::exists(path) ? path : "";
}

}  // namespace pellucid::test
