// Commands of a shell, for what is tested from outside: installed prefixes, projects of others.
#pragma once
#include <string>

#include "tests/support/program.h"

namespace pellucid::test {

// What a shell says, on either stream, and its exit code. The log is kept in `folder`.
Ended shell(const std::string& command, const std::string& folder);

// Whether this was built with AddressSanitizer, whose libraries want programs that were too.
bool sanitized();

}  // namespace pellucid::test
