// One function per verb: adds its flags, and returns what to run when it was chosen.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace pellucid::cli {

void addComposite(CLI::App& app);
void addAccumulate(CLI::App& app);
void addResolve(CLI::App& app);
void addOcclusion(CLI::App& app);
void addInspect(CLI::App& app);
void addGbuffer(CLI::App& app);
void addCompare(CLI::App& app);
void addFlatten(CLI::App& app);
void addFragments(CLI::App& app);
void addStudy(CLI::App& app);
void addHelp(CLI::App& app);
std::string helpTopics();  // of `pellucid help`: "methods, weights, ..."

void addVerbs(CLI::App& app);  // all of them, as the program has them

// The whole program but for main(): returns the exit code. DESIGN, The command line
int run(int argc, const char* const* argv);

}  // namespace pellucid::cli
