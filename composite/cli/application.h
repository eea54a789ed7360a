// The program as a whole: all verbs, their help, and the lists behind it.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace pellucid::cli {

inline constexpr const char* kWhatItDoes = "Composites glass, smoke and foliage onto renders you already have.";
void addVerbs(CLI::App& app);  // all of them, as the program has them
void addHelp(CLI::App& app);   // the verb `help`
std::string helpTopics();      // of `pellucid help`: "methods, weights, ..."

}  // namespace pellucid::cli
