#include "composite/cli/viewer.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

constexpr const char* kOpener = "xdg-open";

bool isSet(const char* name) {
  const char* value = std::getenv(name);
  return value && *value;
}

}  // namespace

bool hasDisplay() {
  return isSet("DISPLAY") || isSet("WAYLAND_DISPLAY");
}

void openInViewer(const std::string& path) {
  std::string program = kOpener, file = path;
  char* words[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  if (const int error = posix_spawnp(&child, kOpener, nullptr, nullptr, words, environ))
    throw ResourceError(fmt::format("{}: cannot be opened: {}: {}, expected the program of xdg-utils", path, kOpener,
                                    std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw ResourceError(fmt::format("{}: cannot be opened: {} ended with {}, expected a program that shows it", path,
                                    kOpener, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)));
}

}  // namespace pellucid::cli
