// What every verb writes, checked before it starts.
#pragma once
#include <CLI/CLI.hpp>

namespace pellucid::cli {

// Of the flags' values as they stand. Throws what checkOutputs() throws.
void checkVerbOutputs(const CLI::App& verb);

// Has every verb of the program check its outputs once its flags are read, before it opens a file; those of a sequence
// are checked frame by frame, before any of them begins.
void checkOutputsFirst(CLI::App& app);

}  // namespace pellucid::cli
