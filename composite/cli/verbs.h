// One function per verb: adds its flags, and returns what to run when it was chosen.
#pragma once
#include <CLI/CLI.hpp>

namespace pellucid::cli {

void addComposite(CLI::App& app);
void addAccumulate(CLI::App& app);
void addResolve(CLI::App& app);
void addOcclusion(CLI::App& app);
void addInspect(CLI::App& app);
void addGbuffer(CLI::App& app);
void addRender(CLI::App& app);
void addCompare(CLI::App& app);
void addFlatten(CLI::App& app);
void addFragments(CLI::App& app);
void addStudy(CLI::App& app);
void addView(CLI::App& app);

// The whole program but for main(): returns the exit code. DESIGN, The command line
int run(int argc, const char* const* argv);

}  // namespace pellucid::cli
