// What every verb writes, checked before it starts.
#pragma once
#include <CLI/CLI.hpp>

namespace pellucid::cli {

// Throws checkOutputs' error for what the flags of a verb, which have been parsed, name as outputs.
void checkVerbOutputs(const CLI::App& verb);

// Has each verb of the program end with checkOutputs' error as soon as its flags are read, before it opens a file.
void checkOutputsFirst(CLI::App& app);

}  // namespace pellucid::cli
