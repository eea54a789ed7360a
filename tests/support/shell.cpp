#include "tests/support/shell.h"

#include <sys/wait.h>

#include <cstdlib>

namespace pellucid::test {

Ended shell(const std::string& command, const std::string& folder) {
  Ended ended;
  const std::string log = folder + "/log.txt";
  const int status = std::system(("(" + command + ") > '" + log + "' 2>&1").c_str());
  ended.code = status == -1 ? -1 : WEXITSTATUS(status);
  ended.out = slurp(log);
  return ended;
}

bool sanitized() {
#if defined(__SANITIZE_ADDRESS__)
  return true;
#else
  return false;
#endif
}

}  // namespace pellucid::test
