// Verbs and flags that do not exist, told before anything is parsed, with the one that was probably meant.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pellucid::cli {

// Letters to insert, delete, replace or swap with their neighbour to make one word the other.
std::size_t editDistance(const std::string& a, const std::string& b);

// The name that `text` begins, or that is a few letters away: a third of the longer word's, one at least. "" for none.
std::string nearestName(const std::string& text, const std::vector<std::string>& names);

// "--method", "-o": every spelling that the options of a verb take.
std::vector<std::string> flagsOf(const CLI::App& verb);

// Throws UsageError when there is no verb, or for the first word that is a verb or a flag by its place and none by its
// name. Values of flags are not looked at.
void checkWords(const CLI::App& app, int argc, const char* const* argv);

}  // namespace pellucid::cli
